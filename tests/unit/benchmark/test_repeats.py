"""Estimators carried out on rows drawn from a bank: which rows they get, what they cost, how they are judged."""

import numpy as np
import pytest

from rfmpm.benchmark.probabilities.repeats import Bank, Outcome, carry_out, judge, repeats
from rfmpm.estimators import MonteCarlo, Multilevel, Question

MEAN = Question("run_out", "mean")


def bank(fine: int = 300, coarse: int = 4000, block: int = 1) -> Bank:
    generator = np.random.default_rng(7)
    y = generator.standard_normal(coarse)
    levels = [y[:fine] + 0.1 * generator.standard_normal(fine), y]
    return Bank(levels, [np.full(fine, 8.0), np.full(coarse, 1.0)], (1.0, 0.125), y[:, None], block)


def test_index_i_is_the_ith_realisation_of_the_order():
    rows, order = bank(), np.arange(4000)[::-1]
    order = np.concatenate([order[order < 300], order[order >= 300]])
    found = carry_out(lambda features: MonteCarlo(MEAN, 10), rows, order)
    assert found.value == pytest.approx(rows.value[0][290:300].mean(), rel=1e-12)  # identity
    assert found.cost == 10.0


def test_the_coarser_realisations_count_with_their_cost():
    rows = bank()
    found = carry_out(lambda features: Multilevel(MEAN, 1, 64), rows, np.arange(4000))
    assert found.cost > 64.0 * 1.125
    assert (found.cost - 64.0) / 0.125 == pytest.approx(round((found.cost - 64.0) / 0.125), abs=1e-9)  # identity


def test_features_follow_the_order():
    rows, order, seen = bank(), np.arange(4000)[::-1].copy(), []
    carry_out(lambda features: seen.append(features(range(2, 5))) or MonteCarlo(MEAN, 2), rows, np.roll(order, 300))
    assert np.array_equal(seen[0], rows.features[np.roll(order, 300)[2:5]])


def test_what_the_bank_does_not_hold_is_an_error():
    with pytest.raises(IndexError, match="301 realisations planned, 300 at hand"):
        carry_out(lambda features: MonteCarlo(MEAN, 301), bank(), np.arange(4000))


def test_an_order_begins_with_what_level_0_holds_and_keeps_replicates_together():
    order = bank(fine=320, block=32).order(np.random.default_rng(1))
    assert sorted(order[:320]) == list(range(320))
    assert sorted(order) == list(range(4000))
    assert np.array_equal(order.reshape(-1, 32) % 32, np.tile(np.arange(32), (125, 1)))
    assert not np.array_equal(order, np.arange(4000))


def test_repeats_draw_anew():
    values = [found.value for found in repeats(lambda features: MonteCarlo(MEAN, 20), bank(), 5, 1)]
    assert len(set(values)) == 5


def test_judging():
    found = judge([Outcome(1.0, 0.0, 2.0, 3.0), Outcome(4.0, 3.5, 4.5, 5.0)], 2.0)
    assert (found.bias, found.coverage, found.cost) == (0.5, 0.5, 4.0)
    assert found.root_mean_square_error == pytest.approx(np.sqrt(2.5), rel=1e-12)  # identity
