"""Upper bound of the stability number of a slope: a rigid body that rotates on a logarithmic spiral through the toe.

Chen (1975), Limit analysis and soil plasticity, chapter 9: 16.16 at 45 degrees with 20 degrees of friction.
"""

from math import atan, tan

import numpy as np

NONE = 1e9  # stands for the number of a spiral that holds no slope; finite, since simplices compare differences


def stability_number(slope: float, friction: float) -> float:
    """Least of unit weight * height / cohesion at which a slope can fail by rotation.

    Args:
        slope: angle of the face [rad].
        friction: angle of friction, more than 0 [rad].

    Returns:
        The number [-].
    """
    from scipy.optimize import minimize

    starts = [(first, first + turn) for first in np.linspace(0.1, 1.4, 6) for turn in np.linspace(0.2, 1.4, 5)]
    best = min(starts, key=lambda angles: _number(angles, slope, friction))
    tight = {"xatol": 1e-9, "fatol": 1e-12}
    return float(minimize(_number, best, args=(slope, friction), method="Nelder-Mead", options=tight).fun)


def factor_of_safety(
    slope: float, height: float, cohesion: float, friction: float, unit_weight: float, least: float, most: float
) -> float:
    """Factor that divides cohesion and tangent of the angle of friction alike, so that the slope just fails.

    Args:
        slope: angle of the face [rad].
        height: of the slope [m].
        cohesion: [Pa].
        friction: angle of friction [rad].
        unit_weight: [N/m3].
        least: below the factor [-].
        most: above the factor [-].

    Returns:
        The factor [-].
    """
    from scipy.optimize import brentq

    def spare(factor: float) -> float:
        return stability_number(slope, atan(tan(friction) / factor)) * cohesion / factor - unit_weight * height

    return float(brentq(spare, least, most, xtol=1e-6))


def _number(angles: tuple[float, float], slope: float, friction: float) -> float:
    """The number of one spiral, from its first to its last angle; NONE where it does not hold a slope."""
    first, last = angles
    if not 0.0 < first < last < np.pi:
        return NONE
    t = tan(friction)
    growth = np.exp((last - first) * t)
    height = np.sin(last) * growth - np.sin(first)  # over the first radius, as all lengths here
    if height <= 0.0:
        return NONE
    crest = np.sin(last - first) / np.sin(last) - np.sin(last + slope) / (np.sin(last) * np.sin(slope)) * height
    if crest < 0.0:
        return NONE
    whole = (3.0 * t * np.cos(last) + np.sin(last)) * growth**3 - 3.0 * t * np.cos(first) - np.sin(first)
    whole /= 3.0 * (1.0 + 9.0 * t * t)
    behind = crest * (2.0 * np.cos(first) - crest) * np.sin(first) / 6.0
    before = np.sin(last - first) - crest * np.sin(last)
    before *= growth / 6.0 * (np.cos(first) - crest + np.cos(last) * growth)
    work = whole - behind - before
    if work <= 0.0:
        return NONE
    return (growth * growth - 1.0) / (2.0 * t) * height / work
