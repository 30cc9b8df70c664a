"""The properties that may be random: what varies of each, and where a study says its mean."""

from collections.abc import Callable
from math import atan, degrees, pi, radians, tan
from typing import NamedTuple

import numpy as np

LARGEST_ANGLE = 80.0 / 180.0 * pi  # [rad], as for an angle that is not random


class Kind(NamedTuple):
    """What is random of a property, and where a study says its mean."""

    mean_key: str  # of a material, and of a layer by its unit
    layer_key: str
    in_words: Callable[[float], str]  # a value of the field in the study's unit
    field_mean: Callable[[float], float]  # mean of the field in SI units, from the study's number
    value: Callable[[np.ndarray], np.ndarray]  # the property in SI units, from the field


def _pascal(kilopascal: float) -> float:
    return kilopascal * 1e3


def _in_kilopascal(pascal: float) -> str:
    return f"{pascal / 1e3:.4g} kPa"


def _tangent(angle: float) -> float:
    return tan(radians(angle))


def _in_degrees(tangent: float) -> str:
    return f"{degrees(atan(tangent)):.4g} degrees"


def _same(values: np.ndarray) -> np.ndarray:
    return values


def _angle(tangent: np.ndarray) -> np.ndarray:
    return np.minimum(np.arctan(tangent), LARGEST_ANGLE)


# The tangent of the angle of friction is what varies: a stress ratio, for which coefficients of variation are reported.
KINDS = {
    "cohesion": Kind("cohesion_kpa", "mean_kpa", _in_kilopascal, _pascal, _same),
    "residual_cohesion": Kind("residual_cohesion_kpa", "mean_kpa", _in_kilopascal, _pascal, _same),
    "friction_angle": Kind("friction_angle_deg", "mean_deg", _in_degrees, _tangent, _angle),
}
