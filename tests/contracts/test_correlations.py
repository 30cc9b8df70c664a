"""Every correlation: one at no lag, its integral is theta, positive definite, and it turns with its axes."""

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS

every_correlation = pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
THETA_H, THETA_V = 6.0, 0.5


def random_points(n: int) -> np.ndarray:
    return np.random.default_rng(4).uniform([0.0, 0.0], [15.0, 5.0], (n, 2))


def matrix(correlation, points: np.ndarray) -> np.ndarray:
    lag = points[:, None] - points[None, :]
    return correlation.rho(lag[..., 0], lag[..., 1])


@every_correlation
def test_correlation_is_one_without_a_lag_and_keeps_the_shape(kernel):
    rho = kernel(THETA_H, THETA_V, 0.3).rho(np.zeros((2, 3)), np.zeros((2, 3)))
    assert rho.shape == (2, 3)
    assert np.all(rho == 1.0)


@every_correlation
@pytest.mark.parametrize("rotation_deg", [0.0, 30.0, 90.0])
def test_integral_over_all_lags_along_each_axis_is_theta(kernel, rotation_deg):
    rotation = np.radians(rotation_deg)
    correlation = kernel(THETA_H, THETA_V, rotation)
    axes = {THETA_H: (np.cos(rotation), np.sin(rotation)), THETA_V: (-np.sin(rotation), np.cos(rotation))}
    for theta, (along_x, along_y) in axes.items():
        # Twenty theta each way leave exp(-40); trapezoids err by (2 step / theta)^2 / 12 at the kink: 3.4e-7 here.
        lag, step = np.linspace(-20.0 * theta, 20.0 * theta, 40_001, retstep=True)
        integral = step * np.sum(correlation.rho(lag * along_x, lag * along_y))
        assert integral == pytest.approx(theta, rel=5e-7)


@every_correlation
@pytest.mark.parametrize("rotation", [0.0, 0.5])
def test_positive_definite_on_random_points(kernel, rotation):
    points = random_points(200)
    covariance = matrix(kernel(THETA_H, THETA_V, rotation), points)
    # Identity up to the rounding of n eigenvalues.
    assert np.array_equal(covariance, covariance.T)
    assert np.linalg.eigvalsh(covariance)[0] > -1e-10 * len(points)


@every_correlation
@pytest.mark.parametrize("rotation", [0.0, 0.5])
def test_a_separable_correlation_is_the_product_along_its_axes(kernel, rotation):
    correlation = kernel(THETA_H, THETA_V, rotation)
    h, v = random_points(100).T - 2.0
    cosine, sine = np.cos(rotation), np.sin(rotation)
    rho = correlation.rho(cosine * h - sine * v, sine * h + cosine * v)
    along_axes = correlation.rho(cosine * h, sine * h) * correlation.rho(-sine * v, cosine * v)
    # Identity: rounding of lags of 10 theta that are turned and turned back; the correlations are at most one.
    if correlation.separable:
        np.testing.assert_allclose(rho, along_axes, rtol=0, atol=1e-13)
        np.testing.assert_allclose(rho, correlation.rho_h(h) * correlation.rho_v(v), rtol=0, atol=1e-13)
    else:
        assert np.max(np.abs(rho - along_axes)) > 0.01


@every_correlation
@pytest.mark.parametrize(("theta_h", "theta_v"), [(1000.0, 1.0), (0.05, 0.05), (500.0, 500.0)])
def test_positive_definite_at_extreme_scales(kernel, theta_h, theta_v):
    points = random_points(200)
    covariance = matrix(kernel(theta_h, theta_v, 0.3), points)
    assert np.all(np.isfinite(covariance))
    # Identity up to the rounding of n eigenvalues.
    assert np.linalg.eigvalsh(covariance)[0] > -1e-10 * len(points)


@every_correlation
def test_a_quarter_turn_swaps_the_axes(kernel):
    x, y = random_points(100).T
    turned = kernel(THETA_H, THETA_V, np.pi / 2).rho(x, y)
    np.testing.assert_allclose(turned, kernel(THETA_V, THETA_H).rho(x, y), rtol=1e-12, atol=1e-15)


@every_correlation
def test_rotation_is_counter_clockwise(kernel):
    correlation = kernel(THETA_H, THETA_V, np.radians(30.0))
    along = np.array([np.cos(np.radians(30.0)), np.sin(np.radians(30.0))])
    assert correlation.rho(*along) == pytest.approx(kernel(THETA_H, THETA_V).rho(1.0, 0.0), rel=1e-12)
    assert correlation.rho(along[0], -along[1]) < correlation.rho(*along)


@every_correlation
@pytest.mark.parametrize("theta", [0.0, -1.0, np.inf, np.nan])
def test_a_scale_that_is_not_positive_and_finite_is_refused(kernel, theta):
    with pytest.raises(ValueError, match="theta_v"):
        kernel(1.0, theta)
    with pytest.raises(ValueError, match="theta_h"):
        kernel(theta, 1.0)
