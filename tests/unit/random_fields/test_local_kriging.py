"""Kriging from a lattice to scattered points: its covariance, the error it states, and what it leaves to others."""

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.methods import choose
from rfmpm.random_fields.methods.local_kriging import LocalKriging

DEFAULT = 5e-4  # what the method asks of itself
SCREENED = [name for name in CORRELATIONS if name not in ("markov_separable", "cosine_exponential")]


def scattered(count: int) -> np.ndarray:
    return np.random.default_rng(5).uniform([0.0, 0.0], [12.0, 5.0], (count, 2))


def covariance_of(record) -> np.ndarray:
    count = LocalKriging.n_variables(record)
    factor = np.array([LocalKriging.transform(record, unit) for unit in np.eye(count)])
    return factor.T @ factor


def asked(correlation, points: np.ndarray) -> np.ndarray:
    lag = points[:, None] - points
    return correlation.rho(lag[..., 0], lag[..., 1])


@pytest.mark.parametrize("rotation", [0.0, 0.4])
def test_the_stated_error_is_that_of_the_linear_map(rotation):
    correlation, points = CORRELATIONS["markov_ellipsoidal"](6.0, 2.0, rotation), scattered(90)
    record = LocalKriging.prepare(correlation, points)
    error = np.max(np.abs(covariance_of(record) - asked(correlation, points)))
    assert error == pytest.approx(float(record.error), abs=1e-9)  # all 90 points are among the 100 compared


@pytest.mark.parametrize("kernel", SCREENED)
def test_a_correlation_that_is_screened_is_as_accurate_as_asked(kernel):
    record = LocalKriging.prepare(CORRELATIONS[kernel](6.0, 1.0), scattered(3000))
    assert record.error <= DEFAULT


@pytest.mark.parametrize("kernel", ["markov_separable", "cosine_exponential"])
def test_a_cusp_along_the_axes_is_not_screened_and_the_error_says_so(kernel):
    """Points in one column of the lattice stay correlated beyond the nodes between them, at any distance."""
    record = LocalKriging.prepare(CORRELATIONS[kernel](6.0, 1.0), scattered(3000))
    assert DEFAULT < record.error < 0.02


def test_the_error_is_found_between_points_that_are_not_compared_too():
    correlation, points = CORRELATIONS["markov_ellipsoidal"](6.0, 1.0), scattered(700)
    record = LocalKriging.prepare(correlation, points)
    error = np.max(np.abs(covariance_of(record) - asked(correlation, points)))
    # Largest of 700 rows against largest of 100: within a factor of two as long as errors have no rare large ones.
    assert error < 2.0 * record.error


def test_many_scattered_points_take_it():
    assert choose(CORRELATIONS["gaussian"](6.0, 1.0), scattered(5001)) == "local_kriging"


def test_points_on_a_line_and_points_at_one_place():
    correlation, line = CORRELATIONS["markov_ellipsoidal"](6.0, 1.0), scattered(60) * [0.0, 1.0]
    record = LocalKriging.prepare(correlation, np.concatenate([line, line[:5]]))
    assert record.error <= DEFAULT
    field = LocalKriging.transform(record, np.random.default_rng(1).standard_normal(LocalKriging.n_variables(record)))
    # A nugget of 1e-11 on either of two equal points, and its square root is what they may differ by, in deviations.
    np.testing.assert_allclose(field[60:], field[:5], rtol=0, atol=5e-5)
