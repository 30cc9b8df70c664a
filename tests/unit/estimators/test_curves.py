"""The exceedance curve and the running estimates agree with the plain ones, and the DKW band holds the whole curve."""

import numpy as np
import pytest

from rfmpm.estimators import exceedance, exceedance_curve, mean, running_exceedance, running_mean

VALUES = np.array([3.0, np.nan, 7.5, 7.5, 0.0, 12.0, 1e3, np.nan, 2.0])
CENSORED = np.array([0, 0, 0, 0, 0, 1, 0, 0, 0], bool)


def test_curve_equals_the_estimate_at_each_limit():
    curve = exceedance_curve(VALUES, censored=CENSORED)
    np.testing.assert_array_equal(curve.at, [0.0, 2.0, 3.0, 7.5, 12.0, 1e3])
    for i, limit in enumerate(curve.at):
        one = exceedance(VALUES, limit, CENSORED)
        assert (curve.value[i], curve.lower[i], curve.upper[i]) == (one.value, one.lower, one.upper)
    assert np.all(curve.simultaneous_lower <= curve.value)
    assert np.all(curve.simultaneous_upper >= curve.value)


def test_curve_at_given_limits_and_of_nothing():
    assert exceedance_curve([1.0, 2.0], limits=[0.0, 1.5, 9.0]).value.tolist() == [1.0, 0.5, 0.0]
    assert exceedance_curve([np.nan, np.nan]).at.size == 0
    nothing = exceedance_curve([np.nan, np.nan], limits=[0.0])
    assert np.isnan(nothing.value[0])
    assert (nothing.lower[0], nothing.upper[0]) == (0.0, 1.0)
    assert (nothing.simultaneous_lower[0], nothing.simultaneous_upper[0]) == (0.0, 1.0)


def test_simultaneous_band_covers_the_whole_curve_and_the_pointwise_one_does_not():
    repeats, n = 2000, 50
    limits = np.linspace(0.0, 1.0, 401)[1:-1]
    simultaneous, pointwise = [], []
    for sample in np.random.default_rng(7).random((repeats, n)):
        curve = exceedance_curve(sample, limits=limits)
        truth = 1.0 - limits
        inside = (curve.simultaneous_lower <= truth) & (truth <= curve.simultaneous_upper)
        simultaneous.append(inside.all())
        pointwise.append(((curve.lower <= truth) & (truth <= curve.upper)).all())
    tolerance = 4.0 * np.sqrt(0.95 * 0.05 / repeats)  # 4 binomial standard errors: 0.019
    assert np.mean(simultaneous) >= 0.95 - tolerance
    assert np.mean(pointwise) < 0.9  # why there are two bands


@pytest.mark.parametrize("values", [VALUES, VALUES[:1], VALUES[1:2], np.zeros(4)])
def test_running_estimates_equal_the_plain_ones_on_every_prefix(values):
    means, shares = running_mean(values), running_exceedance(values, 5.0)
    for k in range(1, values.size + 1):
        plain, share = mean(values[:k]), exceedance(values[:k], 5.0)
        # sums in another order: a few roundings of the largest deviation (1e3), 1e-9 relative to the spread
        np.testing.assert_allclose(
            [means.value[k - 1], means.lower[k - 1], means.upper[k - 1]],
            [plain.value, plain.lower, plain.upper],
            rtol=1e-9,
            atol=1e-9,
        )
        assert shares.lower[k - 1] == share.lower
        assert shares.upper[k - 1] == share.upper
        np.testing.assert_equal(shares.value[k - 1], share.value)
    np.testing.assert_array_equal(means.at, np.arange(1, values.size + 1))


def test_running_probability_counts_censored_as_exceeding():
    band = running_exceedance([1.0, 1.0], 5.0, censored=[True, False])
    np.testing.assert_array_equal(band.value, [1.0, 0.5])


def test_running_bands_at_some_numbers_of_realisations_are_those_of_all():
    at = np.array([1, 4, 9])
    whole = (running_mean(VALUES), running_exceedance(VALUES, 5.0, CENSORED))
    some = (running_mean(VALUES, at=at), running_exceedance(VALUES, 5.0, CENSORED, at=at))
    for every, few in zip(whole, some, strict=True):
        np.testing.assert_array_equal(few.at, at)
        for name in ("value", "lower", "upper"):
            np.testing.assert_array_equal(getattr(few, name), getattr(every, name)[at - 1])
