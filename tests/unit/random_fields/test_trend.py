"""Trends with depth: exact moments at every depth, for every marginal."""

from functools import partial

import numpy as np
import pytest

from rfmpm.random_fields.marginals import MARGINALS
from rfmpm.random_fields.trend import Trend

every_marginal = pytest.mark.parametrize("name", MARGINALS)
DEPTHS = np.array([0.0, 4.0, 1.25, 4.0, 2.5])
POINTS = np.column_stack([np.arange(5.0), 5.0 - DEPTHS])
MEAN, VARIATION = 20e3, 0.3
SAMPLE = tuple(np.random.default_rng(3).gamma(4.0, 5.0, 60))
OWN = {"lower_over_mean": 0.1, "upper_over_mean": 5.0, "sample": SAMPLE}  # what some distributions need beside moments


def factory_of(name):
    return partial(MARGINALS[name].from_moments, **{key: OWN[key] for key in MARGINALS[name].needs})


def moments(marginal):
    """Mean and standard deviation of each point's distribution, by the trapezoidal rule, which is exact to rounding
    for a density that is smooth and has vanished at both ends."""
    z = np.linspace(-12.0, 12.0, 4801)
    weight = np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi) * (z[1] - z[0])
    values = marginal.transform(np.repeat(z[:, None], len(DEPTHS), axis=1))
    mean = weight @ values
    return mean, np.sqrt(weight @ (values - mean) ** 2)


@every_marginal
@pytest.mark.parametrize(("gain", "spread"), [(1.5e3, None), (-3e3, None), (1.5e3, 0.0), (0.0, 500.0), (2e3, -1e3)])
def test_mean_and_standard_deviation_are_those_asked_at_every_depth(name, gain, spread):
    marginal = Trend(5.0, gain, spread).marginal(factory_of(name), MEAN, VARIATION, POINTS)
    mean, deviation = moments(marginal)
    asked = MEAN + gain * DEPTHS
    # Rounding of the sum over 4801 values, and that of a truncated normal's parameters, found by a root; a sample's
    # monotone curve bends at each of its values, which costs the cube of a step, 1e-7.
    rounding = 1e-7 if name == "empirical" else 1e-9
    np.testing.assert_allclose(mean, asked, rtol=rounding)
    expected = VARIATION * asked if spread is None else VARIATION * MEAN + spread * DEPTHS
    np.testing.assert_allclose(deviation, expected, rtol=rounding)


@every_marginal
def test_each_point_has_the_distribution_of_its_own_depth(name):
    factory = factory_of(name)
    z = np.array([-2.0, -0.3, 0.0, 1.1, 2.2])
    found = Trend(5.0, 1e3, 200.0).marginal(factory, MEAN, VARIATION, POINTS).transform(z)
    means = MEAN + 1e3 * DEPTHS
    variations = (VARIATION * MEAN + 200.0 * DEPTHS) / means
    expected = [factory(*each).transform(z[k : k + 1])[0] for k, each in enumerate(zip(means, variations, strict=True))]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("gain", "spread", "sentence"),
    [
        (-5e3, None, "the mean is 0 kPa at a depth of 4 m: must be positive"),
        (-6e3, 0.0, "the mean is -4 kPa at a depth of 4 m"),
        (0.0, -2e3, "the standard deviation is -2 kPa at a depth of 4 m"),
    ],
)
def test_what_is_not_positive_is_refused_with_its_depth(gain, spread, sentence):
    with pytest.raises(ValueError, match=sentence):
        Trend(5.0, gain, spread).marginal(MARGINALS["lognormal"].from_moments, MEAN, VARIATION, POINTS)
