"""What the tables of a study file are made of: kinds of values, and the table itself."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, Strict

Number = Annotated[float, Strict(), Field(allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0)]
NotNegative = Annotated[Number, Field(ge=0)]
Length = Annotated[Number, Field(gt=0, le=1e6)]
Inclination = Annotated[Number, Field(ge=0, le=80)]
Text = Annotated[str, Strict(), Field(pattern=r"\S")]


def whole(value: object) -> object:
    """Refuse what is not a whole number: a choice among integers compares with ==, for which 4.0 is 4, true is 1."""
    if type(value) is not int:
        raise ValueError("not a whole number")
    return value


class Table(BaseModel):
    """A table of the study file: immutable, and a key it does not know is an error."""

    model_config = ConfigDict(frozen=True, extra="forbid")
