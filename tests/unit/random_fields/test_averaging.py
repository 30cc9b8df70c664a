"""Averages over boxes: variance and covariance against closed forms and adaptive quadrature."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.special import erf

from rfmpm.random_fields.averaging import VolumeAveraged
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.correlation.matern import Matern

LAGS = [(0.0, 0.0), (0.25, 0.0), (0.0, 0.25), (0.1, -0.05), (-0.25, 0.5), (1.0, 0.0), (0.0, 1.0), (3.0, 2.0)]


def twice_integrated(name: str, theta: float, length):
    """Integral of (length - u) rho(u) du from 0 to `length`, half the squared length times the variance function."""
    t = np.abs(length)
    if name == "markov_separable":
        return 0.5 * theta * t - 0.25 * theta**2 * -np.expm1(-2.0 * t / theta)
    root = np.sqrt(np.pi) / theta
    return 0.5 * theta * t * erf(root * t) + np.expm1(-((root * t) ** 2)) / (2.0 * root**2)


@pytest.mark.parametrize("name", ["markov_separable", "gaussian"])
@pytest.mark.parametrize("scales", [(3.0, 0.5), (0.1, 0.05), (1000.0, 1.0)])
@pytest.mark.parametrize("box", [(0.25, 0.25), (0.5, 0.1)])
def test_covariance_of_averages_in_closed_form(name, scales, box):
    averaged = VolumeAveraged(CORRELATIONS[name](*scales), *box)
    x, y = np.array(LAGS).T
    expected = 1.0
    for lag, theta, side in zip((x, y), scales, box, strict=True):
        # Vanmarcke (1983), section 5.2: the covariance from the variance function of three lengths.
        ends = [twice_integrated(name, theta, lag + k * side) for k in (-1.0, 0.0, 1.0)]
        expected = expected * (ends[0] - 2.0 * ends[1] + ends[2]) / side**2
    # The stated accuracy; the closed form itself loses the square of a long scale over the side, 1e-16 (4e3)^2.
    np.testing.assert_allclose(averaged.covariance(x, y), expected, rtol=0, atol=1e-7 if scales[1] < 0.1 else 3e-9)


def by_adaptive_quadrature(correlation, box, lag):
    """The same integral in four parts, cut at lag zero, where the cusp is."""
    total = 0.0
    for x0, x1 in cuts(lag[0], box[0]):
        for y0, y1 in cuts(lag[1], box[1]):
            value, _ = dblquad(
                lambda y, x: correlation.rho(x, y) * (1 - abs(x - lag[0]) / box[0]) * (1 - abs(y - lag[1]) / box[1]),
                x0, x1, y0, y1, epsabs=1e-10, epsrel=1e-10,
            )  # fmt: skip
            total += value
    return total / (box[0] * box[1])


def cuts(lag, side):
    ends = np.unique(np.clip([lag - side, lag, lag + side, 0.0], lag - side, lag + side))
    return pairwise(ends)


@pytest.mark.parametrize(
    ("correlation", "tolerance"),
    [
        (CORRELATIONS["markov_ellipsoidal"](3.0, 0.5), 1e-8),  # the stated accuracies
        (CORRELATIONS["markov_ellipsoidal"](3.0, 0.5, 0.4), 2e-4),
        (CORRELATIONS["markov_separable"](3.0, 0.5, 0.4), 2e-4),
        (CORRELATIONS["spherical"](1.0, 0.5), 2e-4),
        (CORRELATIONS["second_order_markov"](3.0, 0.5), 1e-8),
        (Matern(1.0, 0.5, nu=0.3), 1e-8),
    ],
    ids=["ellipsoidal", "ellipsoidal turned", "separable turned", "spherical", "second order", "matern"],
)
def test_covariance_of_averages_against_adaptive_quadrature(correlation, tolerance):
    box = (0.25, 0.125)
    averaged = VolumeAveraged(correlation, *box)
    for lag in [(0.0, 0.0), (0.25, 0.0), (0.1, -0.05)]:
        expected = by_adaptive_quadrature(correlation, box, lag)
        assert averaged.covariance(*lag) == pytest.approx(expected, abs=tolerance)


@pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
@pytest.mark.parametrize("rotation", [0.0, 0.4])
def test_an_average_of_averages_is_the_average_over_the_larger_box(kernel, rotation):
    point = kernel(3.0, 0.5, rotation)
    small, large = VolumeAveraged(point, 0.125, 0.125), VolumeAveraged(point, 0.25, 0.25)
    x, y = (axis.ravel() for axis in np.meshgrid([0.0625, 0.1875], [0.0625, 0.1875]))
    between = small.covariance(x[:, None] - x, y[:, None] - y)
    # The stated accuracies, of sixteen terms and one.
    assert between.mean() == pytest.approx(large.variance_factor, abs=2e-4 if rotation else 2e-5)


@pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
def test_the_correlation_is_one_at_no_lag_symmetric_and_positive_definite(kernel):
    averaged = VolumeAveraged(kernel(2.0, 0.5), 0.25, 0.25)
    assert 0.0 < averaged.variance_factor < 1.0
    x, y = (0.25 * axis.ravel() for axis in np.meshgrid(np.arange(12), np.arange(8)))
    matrix = averaged.rho(x[:, None] - x, y[:, None] - y)
    assert np.all(np.diag(matrix) == 1.0)
    assert np.array_equal(matrix, matrix.T)
    # Quadrature errors over the lags of 96 points; the spherical's kink is the coarsest.
    assert np.linalg.eigvalsh(matrix)[0] > -1e-8


def test_a_tiny_box_is_a_point_and_a_huge_one_averages_all_out():
    point = CORRELATIONS["markov_ellipsoidal"](3.0, 0.5)
    x, y = np.random.default_rng(1).uniform(-2.0, 2.0, (2, 50))
    tiny = VolumeAveraged(point, 1e-6, 1e-6)
    assert tiny.variance_factor == pytest.approx(1.0, abs=1e-5)  # 2 |lag| / theta over the box
    np.testing.assert_allclose(tiny.rho(x, y), point.rho(x, y), rtol=0, atol=1e-5)
    # gamma -> alpha / area with alpha the integral of rho, here pi / 2 theta_h theta_v (Vanmarcke 1983, section 6.4).
    huge = VolumeAveraged(point, 300.0, 50.0)
    assert huge.variance_factor == pytest.approx(0.5 * np.pi * 1.5 / 15_000.0, rel=0.02)  # the rim, theta over the side


@pytest.mark.parametrize("side", [0.0, -1.0, np.nan, np.inf])
def test_a_box_without_a_size_is_refused(side):
    with pytest.raises(ValueError, match="height"):
        VolumeAveraged(CORRELATIONS["gaussian"](1.0, 1.0), 1.0, side)
