"""A slope of drained soil stands or fails where limit analysis says: the log-spiral bound of Chen (1975), chapter 9.

The bound is within a few per cent of the true critical height. Without dilation and with cells of a twelfth of the
height a slope may differ by some per cent more, so that it is asked at 0.8 and 1.2 times the critical cohesion.
"""

from math import cos, exp, radians, sin, tan

import numpy as np
import pytest
from scipy.optimize import minimize

import rfmpm

IMPOSSIBLE = 1e9
UNIT_WEIGHT, HEIGHT, FACE = 20.0, 3.0, 45.0  # [kN/m3], [m], [degrees]

pytestmark = pytest.mark.slow


def largest_displacement(law, friction, cohesion):
    study = rfmpm.load_study(
        {
            "study": {"name": "drained slope", "seed": 1},
            "geometry": {"kind": "slope", "height_m": HEIGHT, "crest_m": 6.0, "angle_deg": 45.0, "foreland_m": 6.0},
            "discretisation": {"cell_m": 0.25, "points_per_cell": 4, "shape": "quadratic_bspline"},
            "boundary": {"base": {"kind": "fixed"}, "sides": {"kind": "roller"}},
            "material": [
                {
                    "name": "soil",
                    "law": law,
                    "unit_weight_kn_m3": UNIT_WEIGHT,
                    "youngs_modulus_kpa": 1e4,
                    "poissons_ratio": 0.33,
                    "cohesion_kpa": cohesion,
                    "friction_angle_deg": friction,
                }
            ],
            "time": {"end_s": 3.0},
            "output": {"directory": "results"},
        }
    )
    points = rfmpm.simulate(study).points
    return np.hypot(points["displacement_x"], points["displacement_y"]).max()


def stability_number(friction):
    """Critical height times unit weight over cohesion: the least over all log spirals through the toe."""
    t, face = tan(radians(friction)), radians(FACE)

    def bound(angles):
        first, last = angles  # from the horizontal to the radii at the crest and at the toe
        if not 0.0 < first < last < np.pi:
            return IMPOSSIBLE
        grown = exp((last - first) * t)
        height = sin(last) * grown - sin(first)  # over the first radius, as all lengths here
        width = cos(first) - cos(last) * grown - height / tan(face)  # of the crest behind its edge
        whole = (3.0 * t * cos(last) + sin(last)) * grown**3 - 3.0 * t * cos(first) - sin(first)
        weight = whole / (3.0 * (1.0 + 9.0 * t * t))
        weight -= width * (2.0 * cos(first) - width) * sin(first) / 6.0
        weight -= grown * (sin(last - first) - width * sin(last)) * (cos(first) - width + cos(last) * grown) / 6.0
        return height * (grown * grown - 1.0) / (2.0 * t * weight) if weight > 0.0 and width > 0.0 else IMPOSSIBLE

    return minimize(bound, (0.85, 1.8), method="Nelder-Mead").fun


def test_bound_is_the_published_one():
    assert stability_number(20.0) == pytest.approx(16.16, abs=0.01)  # Chen (1975), to its two decimals


@pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])
@pytest.mark.parametrize("friction", [20.0, 30.0])
def test_slope_fails_below_the_critical_cohesion_and_stands_above(law, friction):
    critical = UNIT_WEIGHT * HEIGHT / stability_number(friction)
    assert largest_displacement(law, friction, 0.8 * critical) > 0.1 * HEIGHT
    assert largest_displacement(law, friction, 1.2 * critical) < 0.01 * HEIGHT
