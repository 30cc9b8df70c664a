"""Double sampling: where coarse runs are cut into strata, what is chosen of each, what a choice may rest on."""

import numpy as np
import pytest

from rfmpm.estimators import Exceedances, Question, Rows, TwoPhase, Value
from rfmpm.estimators.discretisation import discretisation, discretisation_of_quantile
from rfmpm.estimators.strata import natural_breaks, quotas

MEAN = Question("run_out")


def test_cuts_lie_in_the_gaps():
    values = np.concatenate([np.zeros(8), np.linspace(5.0, 6.0, 40), np.linspace(12.0, 13.0, 16)])
    assert natural_breaks(np.random.default_rng(1).permutation(values)) == pytest.approx([2.5, 9.0], rel=1e-12)


def test_a_few_values_far_out_are_no_stratum_of_their_own():
    edges = natural_breaks(np.concatenate([np.linspace(0.0, 1.0, 63), [100.0]]), 2)
    assert edges.size == 1
    assert np.sum(np.linspace(0.0, 1.0, 63) > edges[0]) + 1 == 4  # a sixteenth of 64


@pytest.mark.parametrize(("values", "number"), [([], 0), ([3.0] * 20, 0), ([1.0, 2.0], 1), ([1.0, np.inf, np.inf], 0)])
def test_as_many_cuts_as_values_allow(values, number):
    assert natural_breaks(np.array(values)).size == number


def test_quotas_are_even_but_for_what_is_taken_and_held():
    assert list(quotas(np.array([2, 20, 1]), np.array([100, 100, 100]), 60)) == [20, 20, 20]
    assert list(quotas(np.array([2, 30, 1]), np.array([5, 100, 100]), 60)) == [5, 30, 25]
    assert list(quotas(np.array([1, 1, 1]), np.array([2, 2, 2]), 60)) == [2, 2, 2]


def rows(own: np.ndarray, coarse: np.ndarray, indices: np.ndarray) -> Rows:
    """Coarse runs of all indices, own ones of some."""
    level = np.repeat([0, 1], [indices.size, coarse.size])
    value = np.concatenate([own[indices], coarse])
    index = np.concatenate([indices, np.arange(coarse.size)])
    return Rows(level, index, value, np.zeros(level.size, bool), np.array([1.0, 0.15])[level])


def outcomes(seed: int, n: int) -> tuple[np.ndarray, np.ndarray]:
    """A fifth stand on coarse cells, of which a quarter fail on the own ones; the others fail on both."""
    generator = np.random.default_rng(seed)
    stands, fails = generator.random(n) < 0.2, generator.random(n) < 0.25
    coarse = np.where(stands, 0.0, 10.0 + generator.standard_normal(n))
    return np.where(stands, np.where(fails, 10.0, 0.0), 1.0 + coarse + 0.1 * generator.standard_normal(n)), coarse


def campaign(seed: int, question: Question, n: int) -> tuple[TwoPhase, Rows]:
    own, coarse = outcomes(seed, 16 * n)
    estimator, done = TwoPhase(question, None, n), [np.zeros(0, int)] * 2
    while planned := estimator.plan(found := rows(own, coarse[: done[1].size], done[0])):
        for level, indices in planned:
            done[level] = np.union1d(done[level], indices)
    return estimator, found


def test_own_runs_go_where_the_coarse_ones_leave_the_answer_open():
    estimator, found = campaign(1, MEAN, 96)
    own = found.on_level(0)
    stands = found.on_level(1).value[own.index] == 0.0
    assert own.value.size == 96
    assert np.all(np.isin(np.arange(32), own.index))  # the first ones whatever they give
    assert stands.sum() == 32  # a third, of a fifth of the slopes
    assert estimator.used(found).value.size == found.value.size


def test_what_lies_beyond_a_gap_of_its_stratum_is_not_used():
    estimator, found = campaign(1, MEAN, 96)
    own = found.on_level(0).index
    holed = found.where((found.level > 0) | (found.index != own[40]))
    of = estimator.strata(found)
    expected = own[(of[own] != of[own[40]]) | (own < own[40])]
    assert list(estimator.used(holed).on_level(0).index) == list(expected)


@pytest.mark.parametrize("kind", ["mean", "exceedance"])
def test_unequal_shares_do_not_bias_and_intervals_cover(kind):
    question = Question("run_out", kind, limit=5.0 if kind == "exceedance" else None)
    truth = {"mean": 0.2 * 2.5 + 0.8 * 11.0, "exceedance": 0.85}[kind]
    found = [estimator.estimate(seen) for estimator, seen in (campaign(seed, question, 64) for seed in range(200))]
    values = np.array([one.value for one in found])
    assert abs(values.mean() - truth) < 4.0 * values.std(ddof=1) / np.sqrt(200)
    covered = np.mean([one.lower <= truth <= one.upper for one in found])
    assert covered > 0.95 - 4.0 * np.sqrt(0.05 * 0.95 / 200)
    plain = {"mean": np.sqrt(0.8 + 0.05 * 100.0 + 0.8 * 121.0 - truth**2), "exceedance": np.sqrt(0.85 * 0.15)}[kind]
    assert values.std(ddof=1) < 0.7 * plain / np.sqrt(64)


REPEATS = 200
CELLS = (0.25, 0.5)
FUNCTIONS = {"mean": Value(), "exceedance": Exceedances(np.array([5.0]))}


def cells_of(kind: str, estimator: TwoPhase, found: Rows):
    used = estimator.used(found)
    return discretisation(used, FUNCTIONS[kind], CELLS, stratum=estimator.strata(used))


@pytest.mark.parametrize("kind", FUNCTIONS)
def test_all_pairs_tell_the_error_of_the_cells_without_bias_and_with_its_scatter(kind):
    question = Question("run_out", kind, limit=5.0 if kind == "exceedance" else None)
    # ratio 2, order 1: coarser less finer. Those that fail on own cells alone, and 1 m more for the others
    truth = {"mean": -(0.05 * 10.0 + 0.8 * 1.0), "exceedance": -0.05}[kind]
    campaigns = [campaign(seed, question, 64) for seed in range(REPEATS)]
    found = [cells_of(kind, *one) for one in campaigns]
    values, errors = (np.array([getattr(one, key) for one in found]) for key in ("error", "standard_error"))
    assert {one.n for one in found} == {64}
    scatter = values.std(ddof=1)
    assert abs(values.mean() - truth) < 4.0 * scatter / np.sqrt(REPEATS)
    covered = np.mean([one.lower <= truth <= one.upper for one in found])
    assert covered > 0.95 - 4.0 * np.sqrt(0.05 * 0.95 / REPEATS)
    squares = (values - values.mean()) ** 2
    tolerance = 4.0 * np.hypot(squares.std(ddof=1), (errors**2).std(ddof=1)) / np.sqrt(REPEATS)
    assert np.mean(errors**2) > scatter**2 - tolerance
    if kind == "mean":  # that of a probability has what a difference not seen would add
        assert np.mean(errors**2) < scatter**2 + tolerance
    first = [discretisation(rows.where(rows.index < 32), FUNCTIONS[kind], CELLS) for _, rows in campaigns]
    assert scatter < 0.7 * np.std([one.error for one in first], ddof=1)  # they alone were used before


def test_the_error_of_the_cells_of_a_quantile_weighs_the_strata_too():
    # 0.2 stand on coarse cells, but a third of the pairs: the quantile of a quarter would lie among them
    estimator, found = campaign(5, MEAN, 512)
    used = estimator.used(found)
    cells = discretisation_of_quantile(used, 0.25, CELLS, stratum=estimator.strata(used))
    own, coarse = outcomes(5, 200_000)
    truth = np.quantile(coarse, 0.25) - np.quantile(own, 0.25)
    assert cells.n == 512
    assert abs(cells.error - truth) < 4.0 * cells.standard_error
    assert abs(discretisation_of_quantile(used, 0.25, CELLS).error - truth) > 4.0 * cells.standard_error


def test_a_stratum_without_pairs_leaves_the_error_to_the_others():
    estimator, found = campaign(1, MEAN, 96)
    of = estimator.strata(found)
    lost = found.where((found.level > 0) | (of[found.index] != of[found.on_level(1).value == 0.0][0]))
    cells = discretisation(lost, Value(), CELLS, stratum=of)
    assert cells.error == pytest.approx(-1.0, abs=4.0 * cells.standard_error)
