"""Subset simulation on problems whose probability is known, and where there is nothing to find."""

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from rfmpm.estimators.chains import PLAIN
from rfmpm.estimators.question import Question
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.subset_simulation import SubsetSimulation

SEED = 20160901


def rows_of(values, censored=None) -> Rows:
    n = len(values)
    censored = np.zeros(n, bool) if censored is None else np.asarray(censored, bool)
    return Rows(np.zeros(n, int), np.arange(n), np.asarray(values, float), censored, np.ones(n))


def estimator(limit, size=100, probability=0.1, at_most=100_000, **wanted) -> SubsetSimulation:
    question = Question("run_out", "exceedance", limit=limit, at_most=at_most, **wanted)
    return SubsetSimulation(question, size, probability)


def campaign(subset, quantity, generator, variables=2, censored=lambda value: np.zeros(value.shape, bool)) -> Rows:
    """Run a campaign to its end, with the steps of the sampler but numbers of another generator."""
    xi, values = np.zeros((0, variables)), np.zeros(0)
    while True:
        rows = rows_of(values, censored(values))
        course = subset.course(rows)
        start, end = len(values), len(course.parent)
        if start == end:
            assert subset.plan(rows) == []
            return rows
        z, width, parent = (
            generator.standard_normal((end - start, variables)),
            course.width[start:],
            course.parent[start:],
        )
        steps = np.sqrt(1.0 - width**2)[:, None] * xi[np.maximum(parent, 0)] + width[:, None] * z if start else z
        new = np.where((parent == PLAIN)[:, None], z, steps)
        xi, values = np.concatenate([xi, new]), np.concatenate([values, quantity(new)])


def linear(xi):
    return xi[:, 0]


def with_atom(xi):
    """Like a run-out: zero in 93 of 100 realisations, saturating."""
    return 16.0 * np.maximum(0.0, np.tanh(0.35 * (xi[:, 0] - 1.5)))


@pytest.mark.parametrize(("quantity", "probability"), [(linear, 0.3), (with_atom, 1e-2), (linear, 1e-3)])
def test_is_unbiased_and_its_interval_covers(quantity, probability):
    generator, repeats = np.random.default_rng(SEED), 50
    limit = float(quantity(np.full((1, 2), -ndtri(probability)))[0])
    subset = estimator(limit)
    estimates = [subset.estimate(campaign(subset, quantity, generator)) for _ in range(repeats)]
    values = np.array([estimate.value for estimate in estimates])
    # statistical tolerance: 4 standard errors; the bias of order 1 / level_size is within
    assert abs(values.mean() - probability) < 4.0 * values.std(ddof=1) / np.sqrt(repeats)
    # statistical tolerance: 4 binomial standard errors below 0.93, the least that is asked
    covered = np.mean([estimate.lower <= probability <= estimate.upper for estimate in estimates])
    assert covered > 0.93 - 4.0 * np.sqrt(0.93 * 0.07 / repeats)
    assert all(0.0 <= e.lower <= e.value <= e.upper <= 1.0 for e in estimates)


def test_a_small_probability_takes_far_fewer_runs_than_plain_monte_carlo():
    generator, probability, repeats = np.random.default_rng(SEED), 1e-4, 15
    subset = estimator(-ndtri(probability))
    found = [campaign(subset, linear, generator) for _ in range(repeats)]
    values = np.array([subset.estimate(rows).value for rows in found])
    runs = np.mean([rows.value.size for rows in found])
    # plain Monte Carlo's variance with as many runs, less 4 standard errors of the measured one
    plain = probability * (1.0 - probability) / runs
    assert values.var(ddof=1) * (1.0 - 4.0 * np.sqrt(2.0 / repeats)) < 0.2 * plain


def test_subset_simulations_are_added_until_the_interval_is_narrow():
    generator = np.random.default_rng(SEED)
    subset = estimator(-ndtri(0.01), relative_half_width=0.5)
    rows = campaign(subset, linear, generator)
    assert subset.question.excess(subset.estimate(rows)) <= 1.0
    assert len(subset.course(rows).runs) > 2
    short = estimator(-ndtri(0.01), at_most=1000, relative_half_width=0.5)
    rows = campaign(short, linear, generator)
    assert 0 < rows.value.size <= 1000


def test_the_plan_follows_from_the_rows_before_it_alone():
    subset = estimator(2.5)
    rows = campaign(subset, linear, np.random.default_rng(SEED))
    whole = subset.course(rows)
    for n in (0, 77, 200, 205, 220, 391):
        part = subset.course(rows.first([n]))
        assert n <= len(part.parent)
        np.testing.assert_array_equal(part.parent, whole.parent[: len(part.parent)])
        np.testing.assert_array_equal(part.width, whole.width[: len(part.width)])
    # What is missing of a turn is planned again, in pieces.
    holes = rows.first([300]).where(~np.isin(np.arange(300), [3, 4, 150]))
    assert [(run.level, run.indices) for run in subset.plan(holes)] == [(0, range(3, 5)), (0, range(150, 151))]
    with_coarse = Rows(
        *(np.concatenate([a, b]) for a, b in zip(vars(rows).values(), [[1], [0], [9.0], [False], [1.0]], strict=True))
    )
    assert subset.course(with_coarse).parent.tobytes() == whole.parent.tobytes()


def test_the_exceedance_curve_is_that_of_the_problem():
    subset = estimator(-ndtri(1e-3), size=500)
    rows = campaign(subset, linear, np.random.default_rng(SEED))
    band = subset.exceedance_curve(rows, np.linspace(-1.0, 3.0, 9))
    exact = ndtr(-band.at)
    assert np.all(np.diff(band.value) <= 0.0)
    # intervals of 95 %, of nine strongly correlated places; one seed
    assert np.sum((band.lower <= exact) & (exact <= band.upper)) >= 8
    assert subset.exceedance_curve(rows).at.size <= 200
    limit = subset.question.limit
    assert subset.exceedance_curve(rows, np.array([limit])).value[0] == subset.estimate(rows).value


@pytest.mark.parametrize(
    ("value", "limit", "expected", "note"),
    [
        (0.0, 1.0, (0.0, 0.0, 0.03), "no level above 0 was found"),
        (2.0, 1.0, (1.0, 0.97, 1.0), ""),
        (np.nan, 1.0, (np.nan, 0.0, 1.0), "200 failed of 200"),
    ],
    ids=["p = 0", "p = 1", "all failed"],
)
def test_where_all_runs_are_alike_the_first_level_answers(value, limit, expected, note):
    subset = estimator(limit)
    rows = rows_of(np.full(200, value))
    assert subset.plan(rows) == []
    found = subset.estimate(rows)
    assert found.value == pytest.approx(expected[0], nan_ok=True)
    assert (found.lower, found.upper) == pytest.approx(expected[1:], abs=0.02)
    assert note in found.note
    assert np.all((subset.exceedance_curve(rows).lower >= 0.0) & (subset.exceedance_curve(rows).upper <= 1.0))


def test_all_censored_exceed():
    found = estimator(1.0).estimate(rows_of(np.zeros(200), np.ones(200)))
    assert (found.value, found.upper) == (1.0, 1.0)
    assert "censored" in found.note


@pytest.mark.parametrize("n", [0, 1])
def test_before_the_first_level_is_complete_the_plain_runs_answer(n):
    found = estimator(1.0).estimate(rows_of(np.full(n, 2.0)))
    assert 0.0 <= found.lower <= found.upper <= 1.0
    assert found.n == n


def test_a_plateau_above_some_levels_ends_the_search_and_says_so():
    subset = estimator(9.0)
    rows = campaign(subset, lambda xi: np.minimum(xi[:, 0], 1.8), np.random.default_rng(SEED))
    found = subset.estimate(rows)
    assert (found.value, found.lower) == (0.0, 0.0)
    assert 0.0 < found.upper < 0.05  # of P = 0.036 above which nothing is known, a share that no chain exceeds
    assert "no level above 1.8 was found" in found.note


def test_a_limit_out_of_reach_of_so_many_runs_is_said():
    subset = estimator(-ndtri(1e-6), at_most=700)
    rows = campaign(subset, linear, np.random.default_rng(SEED))
    found = subset.estimate(rows)
    assert rows.value.size <= 700
    assert found.lower == 0.0
    assert 1e-6 < found.upper < 0.1
    assert "the limit was not reached" in found.note


def test_failed_runs_raise_the_upper_bound_alone():
    limit = -ndtri(1e-2)
    subset = estimator(limit)

    def fails_often(xi):
        return np.where(xi[:, 1] > 1.0, np.nan, xi[:, 0])

    rows = campaign(subset, fails_often, np.random.default_rng(SEED))
    found = subset.estimate(rows)
    assert "failed runs" in found.note
    # Those that fail are independent of the quantity: the estimate is right, and the bound counts them all.
    assert found.lower <= 1e-2 <= found.upper
    assert found.upper > np.exp(2.0 * np.log(found.value / found.lower)) * found.lower
    assert found.upper <= 1.0


def test_censored_runs_exceed_every_level():
    limit = -ndtri(1e-3)
    subset = estimator(limit)
    rows = campaign(subset, linear, np.random.default_rng(SEED), censored=lambda value: value > 3.0)
    assert "censored, counted as exceeding" in subset.estimate(rows).note
    assert subset.estimate(rows).value > 0.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"size": 105}, "level_size = 105 with level_probability = 0.1"),
        ({"probability": 0.6}, "has to be at most 0.5"),
        ({"size": 10}, "their product at least 2"),
        ({"at_most": 199}, r"at most 199 realisations: subset simulation begins with 2 x 100"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        estimator(1.0, **arguments)


def test_only_probabilities_are_found():
    with pytest.raises(ValueError, match="finds probabilities of exceeding a limit only"):
        SubsetSimulation(Question("run_out", half_width=1.0))
