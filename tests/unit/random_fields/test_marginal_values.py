import numpy as np
import pytest
from scipy import stats
from scipy.special import ndtr
from scipy.stats import truncnorm

from rfmpm.random_fields.marginals import MARGINALS, Lognormal, NormalTruncated


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


# --- gamma, Weibull, beta


def family(name: str, marginal):
    """The same distribution by scipy."""
    if name == "gamma":
        return stats.gamma(marginal.shape, scale=marginal.scale)
    if name == "weibull":
        return stats.weibull_min(marginal.shape, scale=marginal.scale)
    return stats.beta(marginal.alpha, marginal.beta, loc=marginal.lower, scale=marginal.upper - marginal.lower)


@pytest.mark.parametrize("name", ["gamma", "weibull", "beta"])
@pytest.mark.parametrize("coefficient_of_variation", [0.01, 0.3, 0.9])
def test_quantiles_against_scipy_in_both_tails(name, coefficient_of_variation):
    own = {"lower_over_mean": 0.0, "upper_over_mean": 4.0} if name == "beta" else {}
    marginal = MARGINALS[name].from_moments(20e3, coefficient_of_variation, **own)
    reference = family(name, marginal)
    assert reference.mean() == pytest.approx(20e3, rel=1e-11)
    assert reference.std() == pytest.approx(20e3 * coefficient_of_variation, rel=1e-11)
    z = np.random.default_rng(1).uniform(-8.0, 0.0, 400)
    # The stated accuracy of the table; scipy's own quantiles are good to about 1e-12.
    np.testing.assert_allclose(marginal.transform(z), reference.ppf(ndtr(z)), rtol=1e-10)
    np.testing.assert_allclose(marginal.transform(-z), reference.isf(ndtr(z)), rtol=1e-10)


@pytest.mark.parametrize(("name", "coefficient_of_variation"), [("gamma", 2.0), ("weibull", 2.0)])
def test_large_spread_has_the_asked_moments(name, coefficient_of_variation):
    reference = family(name, MARGINALS[name].from_moments(1.0, coefficient_of_variation))
    assert (reference.mean(), reference.std()) == pytest.approx((1.0, coefficient_of_variation), rel=1e-11)


def test_an_exponential_is_a_gamma_and_a_weibull():
    z = np.linspace(-6.0, 6.0, 50)
    expected = np.where(z < 0.0, -np.log1p(-ndtr(z)), -np.log(ndtr(-z)))
    for name in ("gamma", "weibull"):
        np.testing.assert_allclose(MARGINALS[name].from_moments(1.0, 1.0).transform(z), expected, rtol=1e-10)


# --- bounded


def test_a_beta_in_the_middle_of_its_bounds_is_symmetric():
    marginal = MARGINALS["beta"].from_moments(2.0, 0.3, lower_over_mean=0.5, upper_over_mean=1.5)
    z = np.linspace(0.0, 6.0, 30)
    assert marginal.alpha == marginal.beta
    np.testing.assert_allclose(marginal.transform(z) - 2.0, 2.0 - marginal.transform(-z), rtol=0, atol=1e-11)


def test_the_hyperbolic_tangent_is_that_of_its_source():
    marginal = MARGINALS["bounded_tanh"].from_moments(20.0, 0.1, lower_over_mean=0.5, upper_over_mean=1.5)
    assert marginal.location == pytest.approx(0.0, abs=1e-11)
    z = np.linspace(-3.0, 3.0, 7)
    expected = 10.0 + 0.5 * 20.0 * (1.0 + np.tanh(marginal.spread * z / (2.0 * np.pi)))
    np.testing.assert_allclose(marginal.transform(z), expected, rtol=1e-12)
    # For little spread the slope at the middle decides: the standard deviation is (b - a) s / (4 pi) (F. and G. 2008).
    narrow = MARGINALS["bounded_tanh"].from_moments(20.0, 0.01, lower_over_mean=0.5, upper_over_mean=1.5)
    assert narrow.spread == pytest.approx(0.01 * 4.0 * np.pi, rel=1e-3)  # next term: s^2 / (4 pi^2)


@pytest.mark.parametrize("name", ["beta", "bounded_tanh"])
@pytest.mark.parametrize(
    ("bounds", "coefficient_of_variation", "said"),
    [
        ((0.5, 1.5), 0.5, r"coefficient_of_variation = 0\.5: must be less than 0\.4"),
        ((0.2, 1.1), 1.0, "a higher upper_over_mean"),
        ((1.0, 2.0), 0.1, "lower_over_mean = 1.0: must be at least 0 and less than 1"),
        ((-0.1, 2.0), 0.1, "lower_over_mean = -0.1"),
        ((0.0, 1.0), 0.1, "upper_over_mean = 1.0: must be greater than 1"),
        ((0.0, np.inf), 0.1, "upper_over_mean"),
    ],
)
def test_bounds_that_cannot_be_are_refused_with_what_can(name, bounds, coefficient_of_variation, said):
    with pytest.raises(ValueError, match=said):
        MARGINALS[name].from_moments(
            1.0, coefficient_of_variation, lower_over_mean=bounds[0], upper_over_mean=bounds[1]
        )


# --- empirical


def empirical(sample, coefficient_of_variation):
    return MARGINALS["empirical"].from_moments(np.mean(sample), coefficient_of_variation, sample=sample)


def test_a_large_sample_gives_its_own_distribution_back():
    parent = Lognormal.from_moments(20.0, 0.4)
    sample = parent.transform(stats.norm.ppf((np.arange(2000) + 0.5) / 2000))
    marginal = empirical(sample, 0.4)
    assert marginal.power == pytest.approx(1.0, abs=1e-3)  # the moments of the sample and of its parent
    z = np.linspace(-5.0, 5.0, 101)  # its tails go on beyond the sample's 3.5
    np.testing.assert_allclose(marginal.transform(z), parent.transform(z), rtol=5e-3)  # five times that, in the tails


def test_quantiles_pass_through_the_sample():
    sample = np.random.default_rng(5).weibull(2.0, 40)
    marginal = empirical(sample, 0.5)
    z = stats.norm.ppf((np.arange(40) + 0.5) / 40)
    expected = marginal.factor * (np.sort(sample) / np.median(sample)) ** marginal.power
    np.testing.assert_allclose(marginal.transform(z), expected, rtol=1e-12)


def test_beyond_the_sample_the_logarithm_is_straight():
    marginal = empirical(np.random.default_rng(5).weibull(2.0, 40), 0.5)
    for tail in (np.linspace(2.3, 6.0, 20), np.linspace(-6.0, -2.3, 20)):  # the outermost value stands at 2.24
        second = np.diff(np.log(marginal.transform(tail)), 2)
        assert np.max(np.abs(second)) < 1e-12  # identity


def test_the_order_the_unit_and_ties_of_a_sample_do_not_matter():
    sample = np.round(np.random.default_rng(6).gamma(9.0, 1.0, 50), 0) + 1.0
    z = np.linspace(-5.0, 5.0, 41)
    first = MARGINALS["empirical"].from_moments(1.0, 0.3, sample=sample).transform(z)
    other = MARGINALS["empirical"].from_moments(1.0, 0.3, sample=1e3 * sample[::-1]).transform(z)
    assert np.all(np.diff(first) >= 0.0)
    np.testing.assert_allclose(other, first, rtol=1e-10)


def test_a_sample_of_two_values_makes_no_overflow():
    with np.errstate(over="raise", invalid="raise"):
        marginal = MARGINALS["empirical"].from_moments(20e3, 0.25, sample=(*[1.0] * 8, 100.0, 100.0))
        assert np.all(np.isfinite(marginal.transform(np.linspace(-8.0, 8.0, 9))))


@pytest.mark.parametrize("sample", [np.arange(1.0, 10.0), np.ones(20), np.arange(20.0), np.full(20, np.nan)])
def test_a_sample_too_small_equal_or_not_positive_is_refused(sample):
    with pytest.raises(ValueError, match="sample: must be at least 10 positive values"):
        MARGINALS["empirical"].from_moments(1.0, 0.3, sample=sample)


def test_more_spread_than_a_sample_without_an_upper_tail_can_have_is_refused():
    sample = np.concatenate([np.linspace(1.0, 2.0, 5), np.full(45, 2.0)])
    with pytest.raises(ValueError, match="too much for the shape of this sample, at most"):
        MARGINALS["empirical"].from_moments(1.0, 2.0, sample=sample)
