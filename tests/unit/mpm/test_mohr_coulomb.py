"""Mohr-Coulomb against closed forms, and against the rules of plastic flow wherever a stress may return to."""

from itertools import pairwise, permutations
from math import cos, radians, sin, tan

import numpy as np
import pytest
from frictional_soil import (
    APEX,
    COHESION,
    COS,
    DILATION,
    IDENTITY,
    LAME,
    SHEAR,
    SIN,
    build,
    compressed,
    isotropic,
    octahedral,
    one_point,
    sheared,
    strained,
)  # fmt: skip
from scipy.optimize import nnls

from rfmpm.kernel_tools import Tensor, at
from rfmpm.mpm.laws.mohr_coulomb import Principal, relax
from rfmpm.mpm.protocols import update_stress

PRESSURE = 40e3  # [Pa]
NOTHING = Tensor(0.0, 0.0, 0.0, 0.0)
LAW = "mohr_coulomb"


@pytest.mark.parametrize("dilation", [0.0, DILATION, 30.0])
@pytest.mark.parametrize("amount", [0.01, 0.06, 0.07, 0.2])
def test_simple_shear_from_an_isotropic_pressure(amount, dilation):
    # Half the difference of the principal stresses is G times strain less 2 G g, and equals c cos(phi) - sin(phi) m;
    # the in-plane mean m falls by 2 sin(psi) (lame + G) g, since dilation is prevented.
    p = sin(radians(dilation))
    excess = SHEAR * amount - COHESION * COS - SIN * PRESSURE
    g = max(0.0, excess / (2.0 * SHEAR + 2.0 * SIN * p * (LAME + SHEAR)))
    stress, history = sheared(*one_point(LAW, dilation_angle_deg=dilation), PRESSURE, amount)
    mean = -PRESSURE - 2.0 * p * (LAME + SHEAR) * g
    across = -PRESSURE - 2.0 * p * LAME * g
    assert stress == pytest.approx((mean, mean, across, SHEAR * amount - 2.0 * SHEAR * g), rel=IDENTITY)
    flow = np.array([(1.0 + p) * g, 0.0, -(1.0 - p) * g]) - 2.0 * p * g / 3.0
    assert history.plastic_strain == pytest.approx(np.sqrt(2.0 / 3.0 * flow @ flow), rel=1e-10, abs=1e-15)


@pytest.mark.parametrize("dilation", [0.0, DILATION, 20.0])
@pytest.mark.parametrize("amount", [0.01, 0.1, 0.5])
def test_oedometer_yields_along_the_edge_of_equal_lateral_stresses(amount, dilation):
    # With 20 degrees; with 30 the lateral stress nu / (1 - nu) of the vertical one would hold for ever.
    s, p, limit = sin(radians(20.0)), sin(radians(dilation)), 2.0 * COHESION * cos(radians(20.0))
    flow = np.array([0.5 * (1.0 + p), 0.5 * (1.0 + p), -(1.0 - p)])
    elastic = np.full((3, 3), LAME) + 2.0 * SHEAR * np.eye(3)
    surface = np.array([1.0 + s, 0.0, -(1.0 - s)])
    trial = elastic @ [0.0, 0.0, -amount]
    g = max(0.0, (surface @ trial - limit) / (surface @ elastic @ flow))
    assert (g > 0.0) == (amount > 0.01)
    lateral, _, vertical = trial - elastic @ flow * g
    soil = {"friction_angle_deg": 20.0, "dilation_angle_deg": dilation}
    for steps in (1, 50):
        stress, _ = strained(*one_point(LAW, **soil), NOTHING, (0.0, -amount, 0.0), steps)
        assert stress == pytest.approx((lateral, vertical, lateral, 0.0), rel=1e-11, abs=1e-9)


def test_biaxial_compression_ends_at_the_passive_stress_and_dilates_by_the_dilation_angle():
    passive = tan(radians(60.0)) ** 2 * PRESSURE + 2.0 * COHESION * tan(radians(60.0))
    path = compressed(*one_point(LAW, dilation_angle_deg=DILATION), PRESSURE, 0.3, 60)
    stress, _, lateral = path[-1]
    assert stress.xx == pytest.approx(-PRESSURE, rel=1e-9)
    assert stress.yy == pytest.approx(-passive, rel=1e-9)
    assert stress.yy < stress.zz < stress.xx
    step = 0.3 / 60
    assert (lateral - step) / (lateral + step) == pytest.approx(sin(radians(DILATION)), rel=1e-6)
    elastic = [stress.yy for stress, history, _ in path if history.plastic_strain == 0.0]
    assert elastic
    # Plane strain at constant lateral stress: the modulus is E / (1 - nu^2).
    modulus = 1e6 / (1.0 - 0.3**2)
    assert elastic[-1] == pytest.approx(-PRESSURE - modulus * step * len(elastic), rel=1e-9)


# --- softening

SOFT = {
    "residual_cohesion_kpa": 1.0,
    "residual_friction_angle_deg": 20.0,
    "dilation_angle_deg": 0.0,
    "residual_plastic_strain": 0.1,
}


def shear_strength(strain):
    share = min(1.0, strain / 0.1)
    angle = radians(30.0 - 10.0 * share)
    return (COHESION - 4e3 * share) * cos(angle) + PRESSURE * sin(angle)


@pytest.mark.parametrize("amount", [0.07, 0.1, 0.15, 0.3])
@pytest.mark.parametrize("steps", [100, 1000])
def test_softening_follows_cohesion_and_angle_within_the_lag_of_a_step(amount, steps):
    stress, history = sheared(*one_point(LAW, **SOFT), PRESSURE, amount, steps)
    now, growth = history.plastic_strain, octahedral(0.5 * amount / steps)
    # The strength is that at the start of the step, which is between that of the end and of one step's growth before;
    # a step may grow by a little more than its own strain, as the strength falls meanwhile.
    assert shear_strength(now) * (1.0 - 1e-9) <= stress.xy <= shear_strength(now - 1.5 * growth) * (1.0 + 1e-9)
    # Elastic and plastic strain add up.
    assert stress.xy / SHEAR + 2.0 * now / octahedral(1.0) == pytest.approx(amount, rel=1e-9)
    if amount == 0.3:
        angle = radians(20.0)
        assert stress.xy == pytest.approx(1e3 * cos(angle) + PRESSURE * sin(angle), rel=1e-11)


def test_softening_branch_of_cohesion_is_met_in_first_order_of_the_step():
    loss = 4e3 / 0.1 * COS * octahedral(1.0)
    amount = 0.1
    g = (SHEAR * amount - SIN * PRESSURE - COHESION * COS) / (2.0 * SHEAR - loss)
    exact = SHEAR * amount - 2.0 * SHEAR * g
    assert octahedral(g) < 0.1
    counts = np.array([100, 200, 400])
    cohesion_alone = SOFT | {"residual_friction_angle_deg": 30.0}
    errors = [sheared(*one_point(LAW, **cohesion_alone), PRESSURE, amount, int(n))[0].xy - exact for n in counts]
    slope = np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.1)
    growth = 0.5 * amount / counts[0] / (1.0 - loss / (2.0 * SHEAR))  # of slip in one step, the strength falling
    assert errors[0] == pytest.approx(loss * growth, rel=0.5)  # between half a step's loss and all of it


def test_dilation_falls_with_plastic_strain_and_ends_where_its_residual_is_zero():
    falling = {"dilation_angle_deg": DILATION, "residual_dilation_angle_deg": 0.0, "residual_plastic_strain": 0.1}
    path = compressed(*one_point(LAW, **falling), PRESSURE, 0.4, 80)
    rates = [(lateral - 0.005) / (lateral + 0.005) for _, history, lateral in path if history.plastic_strain > 0.0]
    assert rates[1] > 0.5 * sin(radians(DILATION))
    assert rates[-1] == pytest.approx(0.0, abs=1e-9)
    assert all(later <= earlier + 1e-9 for earlier, later in pairwise(rates[1:]))


def test_strain_at_the_residual_shrinks_with_the_cell_where_a_reference_is_named():
    for cell, factor in ((0.125, 0.5), (0.25, 1.0), (0.5, 2.0)):
        law, _ = build(LAW, cell=cell, **SOFT, softening_reference_cell_m=0.25)
        assert law.softening == pytest.approx(10.0 * factor, rel=IDENTITY)


def test_a_field_of_peaks_brings_residuals_in_proportion():
    peaks = np.array([2e3, 5e3, 11e3])
    law, history = build(LAW, count=3, strengths={"cohesion": peaks}, friction_angle_deg=0.0, residual_cohesion_kpa=1.0,
                         residual_plastic_strain=0.1)  # fmt: skip
    for point, peak in enumerate(peaks):
        strong, _ = update_stress(at(law, point), NOTHING, Tensor(0.0, 0.0, 0.0, 0.5), at(history, point), 1e-3)
        weak, _ = strained(at(law, point), at(history, point), NOTHING, (0.0, 0.0, 1.0), steps=50)
        assert (strong.xy, weak.xy) == pytest.approx((peak, 0.2 * peak), rel=IDENTITY)


# --- every region of the surface


def trials(count, spread, seed):
    random = np.random.default_rng(seed)
    for values in random.normal(0.0, spread, (count, 3)) + random.normal(0.0, spread, (count, 1)):
        yield np.sort(values)[::-1]


@pytest.mark.parametrize("tension", [np.inf, 6e3, 0.0])
@pytest.mark.parametrize(
    ("cohesion", "friction", "dilation"),
    [(5e3, 30.0, 10.0), (5e3, 30.0, 30.0), (5e3, 0.0, 0.0), (0.0, 35.0, 5.0), (5e3, 30.0, 0.0)],
)
def test_return_is_plastic_flow_of_the_surfaces_it_ends_on(cohesion, friction, dilation, tension):
    s, p, limit = sin(radians(friction)), sin(radians(dilation)), 2.0 * cohesion * cos(radians(friction))
    elastic = np.full((3, 3), LAME) + 2.0 * SHEAR * np.eye(3)
    planes = list(permutations(range(3), 2))
    visited = set()
    for trial in trials(3000, 30e3, seed=3):
        relaxed, growth, swelling = relax(Principal(*trial), tension, limit, s, p, LAME, SHEAR)
        stress, scale = np.array(relaxed), np.abs(trial).max()
        active, flows = [], []
        for major, minor in planes:
            over = (1.0 + s) * stress[major] - (1.0 - s) * stress[minor] - limit
            assert over <= IDENTITY * scale
            if over >= -1e-10 * scale:
                active.append((major, minor))
                flows.append((1.0 + p) * np.eye(3)[major] - (1.0 - p) * np.eye(3)[minor])
        for axis in range(3):
            assert stress[axis] <= tension + IDENTITY * scale
            if stress[axis] >= tension - 1e-10 * scale:
                active.append(axis)
                flows.append(np.eye(3)[axis])
        assert stress[0] >= stress[1] >= stress[2]
        flow = np.linalg.solve(elastic, trial - stress)
        if len(active) == 6 and p == 0.0:  # apex that shearing without dilation cannot reach: opening as well
            flows.append(np.ones(3))
        visited.add(tuple(active))
        missing = nnls(np.array(flows).T, flow)[1] if flows else np.abs(flow).max()
        assert missing <= 1e-9 * scale / SHEAR
        deviator = flow - flow.mean()
        assert growth == pytest.approx(np.sqrt(2.0 / 3.0 * deviator @ deviator), rel=1e-9, abs=1e-15)
        assert swelling == pytest.approx(flow.sum(), rel=1e-9, abs=1e-12 * scale / SHEAR)
    # Elastic, plane and two edges; an apex but for Tresca; with a cut-off its plane, edge and apex and their meetings.
    assert len(visited) >= (4 if friction == 0.0 else 5) + (0 if tension == np.inf or cohesion == 0.0 else 4)


def test_tension_ends_at_the_apex_and_with_a_cutoff_at_that():
    pull = (0.02, 0.02, 0.0)
    for steps in (1, 10):
        stress, history = strained(*one_point(LAW), NOTHING, pull, steps)
        assert stress == pytest.approx(isotropic(APEX), rel=IDENTITY, abs=1e-9)
        # The cut-off is associated, so that the third direction only follows: 2 nu T, as in plane strain elasticity.
        stress, _ = strained(*one_point(LAW, tension_cutoff_kpa=2.0), NOTHING, pull, steps)
        assert stress == pytest.approx((2e3, 2e3, 1.2e3, 0.0), rel=1e-11, abs=1e-9)
    stress, history = strained(*one_point(LAW, tension_cutoff_kpa=1.0), isotropic(-1e3), (0.004, 0.0, 0.0))
    assert stress.xx == pytest.approx(1e3, rel=IDENTITY)
    assert stress.yy == pytest.approx(-1e3 + LAME / (LAME + 2.0 * SHEAR) * 2e3, rel=1e-11)
    assert history.plastic_strain > 0.0
    far, _ = strained(*one_point(LAW, tension_cutoff_kpa=1e6), NOTHING, pull)
    assert far == pytest.approx(isotropic(APEX), rel=IDENTITY)


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


def test_without_friction_it_is_tresca():
    for pressure in (-20e3, 0.0, 80e3):
        stress, _ = sheared(*one_point(LAW, friction_angle_deg=0.0), pressure, 0.5)
        assert stress == pytest.approx((-pressure, -pressure, -pressure, COHESION), rel=IDENTITY)


def test_stress_at_the_apex_stays_there_without_strain_and_leaves_it_elastically():
    law, history = one_point(LAW)
    stress, past = update_stress(law, isotropic(APEX), NOTHING, history, 1e-3)
    assert stress == pytest.approx(isotropic(APEX), rel=IDENTITY)
    assert past.plastic_strain < 1e-15
    stress, _ = update_stress(law, stress, Tensor(-0.001, -0.001, 0.0, 0.0), past, 1e-3)
    assert stress.zz == pytest.approx(APEX - 0.002 * LAME, rel=1e-11)


def test_stress_beyond_yield_at_the_start_returns_without_strain():
    law, history = one_point(LAW)
    stress, past = update_stress(law, Tensor(-10e3, -90e3, -30e3, 0.0), NOTHING, history, 1e-3)
    assert (1.0 + SIN) * stress.xx - (1.0 - SIN) * stress.yy == pytest.approx(2.0 * COHESION * COS, rel=1e-11)
    assert past.plastic_strain > 0.0
