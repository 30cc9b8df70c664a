"""Intervals against independent formulas and by coverage."""

import numpy as np
import pytest
from scipy import stats

from rfmpm.estimators.intervals import clopper_pearson, dkw_half_width, quantile_ranks, student_t, wilson

IDENTITY = 1e-12


@pytest.mark.parametrize(("method", "interval"), [("exact", clopper_pearson), ("wilson", wilson)])
def test_binomial_interval_equals_scipy(method, interval):
    for n in (1, 2, 7, 64, 1000):
        for count in {0, 1, n // 3, n - 1, n}:
            for confidence in (0.8, 0.95, 0.99):
                expected = stats.binomtest(count, n).proportion_ci(confidence, method=method)
                # scipy finds the exact bounds with a root finder (absolute tolerance 1e-12 x a few)
                np.testing.assert_allclose(interval(count, n, confidence), tuple(expected), rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("interval", [clopper_pearson, wilson])
def test_binomial_interval_takes_arrays_and_no_trials(interval):
    lower, upper = interval(np.array([0, 3, 10]), np.array([0, 10, 10]))
    assert (lower[0], upper[0]) == (0.0, 1.0)
    assert lower[1] < 0.3 < upper[1]
    assert upper[2] == 1.0


def test_clopper_pearson_covers_every_probability():
    # Exact coverage by summation over the binomial distribution, no sampling: identity tolerance only.
    n = 30
    counts = np.arange(n + 1)
    lower, upper = clopper_pearson(counts, n)
    for p in np.linspace(0.001, 0.999, 333):
        weight = stats.binom.pmf(counts, n, p)
        assert weight[(lower <= p) & (p <= upper)].sum() >= 0.95 - IDENTITY


def test_wilson_covers_on_average():
    n = 64
    counts = np.arange(n + 1)
    lower, upper = wilson(counts, n)
    p = np.linspace(0.0005, 0.9995, 1000)
    coverage = [stats.binom.pmf(counts, n, q)[(lower <= q) & (q <= upper)].sum() for q in p]
    # Brown, Cai and DasGupta (2001): the average is within 0.01 of the level
    assert abs(np.mean(coverage) - 0.95) < 0.01


def test_student_t_equals_scipy():
    x = np.array([1.0, 4.0, 2.0, 8.0])
    expected = stats.ttest_1samp(x, 0.0).confidence_interval(0.9)
    np.testing.assert_allclose(student_t(x.mean(), x.std(ddof=1), 4, 0.9), tuple(expected), rtol=1e-10)


@pytest.mark.parametrize("n", [0, 1])
def test_student_t_of_fewer_than_two_is_infinite(n):
    assert student_t(3.0, 0.0, n) == (-np.inf, np.inf)


def test_dkw_half_width():
    assert dkw_half_width(0) == 1.0
    assert dkw_half_width(1) == 1.0
    assert dkw_half_width(100, 0.95) == pytest.approx(np.sqrt(np.log(40.0) / 200.0), rel=IDENTITY)


@pytest.mark.parametrize(("n", "p"), [(10, 0.5), (64, 0.5), (100, 0.95), (100, 0.05), (300, 0.99)])
def test_quantile_ranks_cover_and_are_the_tightest(n, p):
    lower, upper = quantile_ranks(n, p)
    below = stats.binom.cdf(lower - 1, n, p)  # the quantile lies below the lower order statistic
    above = stats.binom.sf(upper - 1, n, p) if upper <= n else 0.0
    assert below <= 0.025 + IDENTITY
    assert above <= 0.025 + IDENTITY
    assert stats.binom.cdf(lower, n, p) >= 0.025 - IDENTITY  # one rank further in would miss too often
    assert stats.binom.sf(upper - 2, n, p) > 0.025 - IDENTITY


def test_quantile_ranks_of_few_values_are_open():
    assert quantile_ranks(1, 0.5) == (0, 2)
    assert quantile_ranks(20, 0.95) == (17, 21)
