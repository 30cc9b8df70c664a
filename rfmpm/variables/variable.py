"""One variable: its place in a file, its unit and definition, and in which studies there is one."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


def always(study) -> bool:
    """Whatever the study."""
    return True


def has_surface(study) -> bool:
    """Where rows keep the final ground surface."""
    return study.output.surface_bin_m is not None


def has_obstacle(study) -> bool:
    """Where something stands in the way of the soil."""
    return bool(study.obstacle)


def has_factor(study) -> bool:
    """Where rows hold the factor of safety."""
    return bool(study.quantities.factor_of_safety)


def starts_otherwise(study) -> bool:
    """Where the initial stresses are not those of one elastic solve."""
    return study.time.initial_stress != "elastic"


def is_uncertain(study) -> bool:
    """Where numbers are not known exactly."""
    return study.uncertain is not None


def varies(name: str) -> Callable[[Any], bool]:
    """Where a property of some material is a random field."""
    return lambda study: any(field.variable == name for field in study.fields)


@dataclass(frozen=True)
class Variable:
    """One variable: its place in a file, its unit (empty for flags and texts) and its definition."""

    name: str
    dims: tuple[str, ...]
    dtype: str
    unit: str
    long_name: str
    attributes: Mapping[str, Any] = field(default_factory=dict)
    is_active: Callable[[Any], bool] = always


def table(*variables: Variable) -> dict[str, Variable]:
    """Variables by name."""
    return {variable.name: variable for variable in variables}
