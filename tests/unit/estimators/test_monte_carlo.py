"""Mean, probability and quantile of plain Monte Carlo rows."""

import numpy as np
import pytest

from rfmpm.estimators import contiguous_prefix, exceedance, mean, missing, quantile
from rfmpm.estimators.intervals import clopper_pearson

REPEATS = 3000
TOLERANCE = 4.0 * np.sqrt(0.95 * 0.05 / REPEATS)  # 4 binomial standard errors of a coverage of 0.95: 0.016


def test_mean_interval_covers_and_is_unbiased():
    samples = np.random.default_rng(1).normal(7.0, 2.0, (REPEATS, 5))
    estimates = [mean(sample) for sample in samples]
    values = np.array([e.value for e in estimates])
    assert abs(values.mean() - 7.0) < 4.0 * 2.0 / np.sqrt(5 * REPEATS)  # 4 standard errors
    coverage = np.mean([e.lower <= 7.0 <= e.upper for e in estimates])
    assert abs(coverage - 0.95) < TOLERANCE  # exact for normal values, so neither low nor high


def test_mean_leaves_failed_out_and_says_so():
    estimate = mean([1.0, np.nan, 3.0], censored=[False, True, True])
    assert estimate.value == 2.0
    assert estimate.n == 2
    assert "1 failed of 3 left out" in estimate.note
    assert "1 censored" in estimate.note  # the failed one is not counted twice


@pytest.mark.parametrize(("values", "value"), [([4.0], 4.0), ([4.0, np.nan], 4.0), ([np.nan], np.nan), ([], np.nan)])
def test_mean_of_fewer_than_two_has_no_interval(values, value):
    estimate = mean(values)
    np.testing.assert_equal(estimate.value, value)
    assert (estimate.lower, estimate.upper) == (-np.inf, np.inf)
    assert "no interval" in estimate.note


def test_mean_of_equal_values_warns():
    estimate = mean(np.zeros(8))
    assert (estimate.lower, estimate.value, estimate.upper) == (0.0, 0.0, 0.0)
    assert "all values are equal" in estimate.note


def test_exceedance_is_strict():
    assert exceedance([5.0, 5.0 + 1e-9, 4.0, 6.0], 5.0).value == 0.5


def test_failed_rows_enter_as_bounds():
    estimate = exceedance([6.0] * 4 + [1.0] * 4 + [np.nan] * 2, 5.0)
    assert estimate.value == 0.5
    assert estimate.lower == clopper_pearson(4, 10)[0]
    assert estimate.upper == clopper_pearson(6, 10)[1]
    assert "2 failed of 10" in estimate.note


def test_failed_rows_widen_whatever_they_would_have_been():
    complete = np.random.default_rng(3).normal(5.0, 1.0, 50)
    holed = np.where(np.arange(50) % 7 == 0, np.nan, complete)
    truth, bounds = exceedance(complete, 5.0), exceedance(holed, 5.0)
    assert bounds.lower <= truth.lower
    assert bounds.upper >= truth.upper


def test_censored_members_exceed_every_limit():
    estimate = exceedance([3.0, 1.0], 5.0, censored=[True, False])
    assert estimate.value == 0.5
    assert "1 censored counted as exceeding" in estimate.note


def test_wilson_is_narrower_and_an_unknown_method_lists_the_choices():
    values = np.arange(20.0)
    exact, score = exceedance(values, 9.5), exceedance(values, 9.5, method="wilson")
    assert exact.lower < score.lower < 0.5 < score.upper < exact.upper
    with pytest.raises(ValueError, match="clopper_pearson, wilson"):
        exceedance(values, 9.5, method="wald")


@pytest.mark.parametrize("probability", [0.1, 0.5, 0.95])
def test_quantile_interval_covers(probability):
    samples = np.random.default_rng(5).random((REPEATS, 120))  # uniform: the quantile is the probability
    estimates = [quantile(sample, probability) for sample in samples]
    coverage = np.mean([e.lower <= probability <= e.upper for e in estimates])
    assert coverage >= 0.95 - TOLERANCE
    assert all(e.lower <= e.value <= e.upper for e in estimates)


def test_quantile_with_failed_and_censored_rows():
    values = np.arange(1.0, 41.0)
    plain = quantile(values, 0.5)
    assert (plain.lower, plain.value, plain.upper) == (14.0, 20.0, 27.0)  # ranks 14 and 27 of 40
    holed = values.copy()
    holed[[0, 39]] = np.nan
    bounds = quantile(holed, 0.5)
    assert bounds.lower == 13.0  # both missing ones may be low: 14th of -inf, -inf, 2, 3, ...
    assert bounds.upper == 28.0
    assert quantile(values, 0.5, censored=values > 10.0).upper == np.inf


def test_quantile_of_nothing_and_of_one():
    assert quantile([3.0], 0.5).value == 3.0
    assert quantile([3.0], 0.5).upper == np.inf
    assert np.isnan(quantile([np.nan, np.nan], 0.5).value)
    with pytest.raises(ValueError, match="between 0 and 1"):
        quantile([1.0], 1.0)


@pytest.mark.parametrize(("indices", "length"), [([], 0), ([0, 1, 2], 3), ([3, 1, 0], 2), ([1, 2], 0), ([0, 2, 3], 1)])
def test_contiguous_prefix(indices, length):
    assert contiguous_prefix(indices) == length


def test_mismatched_lengths_are_errors():
    with pytest.raises(ValueError, match="censored has 2 entries, values 3"):
        exceedance([1.0, 2.0, 3.0], 1.0, censored=[True, False])


def test_missing_realisations_are_named_in_order():
    assert missing([], 6) == [range(6)]
    assert missing({4, 0, 11}, 6) == [range(1, 4), range(5, 6)]
    assert missing(range(6), 6) == []
