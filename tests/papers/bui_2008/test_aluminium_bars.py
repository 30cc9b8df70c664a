"""Collapse of aluminium bars: Bui et al. (2008), Int. J. Numer. Anal. Methods Geomech. 32, 1537-1570.

The measured curve, `surface.csv`, was read from the paper's figure to about 1 mm; the area below it is 203 cm2, that of
the column 200 cm2, so that no computed surface that keeps its mass comes closer than about 0.7 mm. There is no surface
of points: `rfmpm.benchmark.frictional.bars` has three readings of one, and `reports/frictional.md` what they find on
finer cells and what governs it. With the soil's data as given, none fitted, root mean square in mm:

    cell                           10 mm   5 mm   2.5 mm
    height at first density         1.5    2.9    3.9
    the same, present volume        1.8    3.3    4.3
    highest point in a cell         3.7    3.8    4.0

It grows as the cells shrink: the share of numerical dissipation falls from 15 to 5 % of gravity's work. So a good
match on coarse cells is in part that of two errors, and 1.7 mm, the best published code known to us, is not met.
"""

from functools import cache

import numpy as np
import pytest

from rfmpm.benchmark.frictional import bars
from rfmpm.benchmark.frictional.cases import CELL, collapse
from rfmpm.benchmark.frictional.rates import inertial_number

COARSE, MIDDLE, FINE = 0.01, 0.005, 0.0025  # [m]
TWENTIETH = 5e-3  # of the height [m]


@cache
def points(law, cell):
    outcome = collapse(bars.NAME, {CELL: cell, "material.0.law": law})
    assert outcome.status in ("ok", "not_at_rest")
    return outcome.points


@pytest.mark.parametrize("reading", bars.READINGS)
def test_surface_of_the_column_before_it_collapses_is_its_height(reading):
    state = collapse(bars.NAME, {"time.end_s": 1e-5}).points
    at = np.array([0.0, 0.05, 0.1, 0.19])
    # The points move by micrometres.
    np.testing.assert_allclose(bars.READINGS[reading](state, MIDDLE, at), 0.1, rtol=1e-3)
    assert bars.READINGS[reading](state, MIDDLE, np.array([0.3])) == 0.0


def test_readings_keep_the_area_and_the_fronts_are_where_the_soil_ends():
    rng = np.random.default_rng(1)
    x = rng.uniform(0.0, 0.3, 4000)
    state = {"x": x, "y": np.zeros(4000), "volume": np.full(4000, bars.AREA / 4000)}
    at = np.linspace(0.0, 0.4, 4001)
    for reading in (bars.by_mass, bars.by_volume):
        assert np.trapezoid(reading(state, MIDDLE, at), at) == pytest.approx(bars.AREA, rel=1e-3)
    assert bars.front(state, MIDDLE) == pytest.approx(0.3, abs=2.0 * MIDDLE)
    assert bars.front_of_share(x, state["volume"]) == pytest.approx(0.995 * 0.3, abs=2e-3)


@pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])
@pytest.mark.parametrize("reading", bars.READINGS)
def test_twenty_cells_high_stays_within_a_twentieth_of_the_height(law, reading):
    # Regression: 2.6 to 3.8 mm.
    assert bars.error(bars.READINGS[reading], points(law, MIDDLE), MIDDLE) < TWENTIETH


def test_crest_stays_and_the_front_comes_to_where_it_was_measured():
    state = points("mohr_coulomb", MIDDLE)
    at, height = bars.measured()
    assert bars.by_mass(state, MIDDLE, at[:1])[0] == pytest.approx(height[0], abs=1e-3)  # the reading error
    assert bars.front(state, MIDDLE) == pytest.approx(0.44, abs=0.015)


def test_more_friction_leaves_the_pile_steeper():
    at = np.array([0.1])
    soft, firm = (
        bars.by_mass(collapse(bars.NAME, {CELL: COARSE, "material.0.friction_angle_deg": angle}).points, COARSE, at)
        for angle in (19.8, 25.0)
    )
    assert firm > soft + 1e-3  # the reading error


def test_collapse_is_a_dense_flow_whose_inertial_number_counts():
    # Regression: 0.04 on cells of 5 mm; quasi-static below 0.001, a gas of bars above 0.1 or so.
    assert 0.02 < inertial_number(bars.NAME, COARSE) < 0.08


@pytest.mark.slow
def test_forty_cells_high_stays_within_a_twentieth_of_the_height():
    # Regression: 3.9 mm.
    assert bars.error(bars.by_mass, points("mohr_coulomb", FINE), FINE) < TWENTIETH
