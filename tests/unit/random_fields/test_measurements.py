"""Measured values in standard-normal space."""

import numpy as np
import pytest

from rfmpm.random_fields.marginals import MARGINALS, Lognormal
from rfmpm.random_fields.measurements import (
    conditional_moments,
    distinct,
    standard_normal_data,
    to_standard_normal,
)

BY_TWO_MOMENTS = [name for name in ("lognormal", "normal_truncated", "gamma", "weibull") if name in MARGINALS]
PLACES = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]])


@pytest.mark.parametrize("name", BY_TWO_MOMENTS)
@pytest.mark.parametrize("spread", [0.01, 0.3, 0.95])
def test_the_inverse_gives_the_value_back(name, spread):
    marginal = MARGINALS[name].from_moments(20e3, spread)
    z = np.linspace(-6.0, 6.0, 49)
    np.testing.assert_allclose(to_standard_normal(marginal, marginal.transform(z)), z, rtol=0, atol=1e-9)


def test_the_inverse_of_a_lognormal_with_a_spread_of_two():
    marginal = Lognormal.from_moments(20e3, 2.0)
    s = np.sqrt(np.log(5.0))
    values = np.array([1.0, 1e3, 2e5])
    expected = (np.log(values) - np.log(20e3) + 0.5 * s * s) / s
    np.testing.assert_allclose(to_standard_normal(marginal, values), expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("value", [0.0, -5.0, 1e9, np.inf])
def test_a_value_out_of_range_is_refused_by_its_label_in_the_unit_of_the_study(value, measured):
    data = measured(PLACES, [20e3, value, 20e3])
    with pytest.raises(ValueError, match=r"data\.1 lies outside what .* 2\.7\d+ kPa to 139\.\d kPa there"):
        standard_normal_data(Lognormal.from_moments(20e3, 0.25), data)


def test_a_lognormal_error_of_a_lognormal_value_is_a_normal_error(measured):
    marginal = Lognormal.from_moments(20e3, 0.25)
    found = standard_normal_data(marginal, measured(PLACES[:1], [30e3], 0.1))
    assert found.error_variances == pytest.approx(np.log(1.01) / np.log(1.0625), rel=1e-7)  # slope by differences


def test_exact_values_that_say_the_same_at_one_place_count_once_and_others_contradict(measured):
    same = measured(PLACES, [18e3, 21e3, 21e3])
    assert len(distinct(same).values) == 2
    other = same._replace(values=np.array([18e3, 21e3, 22e3]))
    with pytest.raises(ValueError, match=r"data\.1 and data\.2 contradict"):
        distinct(other)
    assert len(distinct(other._replace(errors=np.array([0.0, 0.0, 0.1]))).values) == 3


@pytest.mark.parametrize(("mean", "deviation"), [(0.0, 1.0), (1.5, 0.4), (-2.0, 0.0)])
def test_conditional_moments_of_a_lognormal(mean, deviation):
    marginal = Lognormal.from_moments(20e3, 0.5)
    s = marginal.log_standard_deviation
    found = conditional_moments(marginal, np.array([mean]), np.array([deviation]))
    expected = np.exp(marginal.log_mean + s * mean + 0.5 * (s * deviation) ** 2)
    assert found[0] == pytest.approx(expected, rel=1e-12)
    assert found[1] == pytest.approx(expected * np.sqrt(np.expm1((s * deviation) ** 2)), rel=1e-10, abs=1e-9)
