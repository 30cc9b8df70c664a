"""Where a field drives a quantity: correlations in blocks, and levels of noise."""

from math import sqrt

import numpy as np
import pytest

from rfmpm.estimators.influence import influence

POINTS = 60


def fields(rng, rows):
    """Standard-normal fields along a line with a scale of fluctuation of ten points."""
    rho = np.exp(-2.0 * np.abs(np.subtract.outer(np.arange(POINTS), np.arange(POINTS))) / 10.0)
    return rng.standard_normal((rows, POINTS)) @ np.linalg.cholesky(rho).T


@pytest.mark.parametrize("size", [1, 7, 300])
def test_correlations_are_those_of_numpy_in_blocks_of_any_size(size):
    rng = np.random.default_rng(1)
    field = fields(rng, 300) + 3.0
    quantity = field[:, 20] + rng.standard_normal(300)
    blocks = (field[start : start + size] for start in range(0, 300, size))
    found = influence(blocks, quantity)
    expected = [np.corrcoef(column, quantity)[0, 1] for column in field.T]
    np.testing.assert_allclose(found.correlation, expected, atol=1e-12)
    assert found.rows == 300
    assert found.is_significant[20]


def test_noise_levels_hold_where_nothing_depends():
    rng, repeats, rows = np.random.default_rng(2), 150, 80
    alarms, at_a_point = 0, 0
    for _ in range(repeats):
        found = influence([fields(rng, rows)], rng.standard_exponential(rows))
        alarms += bool(found.is_significant.any())
        at_a_point += abs(found.correlation[7]) > found.noise_at_a_point
    # Four standard errors of a share of 0.05; the level itself comes from 200 permutations, good to 0.015.
    assert abs(alarms / repeats - 0.05) < 4.0 * sqrt(0.05 * 0.95 / repeats + 0.015**2)
    assert abs(at_a_point / repeats - 0.05) < 4.0 * sqrt(0.05 * 0.95 / repeats)


def test_a_field_that_does_not_vary_has_no_correlation():
    rng = np.random.default_rng(3)
    field = fields(rng, 50)
    field[:, 5] = 0.25  # measured there
    found = influence([field], rng.standard_normal(50))
    assert found.correlation[5] == 0.0
    assert np.isfinite(found.noise_anywhere)


@pytest.mark.parametrize("quantity", [np.ones(50), np.arange(9.0), np.full(50, np.nan)])
def test_a_quantity_without_variation_or_values_is_refused(quantity):
    with pytest.raises(ValueError, match="at least 10 finite values"):
        influence([np.zeros((len(quantity), 3))], quantity)


@pytest.mark.parametrize(("rows", "text"), [(40, "40 fields for 50 values"), (60, "more fields than the 50 values")])
def test_as_many_fields_as_values(rows, text):
    rng = np.random.default_rng(4)
    with pytest.raises(ValueError, match=text):
        influence([fields(rng, rows)], rng.standard_normal(50))
