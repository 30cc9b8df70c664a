"""Every field method: the asked covariance, exactly repeatable, and linear in xi."""

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.methods import METHODS

every_method = pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
every_correlation = pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
N_POINTS = 60


@pytest.fixture
def points() -> np.ndarray:
    return np.random.default_rng(7).uniform([0.0, 0.0], [15.0, 5.0], (N_POINTS, 2))


def asked_covariance(correlation, points: np.ndarray) -> np.ndarray:
    lag = points[:, None] - points[None, :]
    return correlation.rho(lag[..., 0], lag[..., 1])


def draw(count: int, n_variables: int) -> np.ndarray:
    return np.random.default_rng(11).standard_normal((count, n_variables))


@every_correlation
@every_method
def test_mean_and_covariance_within_four_standard_errors(method, kernel, points):
    correlation = kernel(6.0, 1.0, 0.2)
    record = method.prepare(correlation, points)
    count = 4000
    z = np.array([method.transform(record, xi) for xi in draw(count, method.n_variables(record))])
    assert z.shape == (count, N_POINTS)
    # Averages over the points and over pairs of points: one number per realisation, so that the errors are independent.
    asked = asked_covariance(correlation, points)
    near = (asked > 0.3) & (asked < 1.0)
    pairs_a, pairs_b = np.nonzero(np.triu(near, 1))
    for samples, expected in (
        (z.mean(axis=1), 0.0),
        ((z**2).mean(axis=1), 1.0),
        ((z[:, pairs_a] * z[:, pairs_b]).mean(axis=1), asked[pairs_a, pairs_b].mean()),
    ):
        assert abs(samples.mean() - expected) < 4.0 * samples.std(ddof=1) / np.sqrt(count)


@every_correlation
@every_method
def test_the_transform_of_unit_vectors_gives_the_asked_covariance(method, kernel, points):
    correlation = kernel(6.0, 1.0, 0.2)
    record = method.prepare(correlation, points)
    factor = np.array([method.transform(record, unit) for unit in np.eye(method.n_variables(record))]).T
    # Identity up to rounding and the largest nugget a method may add.
    np.testing.assert_allclose(factor @ factor.T, asked_covariance(correlation, points), rtol=0, atol=1.01e-10)


@every_correlation
@every_method
def test_same_xi_same_field_bit_for_bit(method, kernel, points):
    (xi,) = draw(1, method.n_variables(method.prepare(kernel(6.0, 1.0), points)))
    first = method.transform(method.prepare(kernel(6.0, 1.0), points), xi)
    again = method.transform(method.prepare(kernel(6.0, 1.0), points.copy()), xi.copy())
    assert first.tobytes() == again.tobytes()


@every_correlation
@every_method
def test_the_transform_is_linear(method, kernel, points):
    record = method.prepare(kernel(6.0, 1.0), points)
    a, b = draw(2, method.n_variables(record))
    together = method.transform(record, 2.0 * a - 3.0 * b)
    apart = 2.0 * method.transform(record, a) - 3.0 * method.transform(record, b)
    np.testing.assert_allclose(together, apart, rtol=0, atol=1e-12)


@every_method
def test_a_fresh_record_is_intact_and_one_for_other_points_is_not(method, points):
    record = method.prepare(CORRELATIONS["markov_separable"](6.0, 1.0), points)
    assert method.is_intact(record, points)
    assert not method.is_intact(record, points[:-1])


@every_correlation
@every_method
def test_the_covariance_error_is_that_of_the_linear_map(method, kernel, points):
    correlation = kernel(6.0, 1.0)
    record = method.prepare(correlation, points)
    factor = np.array([method.transform(record, unit) for unit in np.eye(method.n_variables(record))]).T
    found = np.abs(factor @ factor.T - asked_covariance(correlation, points)).max()
    assert found <= method.covariance_error(record) + 1e-12  # rounding of n products
