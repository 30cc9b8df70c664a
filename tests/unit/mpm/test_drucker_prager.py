"""Drucker-Prager against closed forms, and against Mohr-Coulomb, which it equals in plane strain flow."""

from math import radians, sin, sqrt

import numpy as np
import pytest
from frictional_soil import (
    APEX,
    BULK,
    COHESION,
    COS,
    DILATION,
    IDENTITY,
    SHEAR,
    SIN,
    compressed,
    isotropic,
    one_point,
    sheared,
    strained,
)  # fmt: skip

from rfmpm.kernel_tools import Tensor
from rfmpm.mpm.protocols import update_stress

PRESSURE = 40e3  # [Pa]
NOTHING = Tensor(0.0, 0.0, 0.0, 0.0)
LAW = "drucker_prager"


def cone(dilation):
    """Slope and limit of the cone and slope of its flow: the plane strain match of the class, written otherwise."""
    p = sin(radians(dilation))
    kappa = 1.0 / sqrt(1.0 + p * p / 3.0)
    share = kappa * (1.0 + SIN * p / 3.0)
    return SIN / share, COHESION * COS / share, p * kappa


def test_associated_match_is_the_usual_one():
    tangent = SIN / COS
    slope, limit, flow = cone(30.0)
    assert slope == pytest.approx(3.0 * tangent / sqrt(9.0 + 12.0 * tangent**2), rel=IDENTITY)
    assert flow == pytest.approx(slope, rel=IDENTITY)
    assert limit == pytest.approx(3.0 * COHESION / sqrt(9.0 + 12.0 * tangent**2), rel=IDENTITY)


@pytest.mark.parametrize("dilation", [0.0, DILATION, 30.0])
@pytest.mark.parametrize("amount", [0.01, 0.06, 0.07, 0.2])
def test_simple_shear_from_an_isotropic_pressure(amount, dilation):
    slope, limit, flow = cone(dilation)
    g = max(0.0, SHEAR * amount - slope * PRESSURE - limit) / (SHEAR + BULK * slope * flow)
    stress, history = sheared(*one_point(LAW, dilation_angle_deg=dilation), PRESSURE, amount)
    mean = -PRESSURE - BULK * flow * g
    assert stress == pytest.approx((mean, mean, mean, SHEAR * (amount - g)), rel=IDENTITY)
    assert history.plastic_strain == pytest.approx(g / sqrt(3.0), rel=1e-10, abs=1e-15)


@pytest.mark.parametrize("dilation", [0.0, DILATION, 30.0])
def test_plane_strain_flow_has_the_strength_and_the_dilation_of_mohr_coulomb(dilation):
    ends = {}
    for law in ("mohr_coulomb", "drucker_prager"):
        soil = {"dilation_angle_deg": dilation, "youngs_modulus_kpa": 2e4}
        stress, _, lateral = compressed(*one_point(law, **soil), PRESSURE, 0.6, 120)[-1]
        ends[law] = stress.yy, (lateral - 0.005) / (lateral + 0.005)
    # szz approaches that of plane strain flow exponentially; nothing is left of it after 60 % of compression.
    assert ends["drucker_prager"] == pytest.approx(ends["mohr_coulomb"], rel=1e-6, abs=1e-6)


def test_softens_to_the_residual_cone():
    soil = {"residual_cohesion_kpa": 1.0, "residual_friction_angle_deg": 20.0, "residual_plastic_strain": 0.1}
    stress, history = sheared(*one_point(LAW, **soil), PRESSURE, 0.5, 500)
    assert history.plastic_strain > 0.1
    assert stress.xy == pytest.approx(1e3 * np.cos(radians(20.0)) + PRESSURE * np.sin(radians(20.0)), rel=1e-11)


def test_tension_ends_at_the_apex_and_a_cutoff_bounds_the_mean_stress():
    pull = (0.02, 0.01, 0.004)
    stress, _ = strained(*one_point(LAW), NOTHING, pull)
    assert stress == pytest.approx(isotropic(APEX), rel=IDENTITY, abs=1e-9)
    law, history = one_point(LAW, tension_cutoff_kpa=2.0)
    stress, history = strained(law, history, NOTHING, pull)
    slope, limit, _ = cone(0.0)
    deviator = np.array(stress) - 2e3 * np.array([1.0, 1.0, 1.0, 0.0])
    assert np.mean(stress[:3]) == pytest.approx(2e3, rel=IDENTITY)
    assert sqrt(0.5 * deviator[:3] @ deviator[:3] + stress.xy**2) == pytest.approx(limit - slope * 2e3, rel=1e-11)
    stress, _ = strained(law, history, isotropic(1.9e3), (0.0005, 0.0003, 0.0))  # cut-off alone
    trial = 2.0 * SHEAR * 0.0002 / 2.0
    assert stress.xx - stress.yy == pytest.approx(2.0 * trial, rel=1e-9)
    assert np.mean(stress[:3]) == pytest.approx(2e3, rel=IDENTITY)


@pytest.mark.parametrize(
    ("cohesion", "friction"), [(0.0, 0.0), (0.0, 30.0), (5.0, 0.0), (1e-12, 1e-9), (5.0, 80.0)], ids=str
)
@pytest.mark.parametrize("cutoff", [None, 0.0, 1.0])
def test_no_strength_gives_something_that_is_not_a_number(cohesion, friction, cutoff):
    random = np.random.default_rng(5)
    law, start = one_point(LAW, cohesion_kpa=cohesion, friction_angle_deg=friction, tension_cutoff_kpa=cutoff)
    for scale in (0.0, 1e-12, 1e-3, 1e2):
        stress, history = NOTHING, start
        for exx, eyy, exy in random.normal(0.0, scale, (200, 3)):
            stress, history = update_stress(law, stress, Tensor(exx, eyy, 0.0, exy), history, 1e-3)
            assert np.isfinite([*stress, *history]).all()


def test_without_friction_it_is_von_mises():
    stress, _ = sheared(*one_point(LAW, friction_angle_deg=0.0), PRESSURE, 0.5)
    assert stress == pytest.approx((-PRESSURE, -PRESSURE, -PRESSURE, COHESION), rel=IDENTITY)
