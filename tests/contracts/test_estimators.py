"""Every listed estimator: unbiased on a known problem, intervals that cover, a plan that names what is missing."""

import numpy as np
import pytest

from rfmpm.estimators import ESTIMATORS

REPEATS = 4000
CONFIDENCE = 0.95
PROBABILITIES = (0.02, 0.2, 0.5, 0.9)


def binomial_standard_error(share: float, repeats: int) -> float:
    return np.sqrt(share * (1.0 - share) / repeats)


def repeated_estimates(name: str, probability: float, n: int = 40):
    """Estimates of P(U < probability) from independent uniform samples; U is turned so that small values exceed."""
    generator = np.random.default_rng(20160901)
    return [
        ESTIMATORS[name](n).estimate(-generator.random(n), limit=-probability, confidence=CONFIDENCE)
        for _ in range(REPEATS)
    ]


@pytest.mark.parametrize("probability", PROBABILITIES)
@pytest.mark.parametrize("name", ESTIMATORS)
def test_is_unbiased(name, probability):
    values = np.array([estimate.value for estimate in repeated_estimates(name, probability)])
    # statistical tolerance: 4 standard errors of the mean of the repeats
    assert abs(values.mean() - probability) < 4.0 * values.std(ddof=1) / np.sqrt(REPEATS)


@pytest.mark.parametrize("probability", PROBABILITIES)
@pytest.mark.parametrize("name", ESTIMATORS)
def test_interval_covers(name, probability):
    estimates = repeated_estimates(name, probability)
    assert all(0.0 <= e.lower <= e.value <= e.upper <= 1.0 for e in estimates)
    coverage = np.mean([e.lower <= probability <= e.upper for e in estimates])
    # statistical tolerance: 4 binomial standard errors (0.0138 with 4000 repeats), hence at least 0.936
    tolerance = 4.0 * binomial_standard_error(CONFIDENCE, REPEATS)
    assert CONFIDENCE - tolerance >= 0.93
    assert coverage >= CONFIDENCE - tolerance


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([0.0] * 10, 0.0),
        ([2.0] * 10, 1.0),
        ([2.0], 1.0),
        ([0.0], 0.0),
    ],
)
def test_interval_at_the_ends_is_inside_zero_and_one_and_has_width(name, values, expected):
    estimate = ESTIMATORS[name](len(values)).estimate(np.array(values), limit=1.0)
    assert estimate.value == expected
    assert 0.0 <= estimate.lower <= expected <= estimate.upper <= 1.0
    assert estimate.upper - estimate.lower > 0.1


@pytest.mark.parametrize("name", ESTIMATORS)
def test_all_failed_says_nothing(name):
    estimate = ESTIMATORS[name](5).estimate(np.full(5, np.nan), limit=1.0)
    assert np.isnan(estimate.value)
    assert (estimate.lower, estimate.upper) == (0.0, 1.0)
    assert "5 failed of 5" in estimate.note


@pytest.mark.parametrize("name", ESTIMATORS)
def test_plan_names_what_is_missing_in_order(name):
    estimator = ESTIMATORS[name](6)
    assert estimator.plan([]) == [range(6)]
    assert estimator.plan({4, 0, 11}) == [range(1, 4), range(5, 6)]
    assert estimator.plan(range(6)) == []


@pytest.mark.parametrize("name", ESTIMATORS)
def test_estimate_uses_the_planned_realisations_only(name):
    values = np.array([2.0, 0.0, 2.0, 2.0])
    assert ESTIMATORS[name](2).estimate(values, limit=1.0).value == 0.5
    assert ESTIMATORS[name](2).estimate(values, limit=1.0, censored=np.array([0, 1, 0, 0])).value == 1.0
