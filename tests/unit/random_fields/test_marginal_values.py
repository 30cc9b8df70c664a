import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import truncnorm

from rfmpm.random_fields.marginals import Lognormal, NormalTruncated


def test_lognormal_median_and_spread():
    marginal = Lognormal.from_moments(20e3, 0.25)
    s = np.sqrt(np.log(1.0625))
    np.testing.assert_allclose(
        marginal.transform(np.array([0.0, 1.0])), 20e3 / np.sqrt(1.0625) * np.array([1.0, np.exp(s)]), rtol=1e-12
    )


@pytest.mark.parametrize("coefficient_of_variation", [0.1, 0.25, 0.5, 0.8, 0.95])
def test_truncated_normal_against_scipy(coefficient_of_variation):
    marginal = NormalTruncated.from_moments(20e3, coefficient_of_variation)
    parent = truncnorm(marginal.bound, np.inf, loc=-marginal.bound * marginal.scale, scale=marginal.scale)
    assert parent.mean() == pytest.approx(20e3, rel=1e-8)
    assert parent.std() == pytest.approx(20e3 * coefficient_of_variation, rel=1e-8)
    z = np.linspace(-3.0, 3.0, 61)
    probability = np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi)
    value = marginal.transform(z)
    # The same probability lies below: the slope of the transform is the ratio of the two densities.
    step = 1e-5
    slope = (marginal.transform(z + step) - marginal.transform(z - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, probability / parent.pdf(value), rtol=1e-7)
    assert parent.cdf(marginal.transform(np.array(0.0))) == pytest.approx(0.5, rel=1e-10)


@pytest.mark.parametrize("coefficient_of_variation", [0.3, 0.5, 0.9])
def test_truncated_normal_lower_tail_keeps_its_digits(coefficient_of_variation):
    """The probability below a value near zero, integrated from zero, is the one below `z`."""
    marginal = NormalTruncated.from_moments(1.0, coefficient_of_variation)
    z = np.linspace(-9.0, -2.0, 2001)
    value = marginal.transform(z) / marginal.scale
    node, weight = np.polynomial.legendre.leggauss(30)
    at = 0.5 * value[:, None] * (1.0 + node) + marginal.bound
    below = 0.5 * value * (np.exp(-0.5 * at**2) @ weight) / np.sqrt(2.0 * np.pi)
    # The closed form, a difference of numbers near one, keeps ten digits where the series takes over.
    np.testing.assert_allclose(below / ndtr(-marginal.bound), ndtr(z), rtol=1e-9)


def test_half_normal_is_the_truncation_at_the_mean():
    marginal = NormalTruncated.from_moments(1.0, np.sqrt(np.pi / 2.0 - 1.0))
    assert marginal.bound == pytest.approx(0.0, abs=1e-10)
    assert marginal.scale == pytest.approx(np.sqrt(np.pi / 2.0), rel=1e-10)


def test_little_spread_needs_no_truncation():
    marginal = NormalTruncated.from_moments(20e3, 0.05)
    z = np.linspace(-6.0, 6.0, 13)
    np.testing.assert_allclose(marginal.transform(z), 20e3 * (1.0 + 0.05 * z), rtol=1e-10)


@pytest.mark.parametrize("coefficient_of_variation", [0.99, 1.0, 1.5])
def test_spread_at_the_exponential_limit_is_refused(coefficient_of_variation):
    with pytest.raises(ValueError, match=r"between 0 and 0\.99"):
        NormalTruncated.from_moments(1.0, coefficient_of_variation)


def test_spread_just_below_the_limit_is_accepted():
    assert NormalTruncated.from_moments(1.0, 0.9899).bound < 12.0
