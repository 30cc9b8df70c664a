"""Sums of independent units: errors, degrees of freedom, intervals of probabilities, bands and inversion."""

import numpy as np
import pytest
from scipy.stats import norm

from rfmpm.estimators.bands import simultaneous_factor
from rfmpm.estimators.contributions import Contributions, Counts
from rfmpm.estimators.intervals import student_t, wilson
from rfmpm.estimators.inversion import invert
from rfmpm.estimators.linear import falling, pooled
from rfmpm.estimators.protocol import Expectation


def test_one_stratum_is_student_s_interval():
    value = np.random.default_rng(0).normal(3.0, 2.0, 20)
    found = Contributions(value[:, None] / 20, np.zeros(20, int), np.zeros(1)).expectation(0.95, False)
    lower, upper = student_t(value.mean(), value.std(ddof=1), 20)
    assert (found.value[0], found.lower[0], found.upper[0]) == pytest.approx((value.mean(), lower, upper), rel=1e-12)


def test_strata_add_their_variances_and_share_degrees_of_freedom():
    generator = np.random.default_rng(1)
    unit = np.concatenate([generator.normal(0.0, 0.1, 10), generator.normal(0.0, 0.2, 30)])[:, None]
    stratum = np.repeat([0, 1], [10, 30])
    found = Contributions(unit, stratum, np.zeros(1))
    parts = [10 * unit[:10].var(ddof=1), 30 * unit[10:].var(ddof=1)]
    assert found.standard_error()[0] ** 2 == pytest.approx(sum(parts), rel=1e-12)
    welch = sum(parts) ** 2 / (parts[0] ** 2 / 9 + parts[1] ** 2 / 29)
    assert found.degrees_of_freedom()[0] == pytest.approx(welch, rel=1e-12)


@pytest.mark.parametrize("count", [0, 1, 4, 36, 40])
def test_probability_of_independent_units_is_about_wilson_s(count):
    n = 40
    unit = (np.arange(n) < count).astype(float)[:, None] / n
    counts = Counts(np.ones(1), np.array([count]), None, n)
    found = Contributions(unit, np.zeros(n, int), np.zeros(1), (counts,)).expectation(0.95, True)
    # Student's t with 39 degrees of freedom is 3 % wider than the normal that Wilson uses
    assert (found.lower[0], found.upper[0]) == pytest.approx([float(edge) for edge in wilson(count, n)], abs=0.012)
    assert 0.0 <= found.lower[0] <= found.upper[0] <= 1.0


def test_nothing_and_one_unit():
    nothing = Contributions(np.zeros((0, 2)), np.zeros(0, int), np.zeros(2))
    assert nothing.expectation(0.95, True).upper.tolist() == [1.0, 1.0]
    assert nothing.expectation(0.95, False).lower.tolist() == [-np.inf, -np.inf]
    one = Contributions(np.ones((1, 1)), np.zeros(1, int), np.zeros(1))
    assert one.expectation(0.95, False).upper[0] == np.inf


def test_simultaneous_band_of_independent_columns_is_the_largest_of_as_many_normals():
    unit = np.random.default_rng(2).standard_normal((4000, 10))
    factor = simultaneous_factor(Contributions(unit, np.zeros(4000, int), np.zeros(10)), 0.95)
    exact = norm.ppf(0.5 + 0.5 * 0.95**0.1) / norm.ppf(0.975)
    assert factor == pytest.approx(exact, rel=0.05)  # 1000 draws give the 95 % quantile of the largest to 0.08 of 2.8
    assert simultaneous_factor(Contributions(np.ones((5, 2)), np.zeros(5, int), np.zeros(2)), 0.95) == 1.0


def test_edges_fall_and_the_curve_is_pooled():
    edge = np.array([0.9, 0.95, 0.5, 0.6, 0.1])
    assert falling(edge, is_upper=True).tolist() == [0.9, 0.9, 0.5, 0.5, 0.1]
    assert falling(edge, is_upper=False).tolist() == [0.95, 0.95, 0.6, 0.6, 0.1]
    assert pooled(edge).tolist() == pytest.approx([0.925, 0.925, 0.55, 0.55, 0.1], rel=1e-12)


def test_inversion_finds_the_first_value_at_the_tail():
    values = np.arange(1000.0)

    def curve(limits):
        share = 1.0 - (limits + 1.0) / 1000.0
        return Expectation(share, share, share - 0.05, share + 0.05)

    assert invert(curve, values, 0.2 + 1e-9) == (799.0, 749.0, 849.0)
    assert invert(curve, values, 0.01 + 1e-9) == (989.0, 939.0, np.inf)
    assert invert(curve, values, 0.99 + 1e-9)[1] == -np.inf
    assert np.isnan(invert(curve, values[:0], 0.5)[0])
