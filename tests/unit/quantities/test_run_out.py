import numpy as np
import pytest

from rfmpm.quantities.run_out import front, influence_distance, run_out, run_out_censored

IDENTITY = 1e-12


@pytest.mark.parametrize(("quantile", "expected"), [(1.0, 3.0), (0.76, 3.0), (0.75, 2.0), (0.26, 2.0), (0.25, 1.0)])
def test_front_is_the_first_point_with_the_share_of_the_volume_behind_it(quantile, expected):
    # From the left: volumes 1, 2, 1 at x = 1, 2, 3.
    assert front(np.array([3.0, 1.0, 2.0]), np.array([1.0, 1.0, 2.0]), quantile) == expected


@pytest.mark.parametrize("count", [1, 3, 7, 1000])
def test_front_of_quantile_one_is_the_furthest_point_whatever_the_sums_round_to(count):
    x = np.linspace(0.0, 1.0, count)[::-1]
    assert front(x, np.full(count, 0.1), 1.0) == x.max()


def test_run_out_is_from_the_toe_to_the_front(came_to):
    assert run_out(came_to((5.5, 0.25), (6.5, 0.25), (7.5, 0.25))) == 1.5


def test_run_out_takes_the_quantile_of_the_volume(came_to):
    places = [(5.5 + i, 0.25) for i in range(5)]
    volumes = [1.0, 1.0, 1.0, 0.9, 0.1]
    assert run_out(came_to(*places, volume_initial=volumes, front_quantile=0.975)) == 8.5 - 6.0
    assert run_out(came_to(*places, volume_initial=volumes, front_quantile=0.98)) == 9.5 - 6.0


def test_volume_now_has_no_say(came_to):
    places = [(5.5, 0.25), (6.5, 0.25)]
    assert run_out(came_to(*places, volume=[0.001, 1.0], volume_initial=[0.9, 0.1], front_quantile=0.9)) == 0.0


def test_smaller_mass_further_away_is_not_the_front(came_to):
    assert run_out(came_to((6.5, 0.25), (7.5, 0.25), (8.5, 0.25), (15.5, 0.25))) == 2.5


def test_larger_mass_is_the_one_with_more_volume_not_more_points(came_to):
    state = came_to((6.5, 0.25), (7.5, 0.25), (8.5, 0.25), (15.5, 0.25), volume_initial=[0.25, 0.25, 0.25, 1.0])
    assert run_out(state) == 9.5


def test_failed_mass_holds_together_across_a_corner(came_to):
    assert run_out(came_to((6.5, 1.5), (6.5, 0.5), (7.5, 1.5), (8.5, 0.5))) == 2.5


def test_what_has_not_failed_neither_counts_nor_connects(state):
    failed = [(6.5, 0.25), (6.6, 0.25), (8.5, 0.25)]
    still = [(7.5, 0.25), (12.5, 0.25)]
    assert run_out(state([(2.0, 1.0)] * 3 + still, failed + still)) == pytest.approx(0.6, abs=IDENTITY)


def test_front_behind_the_toe_is_no_run_out(came_to):
    assert run_out(came_to((4.5, 0.25), (5.2, 0.25))) == 0.0


@pytest.mark.parametrize(("x", "censored"), [(18.9, 0), (19.0, 0), (19.1, 1), (20.0, 1)])
def test_run_out_is_censored_within_a_cell_of_the_far_wall(came_to, x, censored):
    assert run_out_censored(came_to((x, 0.25))) == censored


def test_a_small_mass_at_the_far_wall_does_not_censor(came_to):
    assert run_out_censored(came_to((6.5, 0.25), (7.5, 0.25), (19.5, 0.25))) == 0


def test_nothing_failed(body):
    state = body()
    assert (run_out(state), run_out_censored(state)) == (0.0, 0)
    assert influence_distance(state) == 2.0  # the width of the slope alone


def test_everything_failed(body):
    # The whole body slides 3 m: its furthest point was at 5.25.
    state = body(lambda x, y: (x + 3.0, y))
    assert (run_out(state), run_out_censored(state)) == (2.25, 0)
    assert influence_distance(state) == 2.25 + 2.0 + 3.75


def test_influence_distance_adds_slope_and_retrogression(state):
    crest = [(3.25, 1.75), (1.75, 1.75)]
    after = [(8.5, 0.25), (7.5, 0.25)]
    assert influence_distance(state(crest, after)) == 2.5 + (6.0 - 4.0) + (4.0 - 1.75)
