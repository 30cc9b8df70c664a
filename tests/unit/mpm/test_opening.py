"""Soil that was pulled apart: what it bears until it has closed again."""

import pytest
from frictional_soil import APEX, BULK, DILATION, LAME, SHEAR, isotropic, one_point, strained

from rfmpm.kernel_tools import Tensor

NOTHING = Tensor(0.0, 0.0, 0.0, 0.0)
LAW = "mohr_coulomb"


@pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])
def test_soil_that_opened_bears_nothing_until_it_has_closed(law):
    sand = {"cohesion_kpa": 0.0, "dilation_angle_deg": DILATION}
    stress, history = strained(*one_point(law, **sand), NOTHING, (0.01, 0.02, 0.03), steps=10)
    assert stress == pytest.approx(isotropic(0.0), abs=1e-9)
    assert history.opening == pytest.approx(0.03, rel=1e-9)
    stress, history = strained(one_point(law, **sand)[0], history, stress, (-0.005, -0.02, 0.01), steps=10)
    assert stress == pytest.approx(isotropic(0.0), abs=1e-9)
    assert history.opening == pytest.approx(0.005, rel=1e-9)
    stress, history = strained(one_point(law, **sand)[0], history, stress, (-0.0075, -0.0075, 0.0))
    assert (stress.xx + stress.yy + stress.zz) / 3.0 == pytest.approx(-0.01 * BULK, rel=1e-9)
    assert history.opening == 0.0


@pytest.mark.parametrize(("cutoff", "strength"), [(None, APEX), (2.0, 2e3)])
def test_an_opening_under_tension_unloads_before_it_closes(cutoff, strength):
    law, history = one_point(LAW, tension_cutoff_kpa=cutoff)
    stress, history = strained(law, history, isotropic(strength), (0.01, 0.01, 0.0))
    assert history.opening == pytest.approx(0.02, rel=1e-9)
    slack = strength / (LAME + SHEAR)  # strain of the area between that strength and no stress
    stress, past = strained(law, history, stress, (-0.25 * slack, -0.25 * slack, 0.0))
    assert (stress.xx, stress.yy) == pytest.approx((0.5 * strength, 0.5 * strength), rel=1e-9)
    assert past.opening == history.opening
    stress, past = strained(law, past, stress, (-0.004, -0.002, 0.0))
    assert stress.xx + stress.yy == pytest.approx(0.0, abs=1e-9)
    assert past.opening == pytest.approx(0.02 - (0.006 - 0.5 * slack), rel=1e-9)
    stress, past = strained(law, past, stress, (-0.01, -0.01, 0.0))
    assert stress.xx + stress.yy < 0.0
    assert past.opening == 0.0
