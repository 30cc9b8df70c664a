"""Strengths that vary from point to point: what the laws make of them, and that each point has its own."""

import numpy as np
import pytest
from frictional_soil import build, sheared

from rfmpm.kernel_tools import at
from rfmpm.mpm.laws import LAWS
from rfmpm.study.models import VonMisesMaterial

FRICTIONAL = pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])
ANGLES = np.radians([12.0, 30.0, 41.0])
SOFTENING = {
    "residual_friction_angle_deg": 20.0,
    "dilation_angle_deg": 10.0,
    "residual_dilation_angle_deg": 2.0,
    "residual_plastic_strain": 0.4,
}


@FRICTIONAL
def test_all_angles_of_a_point_follow_its_friction_angle_in_their_tangents(law):
    soil, _ = build(law, count=3, strengths={"friction_angle": ANGLES}, **SOFTENING)
    scale = np.tan(ANGLES) / np.tan(np.radians(30.0))
    for found, degrees in ((soil.friction, (30.0, 20.0)), (soil.dilation, (10.0, 2.0))):
        np.testing.assert_allclose(np.tan(found.peak), scale * np.tan(np.radians(degrees[0])), rtol=1e-12)
        np.testing.assert_allclose(np.tan(found.residual), scale * np.tan(np.radians(degrees[1])), rtol=1e-12)
    assert np.all(soil.dilation.peak < soil.friction.peak)


@FRICTIONAL
def test_what_does_not_vary_stays_one_number(law):
    soil, _ = build(law, count=3, **SOFTENING)
    assert all(isinstance(angle, float) for angle in (*soil.friction, *soil.dilation))
    soil, _ = build(law, count=3, strengths={"friction_angle": ANGLES})
    assert soil.dilation == (0.0, 0.0)


@FRICTIONAL
def test_each_point_is_as_strong_as_a_soil_of_its_own_angle(law):
    soil, history = build(law, count=3, strengths={"friction_angle": ANGLES})
    for point, angle in enumerate(ANGLES):
        alone, fresh = (at(record, 0) for record in build(law, friction_angle_deg=float(np.degrees(angle))))
        expected, _ = sheared(alone, fresh, 20e3, 0.2)
        found, _ = sheared(at(soil, point), at(history, point), 20e3, 0.2)
        # identity: the angle comes through a tangent and back
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-8)


def clay(**changes):
    values = {"cohesion_kpa": 20.0, "residual_cohesion_kpa": 4.0, "softening_modulus_kpa": 50.0} | changes
    return VonMisesMaterial(
        name="clay", law="von_mises", unit_weight_kn_m3=20.0, youngs_modulus_kpa=1e3, poissons_ratio=0.33, **values
    )


def test_a_random_residual_counts_as_far_as_it_is_below_the_peak():
    residuals = {"residual_cohesion": np.array([3e3, 5e3, 25e3])}
    soil, _ = LAWS["von_mises"].build(clay(), 0.25, 3, residuals)
    np.testing.assert_array_equal(soil.peak, 20e3)
    np.testing.assert_array_equal(soil.residual, [3e3, 5e3, 20e3])
    both = residuals | {"cohesion": np.array([2e3, 30e3, 30e3])}
    soil, _ = LAWS["von_mises"].build(clay(), 0.25, 3, both)
    np.testing.assert_array_equal(soil.residual, [2e3, 5e3, 25e3])


@FRICTIONAL
def test_a_random_residual_of_a_drained_soil(law):
    residual = np.array([1e3, 2e3, 9e3])
    soil, _ = build(law, count=3, strengths={"residual_cohesion": residual}, residual_plastic_strain=0.4)
    np.testing.assert_array_equal(soil.residual, np.minimum(residual, 5e3))
