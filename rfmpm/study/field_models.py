"""The tables of a study file that say more about its random fields: layers, and correlation between properties."""

from typing import Annotated, Literal

from pydantic import Field

from rfmpm.study.kinds import Number, Positive, Table

Property = Literal["cohesion", "residual_cohesion", "friction_angle"]


class FieldLayer(Table):
    """[[random_field.<variable>.layer]]: the soil below a line; what is left out is as in the soil above all lines"""

    top_m: Number = Field(description="Height of the layer's upper border at x = 0, the left side [m]")
    dip_deg: Number = Field(
        0.0, gt=-80, lt=80, description="Inclination of that border, anticlockwise from the x axis [degrees]"
    )
    mean_kpa: Positive | None = Field(None, description="Mean of a cohesion [kPa]; at the crest where it has a trend")
    mean_deg: Annotated[Number, Field(gt=0, le=80)] | None = Field(
        None, description="Angle whose tangent is the mean of the tangent of a friction angle [degrees]"
    )
    coefficient_of_variation: Annotated[Number, Field(gt=0, le=2)] | None = Field(
        None, description="Standard deviation over mean [1]"
    )
    scale_of_fluctuation_h_m: Positive | None = Field(None, description="Scale of fluctuation along the layer [m]")
    scale_of_fluctuation_v_m: Positive | None = Field(None, description="Scale of fluctuation across the layer [m]")
    rotation_deg: Annotated[Number, Field(ge=-180, le=180)] | None = Field(
        None,
        description="Rotation of the axes, anticlockwise [degrees]; left out: dip_deg, along the layer",
    )


class FieldCorrelation(Table):
    """[[random_field_correlation]] between two random fields of one material"""

    between: tuple[Property, Property] = Field(description="The two random fields")
    coefficient: Number = Field(gt=-1, lt=1, description="Correlation of their standard-normal fields at one point [1]")
