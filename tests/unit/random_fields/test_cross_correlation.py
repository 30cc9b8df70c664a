"""Mixing of standard-normal fields by the factor of a small matrix."""

from types import SimpleNamespace

import numpy as np
import pytest

from rfmpm.random_fields.cross_correlation import mix, mixing_matrix

NAMES = ["cohesion", "friction_angle", "residual_cohesion"]


def pair(first, second, coefficient):
    return SimpleNamespace(between=(first, second), coefficient=coefficient)


PAIRS = [pair("friction_angle", "cohesion", -0.5), pair("residual_cohesion", "cohesion", 0.8)]


def test_the_matrix_of_the_coefficients_comes_back():
    lower = mixing_matrix(NAMES, PAIRS)
    # identity: three terms per product
    np.testing.assert_allclose(lower @ lower.T, [[1.0, -0.5, 0.8], [-0.5, 1.0, 0.0], [0.8, 0.0, 1.0]], atol=1e-15)


def test_mixed_fields_are_rows_of_the_factor_and_the_first_keeps_its_bits():
    lower = mixing_matrix(NAMES, PAIRS)
    fields = list(np.random.default_rng(1).standard_normal((3, 50)))
    mixed = mix(lower, fields)
    np.testing.assert_array_equal(mixed[0], fields[0])
    np.testing.assert_allclose(mixed, lower @ np.array(fields), rtol=0, atol=1e-14)


def test_fields_without_correlation_keep_their_bits():
    fields = list(np.random.default_rng(1).standard_normal((3, 50)))
    np.testing.assert_array_equal(mix(mixing_matrix(NAMES, []), fields), fields)


def test_coefficients_that_no_random_variables_have_are_refused():
    impossible = [pair(NAMES[0], NAMES[1], 0.9), pair(NAMES[0], NAMES[2], 0.9), pair(NAMES[1], NAMES[2], -0.9)]
    with pytest.raises(ValueError, match="exclude each other: bring the coefficients closer to 0"):
        mixing_matrix(NAMES, impossible)
