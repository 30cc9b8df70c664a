"""Stratified sampling: unbiased, covering and cheap where a direction matters, no worse than plain where none does."""

import numpy as np
import pytest
from rare_problem import PROBLEMS, VARIABLES, Campaign, Problem, linear, repeat, rows_of

from rfmpm.estimators import Question, Stratified
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.estimators.rounds import STRATA
from rfmpm.estimators.stratified import weighted_shares

STANDARD_ERRORS = 3.5  # as in test_estimators
MOST = 400


def check(name: str, probability: float, most: int, repeats: int):
    found = repeat(PROBLEMS[name](probability), most, repeats)
    scatter = found.value.std(ddof=1)
    assert abs(found.value.mean() - probability) < STANDARD_ERRORS * scatter / np.sqrt(repeats)
    # standard errors of a measured coverage of 0.95
    assert found.coverage(probability) >= 0.95 - 3.3 * np.sqrt(0.05 * 0.95 / repeats)
    assert np.all((found.lower >= 0.0) & (found.lower <= found.value) & (found.upper <= 1.0))
    # plain Monte Carlo's variance, plus 4 standard errors of a measured variance of skewed counts
    plain = probability * (1.0 - probability) / most
    kurtosis = 1.0 / (most * probability) + 2.0
    assert found.value.var(ddof=1) < plain * (1.0 + 4.0 * np.sqrt(kurtosis / repeats))
    return found


@pytest.mark.parametrize("name", ["linear", "two sided"])  # estimates of the others are skewed: many repeats
def test_is_unbiased_and_covers_in_short(name):
    check(name, 0.02, MOST, 40)


@pytest.mark.slow
@pytest.mark.parametrize("probability", [0.02, 1e-3])
@pytest.mark.parametrize("name", PROBLEMS)
def test_is_unbiased_and_covers(name, probability):
    check(name, probability, 1100 if probability < 0.01 else MOST, 150)


def test_a_tenth_of_plain_runs_gives_a_small_probability_to_a_third():
    # plain Monte Carlo takes 11 100 runs for a relative error of 0.3; measured here: 0.25
    found = repeat(linear(1e-3), 1100, 30)
    error = np.sqrt(np.mean((found.value / 1e-3 - 1.0) ** 2))
    assert error < 0.3 * (1.0 + 4.0 / np.sqrt(2.0 * 30))


# What a campaign does


@pytest.fixture(scope="module")
def finished():
    campaign = Campaign(linear(0.02), 5, MOST)
    return campaign, campaign.run()


def test_rounds_follow_from_the_rows_before_them_alone(finished):
    campaign, rows = finished
    whole = campaign.estimator.rounds(rows)
    assert [one.start for one in whole] == [0, 100, 200, 400]
    for n in (0, 99, 100, 150, 399):
        part = campaign.estimator.rounds(rows.first([n]))
        for one, same in zip(part, whole, strict=False):
            assert one.edges.tobytes() == same.edges.tobytes()
            assert (one.direction is None) == (same.direction is None) == (one.start == 0)
            if one.start:
                assert one.direction.tobytes() == same.direction.tobytes()


def test_plan_names_what_is_missing_and_ends(finished):
    campaign, rows = finished
    estimator = campaign.estimator
    assert estimator.plan(rows) == []
    holed = rows.where(~np.isin(rows.index, [3, 4, 50]) & (rows.index < 100))
    assert [run.indices for run in estimator.plan(holed)] == [range(3, 5), range(50, 51)]
    assert [run.indices for run in estimator.plan(rows.first([250]))] == [range(250, 400)]


def test_stops_when_the_interval_is_narrow():
    campaign = Campaign(linear(0.05), 3, 5000, half_width=0.02)
    rows = campaign.run()
    found = campaign.estimator.estimate(rows)
    assert 100 < rows.value.size < 5000
    assert found.upper - found.lower <= 0.04
    assert campaign.estimator.plan(rows) == []


def test_strata_divide_the_standard_normal_distribution(finished):
    campaign, rows = finished
    own = campaign.estimator.rounds(rows)[2]
    assert own.probability.sum() == pytest.approx(1.0, abs=1e-12)  # identity
    assert np.linalg.norm(own.direction) == pytest.approx(1.0, abs=1e-12)  # identity
    span = range(own.start, own.stop)
    plain = campaign.features(span)
    placed = own.placed(span, plain)
    across = np.eye(VARIABLES) - np.outer(own.direction, own.direction)
    np.testing.assert_allclose(placed @ across, plain @ across, rtol=0, atol=1e-12)  # identity
    # weighted by their strata, scores have the moments of a standard-normal number
    generator = np.random.default_rng(7)
    many = generator.standard_normal((500 * STRATA, VARIABLES))
    score = own.placed(range(own.start, own.start + len(many)), many) @ own.direction
    weight = np.tile(own.probability / 500, 500)
    for power, moment in ((1, 0.0), (2, 1.0)):
        deviation = np.sqrt(np.sum(weight**2 * (score**power - moment) ** 2))
        assert abs(weight @ score**power - moment) < 4.0 * deviation  # statistical


def test_the_curve_falls_within_its_band_and_agrees_with_the_answer(finished):
    campaign, rows = finished
    band = campaign.estimator.exceedance_curve(rows)
    for edge in (band.lower, band.value, band.upper):
        assert np.all(np.diff(edge) <= 1e-12)
    assert np.all((band.lower <= band.value) & (band.value <= band.upper))
    found = campaign.estimator.estimate(rows)
    (at_limit,) = campaign.estimator.exceedance_curve(rows, np.array([campaign.problem.limit])).value
    assert at_limit == pytest.approx(found.value, rel=1e-12)  # identity


# Extremes


def constant(value: float, noise: bool = False) -> Problem:
    return Problem(lambda eta, rest: np.full(len(eta), value) + noise * eta[:, 0], 10.0, float(value > 10.0))


@pytest.mark.parametrize("noise", [False, True])
@pytest.mark.parametrize(("value", "expected"), [(0.0, 0.0), (99.0, 1.0)])
def test_never_and_always_have_intervals_with_width(value, expected, noise):
    campaign = Campaign(constant(value, noise), 1, MOST)
    found = campaign.estimator.estimate(campaign.run())
    assert found.value == pytest.approx(expected, abs=1e-12)  # identity
    assert 0.0 <= found.lower <= found.value <= found.upper <= 1.0
    assert found.upper > found.lower
    assert ("0 of 400 exceed: the upper bound rests on the fit" in found.note) == (noise and value == 0.0)


def answer(values, is_censored=None):
    campaign = Campaign(linear(0.02), 1, MOST)
    return campaign.estimator.estimate(rows_of(values, is_censored))


@pytest.mark.parametrize("n", [0, 1, 50, 100, 130, 300])
def test_all_failed_and_all_censored(n):
    found = answer(np.full(n, np.nan))
    assert np.isnan(found.value)
    assert (found.lower, found.upper) == (0.0, 1.0)
    censored = answer(np.full(n, 0.1), np.ones(n, bool))
    assert (censored.value == pytest.approx(1.0, abs=1e-12)) == (n > 0)  # identity
    assert 0.0 <= censored.lower <= censored.upper == 1.0


def test_failed_rows_are_bounds(finished):
    campaign, rows = finished
    complete = campaign.estimator.estimate(rows)
    holed = rows_of(np.where(np.arange(rows.value.size) >= 395, np.nan, rows.value))  # in the last round
    found = campaign.estimator.estimate(holed)
    assert found.lower <= complete.value <= found.upper
    assert found.upper - found.lower > complete.upper - complete.lower
    assert "5 failed of 400 counted both ways" in found.note


def test_a_single_count_has_the_exact_interval():
    for count, n in ((0, 30), (7, 30), (30, 30)):
        found = weighted_shares(np.ones(1), np.array([count]), np.array([n]), np.array([0.3]), 0.95)
        np.testing.assert_allclose(found, clopper_pearson(count, n), rtol=1e-9, atol=1e-15)  # identity
    assert weighted_shares(*(np.zeros(0),) * 4, 0.95) == (0.0, 1.0)


def test_questions_that_it_does_not_answer():
    probability = Question("run_out", "exceedance", limit=1.0)
    for question, options, sentence in (
        (Question("run_out", at_most=500), {}, "exceeding a limit only"),
        (probability, {}, "how many realisations"),
        (probability, {"realisations": 0}, "realisations = 0"),
        (probability, {"realisations": 9, "pilot_size": 0}, "pilot_size = 0"),
    ):
        with pytest.raises(ValueError, match=sentence):
            Stratified(question, lambda indices: np.zeros((len(indices), 1)), **options)
