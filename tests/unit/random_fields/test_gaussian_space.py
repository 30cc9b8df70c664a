"""Correlations of physical values and of the standard-normal ones below them."""

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.gaussian_space import InGaussianSpace, InPhysicalSpace, MarginalMap, space_map
from rfmpm.random_fields.marginals import MARGINALS

SAMPLE = np.random.default_rng(3).gamma(4.0, 5.0, 60)
OWN = {"lower_over_mean": 0.2, "upper_over_mean": 5.0, "sample": SAMPLE}
every_marginal = pytest.mark.parametrize("name", MARGINALS)
every_spread = pytest.mark.parametrize("coefficient_of_variation", [0.01, 0.95])


def make(name, coefficient_of_variation):
    own = {key: OWN[key] for key in MARGINALS[name].needs}
    return MARGINALS[name].from_moments(20e3, coefficient_of_variation, **own)


def by_double_quadrature(marginal, gaussian):
    """Correlation of w(X) and w(Y), Y = r X + sqrt(1 - r^2) Z, by trapezoids in X and Z."""
    z, step = np.linspace(-9.0, 9.0, 1801, retstep=True)
    weight = step * np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi)
    value = marginal.transform(z)
    value_mean = np.sum(weight * value)
    value = value - value_mean
    found = []
    for r in gaussian:
        other = marginal.transform(r * z[:, None] + np.sqrt(1.0 - r * r) * z[None, ::6]) - value_mean
        found.append(np.sum(weight * value * np.sum(6.0 * weight[::6] * other, axis=1)))
    return np.array(found) / np.sum(weight * value**2)


@every_marginal
@every_spread
def test_physical_correlation_against_double_quadrature(name, coefficient_of_variation):
    marginal = make(name, coefficient_of_variation)
    gaussian = np.array([-0.9, -0.3, 0.0, 0.1, 0.5, 0.9, 0.99])
    # The normal beyond 9, 1e-18, leaves 1e-12 of the variance of the broadest; kinks of a sample's curve cost both.
    tolerance = 3e-5 if name == "empirical" else 1e-11
    expected = by_double_quadrature(marginal, gaussian)
    np.testing.assert_allclose(space_map(marginal).to_physical(gaussian), expected, rtol=0, atol=tolerance)


@every_marginal
@every_spread
def test_the_two_directions_are_inverse_and_keep_zero_and_one(name, coefficient_of_variation):
    between = space_map(make(name, coefficient_of_variation))
    gaussian = np.linspace(-1.0, 1.0, 999)
    physical = between.to_physical(gaussian)
    assert np.all(np.diff(physical) > 0.0)
    # Cubic interpolation on a table of 2001 correlations, closest together at one.
    np.testing.assert_allclose(between.to_physical(between.to_gaussian(physical)), physical, rtol=0, atol=1e-9)
    for function in (between.to_physical, between.to_gaussian):
        np.testing.assert_allclose(function(np.array([0.0, 1.0])), [0.0, 1.0], rtol=0, atol=1e-14)


@pytest.mark.parametrize("coefficient_of_variation", [0.01, 0.5, 2.0])
def test_the_closed_form_of_the_lognormal_is_the_sum(coefficient_of_variation):
    marginal = make("lognormal", coefficient_of_variation)
    gaussian = np.linspace(-1.0, 1.0, 101)
    closed, general = space_map(marginal), MarginalMap(marginal)
    # Truncation of the sum at 1e-14 of the variance; interpolation.
    np.testing.assert_allclose(closed.to_physical(gaussian), general.to_physical(gaussian), rtol=0, atol=1e-12)
    # Fenton and Griffiths (2008), the correlation of the logarithm: ln(1 + rho V^2) / ln(1 + V^2).
    v = coefficient_of_variation**2
    np.testing.assert_allclose(closed.to_gaussian(0.3), np.log(1.0 + 0.3 * v) / np.log(1.0 + v), rtol=1e-12)


@pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
@every_marginal
def test_a_correlation_in_physical_space_comes_out_there(kernel, name):
    between, asked = space_map(make(name, 0.95)), kernel(6.0, 0.5, 0.3)
    x, y = np.random.default_rng(1).uniform(-3.0, 3.0, (2, 300))
    below = InGaussianSpace(asked, between)
    assert (below.theta_h, below.theta_v, below.rotation, below.separable) == (6.0, 0.5, 0.3, False)
    np.testing.assert_allclose(InPhysicalSpace(below, between).rho(x, y), asked.rho(x, y), rtol=0, atol=1e-9)
    assert below.rho(np.zeros(2), np.zeros(2)).tolist() == [1.0, 1.0]


@every_marginal
def test_a_share_of_the_variance_comes_out_in_physical_space(name):
    between, asked = space_map(make(name, 0.5)), CORRELATIONS["gaussian"](6.0, 0.5)
    below = InGaussianSpace(asked, between, share=0.7)
    x, y = np.random.default_rng(1).uniform(-3.0, 3.0, (2, 300))
    physical = between.to_physical(below.gaussian_share * below.rho(x, y))
    np.testing.assert_allclose(physical, 0.7 * asked.rho(x, y), rtol=0, atol=1e-9)


def test_a_negative_correlation_that_cannot_be_had_is_refused():
    between = space_map(make("lognormal", 0.95))  # at least -1 / (1 + V^2) = -0.53
    asked = CORRELATIONS["cosine_exponential"](2.0, 2.0)
    assert InGaussianSpace(asked, between).rho(4.7, 0.0) < asked.rho(4.7, 0.0)

    class Swing(CORRELATIONS["cosine_exponential"]):
        def profile(self, lag):
            return np.cos(lag)

    with pytest.raises(
        ValueError, match=r"-1 in physical space cannot be had: the lowest of two such variables is -0\.52"
    ):
        InGaussianSpace(Swing(1.0, 1.0), between).rho(np.pi, 0.0)
