"""Estimators carried out on rows drawn from a bank: which rows they get, what they cost, how they are judged."""

import numpy as np
import pytest

from rfmpm.benchmark.probabilities.repeats import LEAST_DRAWN, Bank, Outcome, carry_out, judge, repeats
from rfmpm.estimators import MonteCarlo, Multilevel, Question
from rfmpm.estimators.levels import FOLDS

MEAN = Question("run_out", "mean")


def bank(n: int = 4000, block: int = 1) -> Bank:
    generator = np.random.default_rng(7)
    y = generator.standard_normal(n)
    levels = [y + 0.1 * generator.standard_normal(n), y]
    return Bank(levels, [np.full(n, 8.0), np.full(n, 1.0)], (1.0, 0.125), y[:, None], block)


def test_index_i_is_the_ith_realisation_of_the_order():
    rows, order = bank(), np.arange(4000)[::-1]
    found = carry_out(lambda features: MonteCarlo(MEAN, 10), rows, order)
    assert found.value == pytest.approx(rows.value[0][3990:4000].mean(), rel=1e-12)  # identity
    assert found.cost == 10.0


def test_the_coarser_realisations_count_with_their_cost():
    rows = bank()
    found = carry_out(lambda features: Multilevel(MEAN, 1, 64), rows, np.arange(4000))
    assert found.cost > 64.0 * 1.125
    assert (found.cost - 64.0) / 0.125 == pytest.approx(round((found.cost - 64.0) / 0.125), abs=1e-9)  # identity


def test_features_follow_the_order():
    rows, order, seen = bank(), np.arange(4000)[::-1], []
    carry_out(lambda features: seen.append(features(range(2, 5))) or MonteCarlo(MEAN, 2), rows, order)
    assert np.array_equal(seen[0], rows.features[order[2:5]])


def test_more_than_was_drawn_is_an_error():
    with pytest.raises(IndexError):
        carry_out(lambda features: MonteCarlo(MEAN, 4001), bank(), np.arange(4000))


def test_draws_are_with_replacement_and_keep_copies_in_one_fold():
    order = bank(400).order(np.random.default_rng(1))
    assert order.size == LEAST_DRAWN
    fold = np.arange(order.size) % FOLDS
    for realisation in range(400):
        assert np.unique(fold[order == realisation]).size <= 1
    counts = np.bincount(order, minlength=400)  # of independent draws: variance near the mean
    assert abs(counts.var() - counts.mean()) < 4.0 * counts.mean() * np.sqrt(2.0 / 400)


def test_draws_keep_replicates_together():
    order = bank(3200, block=32).order(np.random.default_rng(1))
    assert np.array_equal(order.reshape(-1, 32) % 32, np.tile(np.arange(32), (order.size // 32, 1)))
    assert np.unique(order[::32]).size > 90


def test_repeats_draw_anew():
    values = [found.value for found in repeats(lambda features: MonteCarlo(MEAN, 20), bank(), 5, 1)]
    assert len(set(values)) == 5


def test_judging():
    found = judge([Outcome(1.0, 0.0, 2.0, 3.0), Outcome(4.0, 3.5, 4.5, 5.0)], 2.0)
    assert (found.bias, found.coverage, found.cost) == (0.5, 0.5, 4.0)
    assert found.root_mean_square_error == pytest.approx(np.sqrt(2.5), rel=1e-12)  # identity
