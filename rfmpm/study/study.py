"""A study: everything that a campaign depends on, validated as a whole."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from copy import deepcopy
from numbers import Integral, Real
from os import PathLike, fspath
from typing import Annotated, Any

import tomli_w
from pydantic import BaseModel, Field

from rfmpm.study.checks import joint_problems
from rfmpm.study.diagnosis import Diagnosis
from rfmpm.study.errors import Problem, StudyError
from rfmpm.study.field_models import FieldCorrelation, Property, RandomField
from rfmpm.study.fields import CorrelatedFields, FieldOfSoils, correlated_fields, fields_of
from rfmpm.study.geometry_models import Geometry, Load, Obstacle
from rfmpm.study.kinds import Table
from rfmpm.study.known import Known, path_of
from rfmpm.study.models import (
    Boundary,
    Campaign,
    Discretisation,
    Failures,
    FrictionalMaterial,
    HistoryPoint,
    Material,
    Output,
    Quantities,
    Time,
)
from rfmpm.study.question_models import TOWARDS_LIMIT, Estimation
from rfmpm.study.schema import Hint
from rfmpm.study.uncertain_checks import CAPPED
from rfmpm.study.uncertain_models import Uncertain

NOT_PHYSICS = (
    ("study", "name"),
    ("study", "realisations"),
    ("study", "until"),
    ("output", "directory"),
    ("output", "surface_bin_m"),
    ("quantities", "run_out_limit_m"),
    ("quantities", "inundation_depth_m"),
    ("failures",),
    ("output", "history_interval_s"),
    ("history",),
)


class Study(Table):
    """A validated study; attributes are the keys of the study file, in the units of their names.

    Args:
        tables: the tables of the study file as keyword arguments, each a dict.

    Raises:
        StudyError: with everything that is wrong.
    """

    study: Campaign
    geometry: Geometry
    discretisation: Discretisation
    boundary: Boundary
    material: Annotated[tuple[Material, ...], Hint("written [[material]]")] = Field(
        description="The materials; more than one for regions and layers"
    )
    load: Annotated[tuple[Load, ...], Hint("written [[load]]")] | None = Field(
        None, description="Loads on the ground; left out: none"
    )
    obstacle: Annotated[tuple[Obstacle, ...], Hint("written [[obstacle]]")] | None = Field(
        None, description="Rigid obstacles in the way of the soil; left out: none"
    )
    random_field: dict[Property, RandomField] = Field(
        default_factory=dict, description="The random variables; left out: a homogeneous slope"
    )
    random_field_correlation: tuple[FieldCorrelation, ...] | None = Field(
        None, description="Correlation between random fields; left out: they are independent"
    )
    uncertain: tuple[Uncertain, ...] | None = Field(
        None, description="Numbers that are not known exactly, one value for each realisation"
    )
    estimator: Estimation | None = Field(None, description="How a campaign answers; left out: plain Monte Carlo")
    time: Time
    quantities: Quantities = Quantities()
    history: tuple[HistoryPoint, ...] | None = Field(
        None, description="Points whose motion a single simulation keeps; left out: none"
    )
    output: Output
    failures: Failures = Failures()

    def __init__(self, /, **tables: Any):
        data = plain(tables)
        diagnosis = Diagnosis(type(self), data, validate=lambda candidate: super(Study, self).__init__(**candidate))
        known = Known(type(self), diagnosis.data, diagnosis.doubtful)
        if problems := diagnosis.problems + joint_problems(known):
            raise StudyError([str(problem) for problem in problems])

    def model_post_init(self, context: object) -> None:
        """Let the law decide a `volumetric_strain` that is not given, without counting it among the given keys.

        Means over cells keep soil that yields at constant volume from locking; with friction they let a slope move that
        should stand.
        """
        if self.discretisation.volumetric_strain is None:
            has_friction = any(isinstance(material, FrictionalMaterial) for material in self.material)
            object.__setattr__(self.discretisation, "volumetric_strain", "point" if has_friction else "cell_mean")

    @property
    def fields(self) -> tuple[FieldOfSoils, ...]:
        """All random fields: those of [random_field], then each material's own; in this order they take of `xi`."""
        return fields_of(self)

    @property
    def field_correlations(self) -> tuple[CorrelatedFields, ...]:
        """All correlations between random fields."""
        return correlated_fields(self)

    @property
    def physics_hash(self) -> str:
        """SHA-256 (hex) of everything that a realisation's result depends on; equal for equal physics."""
        content = self.model_dump(exclude_none=True)
        aim = content["study"].get("until")
        for *tables, key in NOT_PHYSICS:
            (content[tables[0]] if tables else content).pop(key, None)
        if self.estimator == Estimation():  # plain Monte Carlo, as without the table
            del content["estimator"]
        elif self.estimator and self.estimator.method in TOWARDS_LIMIT:
            content["estimator"]["aim"] = {
                key: aim[key] for key in aim if key == "quantity" or key.startswith("exceeds")
            }
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    def to_toml(self) -> str:
        """Write the study as the text of a study file, defaults included."""
        content = self.model_dump(exclude_none=True)
        return tomli_w.dumps({name: table for name, table in content.items() if table})

    def with_changes(self, changes: Mapping[str, Any]) -> "Study":
        """Copy the study with some keys changed, and validate the copy.

        Args:
            changes: new values by dotted path, lists by position: {"material.0.residual_cohesion_kpa": 8.0}. A path
                may name a whole table; a key that was left to its default, here or in the file, may be set too.

        Returns:
            The changed copy.

        Raises:
            StudyError: with everything that is wrong with the copy, such as a path that is none.
        """
        data = plain(self.model_dump(exclude_unset=True))
        unreachable = [Problem(path_of(path), "no such key") for path in changes if not _put(data, path, changes[path])]
        if unreachable:
            raise StudyError([str(problem) for problem in unreachable])
        return type(self)(**data)

    def with_values(self, values: Sequence[float]) -> "Study":
        """The study of one realisation: its uncertain numbers have these values, nothing is uncertain or estimated.

        A residual above its peak counts as the peak.

        Args:
            values: one for each entry of `uncertain` [unit of its key].

        Returns:
            The study.

        Raises:
            StudyError: with everything that is wrong with the study at these values.
        """
        changes = {entry.key: float(value) for entry, value in zip(self.uncertain, values, strict=True)}
        for index, material in enumerate(self.material):
            for residual in CAPPED:
                path, peak = f"material.{index}.{residual}", residual.removeprefix("residual_")
                given = changes.get(path, getattr(material, residual, None))
                most = changes.get(f"material.{index}.{peak}", getattr(material, peak, None))
                if (path in changes or residual in material.model_fields_set) and given > most:
                    changes[path] = most
        return self.with_changes(changes | {"uncertain": None, "estimator": None})

    @classmethod
    def json_schema(cls) -> dict:
        """The JSON schema of the study file."""
        return cls.model_json_schema()


def plain(value: Any) -> Any:
    """Nested dicts, lists and Python numbers for any mappings, sequences, tables and NumPy numbers; copies."""
    if isinstance(value, BaseModel):
        return plain(value.model_dump(exclude_unset=True))
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, PathLike):
        return fspath(value)
    if isinstance(value, bool | int | float):
        return value
    if isinstance(value, Integral):
        return int(value)
    return float(value) if isinstance(value, Real) else value


def _put(data: Any, dotted: str, value: Any) -> bool:
    """Put a value into nested dicts and lists, making the tables on its way; False if a list or value is in the way."""
    *parents, last = path_of(dotted)
    for key in parents:
        if isinstance(data, dict):
            data = data.setdefault(key, {})
        elif isinstance(data, list) and isinstance(key, int) and key < len(data):
            data = data[key]
        else:
            return False
    if isinstance(data, dict) or (isinstance(data, list) and isinstance(last, int) and last < len(data)):
        data[last] = deepcopy(plain(value))
        return True
    return False
