"""The slope of Toro Rojas et al., on coarse cells: what the study found comes out in order and kind.

Finer cells, histories and run times are in reports/papers/toro_rojas_slope.md.
"""

from functools import cache

import numpy as np
import pytest

from rfmpm.benchmark.papers import toro_rojas_runs as slope
from rfmpm.benchmark.papers.toro_rojas_runs import CELL, COHESION, STIFFNESS


@cache
def travel(cell=0.4, cohesion=0.1, stiffness=30e3):
    return slope.travel({CELL: cell, COHESION: cohesion, STIFFNESS: stiffness})


@pytest.mark.parametrize(("cohesion", "published"), [(0.1, 0.66), (1.8, 1.0)])
def test_size_was_chosen_to_meet_both_factors_of_safety(cohesion, published):
    assert slope.factor(cohesion) == pytest.approx(published, abs=0.005)  # half of the last published digit


def test_it_holds_at_the_cohesion_of_a_factor_of_one_and_not_at_the_least():
    assert travel(cohesion=1.8).furthest < slope.HELD < travel(cohesion=0.1).furthest


def test_travel_falls_with_cohesion():
    means = [travel(cohesion=cohesion).mean for cohesion in (0.1, 0.5, 1.0, 1.5)]
    assert means == sorted(means, reverse=True)
    assert means[0] > 2.0 * means[2]


def test_travel_does_not_depend_on_stiffness_once_it_fails():
    # Found 1 %; the scatter of a chaotic slide from rounding alone is of that order.
    assert travel(stiffness=300e3).mean == pytest.approx(travel().mean, rel=0.05)


def test_displacement_falls_with_stiffness_while_it_holds():
    soft, firm = travel(cohesion=1.8).furthest, travel(cohesion=1.8, stiffness=300e3).furthest
    assert soft / firm == pytest.approx(10.0, rel=0.2)  # elastic, but for what yields near the face


def test_finer_cells_travel_further():
    reaches = [travel(cell).run_out for cell in (0.8, 0.4, 0.32)]
    assert reaches == sorted(reaches)
    assert reaches[0] < reaches[-1]


def test_crown_and_centre_speed_up_and_slow_down_once_and_the_foot_moves_least():
    seen = slope.histories({CELL: 0.4, "time.end_s": 4.0})
    way = {place: seen[place][0] for place in slope.PLACES}
    assert way["foot"][-1] < 0.2 * min(way["crown"][-1], way["centre"][-1])
    for place in ("crown", "centre"):
        displacement, speed, acceleration = seen[place]
        assert np.all(np.diff(displacement) > -0.01 * displacement[-1])
        peak = int(speed.argmax())
        assert 0.5 < seen["time"][peak] < 2.5
        assert acceleration[:peak].mean() > 0.0 > acceleration[peak:].mean()
        assert speed[-1] < 0.2 * speed[peak]  # on these cells it still creeps
