"""Comparisons of two ensembles with the same random numbers."""

import numpy as np
import pytest

from rfmpm.estimators import exceedance_difference, mean, mean_difference

REPEATS, N = 1000, 128
STANDARD_ERROR = np.sqrt(0.95 * 0.05 / REPEATS)


def test_pairs_take_out_what_is_common():
    rng = np.random.default_rng(3)
    common = rng.normal(0.0, 5.0, 50)
    one, other = common + 1.0 + rng.normal(0.0, 0.1, 50), common
    found = mean_difference(one, other)
    assert found.lower < 1.0 < found.upper
    assert found.upper - found.lower < 0.1 * (mean(one).upper - mean(one).lower)


def test_a_pair_with_a_failed_realisation_is_left_out():
    assert mean_difference([2.0, np.nan, 4.0], [1.0, 5.0, 1.0]).value == 2.0
    found = exceedance_difference([2.0, np.nan, 4.0], [1.0, 5.0, 1.0], 1.5)
    assert (found.value, found.n) == (1.0, 2)
    assert "1 pairs of 3" in found.note


def test_difference_of_probabilities_counts_pairs_that_differ():
    one, other = [1.0, 1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0, 0.0]
    found = exceedance_difference(one, other, 0.5)
    assert found.value == pytest.approx(0.2, rel=1e-12)
    # Agresti and Min: (2 - 1) / 7 plus or minus 1.96 sqrt(((2 + 1 + 1) / 7 - 1 / 49) / 7)
    half = 1.959963984540054 * np.sqrt((4.0 / 7.0 - 1.0 / 49.0) / 7.0)
    assert (found.lower, found.upper) == pytest.approx((1.0 / 7.0 - half, 1.0 / 7.0 + half), rel=1e-12)


def test_censored_members_count_as_exceeding():
    assert exceedance_difference([0.0, 0.0], [0.0, 0.0], 0.5, one_censored=[True, True]).value == 1.0


@pytest.mark.parametrize(("gained", "lost"), [(0.1, 0.1), (0.2, 0.05)])
def test_interval_covers(gained, lost):
    rng = np.random.default_rng(11)
    covered = 0
    for _ in range(REPEATS):
        u = rng.random(N)
        one = u < 0.5 + gained
        other = (u < 0.5) | (u > 1.0 - lost)
        found = exceedance_difference(one, other, 0.5)
        covered += found.lower <= gained - lost <= found.upper
    assert abs(covered / REPEATS - 0.95) < 4.0 * STANDARD_ERROR
