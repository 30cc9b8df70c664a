"""Sobol indices against closed forms, against SciPy, and their intervals against repeats."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.special import ndtr

from rfmpm.estimators.rows import Rows
from rfmpm.estimators.sensitivity import Design, arrange, given_data_indices, sobol_indices
from rfmpm.sampling.saltelli import Saltelli

A, B = 7.0, 0.1  # of the function of Ishigami and Homma (1990)
VARIANCE = A**2 / 8.0 + B * pi**4 / 5.0 + B**2 * pi**8 / 18.0 + 0.5
ALONE = (0.5 * (1.0 + B * pi**4 / 5.0) ** 2 / VARIANCE, A**2 / 8.0 / VARIANCE, 0.0)
TOGETHER = B**2 * pi**8 * 8.0 / 225.0 / VARIANCE  # of the first and the third


def ishigami(xi):
    x = pi * (2.0 * ndtr(xi[:3]) - 1.0)
    return np.sin(x[0]) + A * np.sin(x[1]) ** 2 + B * x[2] ** 4 * np.sin(x[0])


def rows_of(value, index=None, is_censored=None):
    count = len(value)
    index = np.arange(count) if index is None else index
    censored = np.zeros(count, bool) if is_censored is None else is_censored
    return Rows(np.zeros(count, int), index, np.asarray(value, float), censored, np.ones(count))


def of_ishigami(n_uncertain, count=1024):
    sampler = Saltelli(3, n_uncertain, 3)
    value = [ishigami(sampler.xi(index)) for index in range(count * sampler.blocks)]
    return sobol_indices(arrange(rows_of(value), sampler.groups))


@pytest.mark.parametrize(
    ("n_uncertain", "first", "total"),
    [
        (3, ALONE, (ALONE[0] + TOGETHER, ALONE[1], TOGETHER)),
        (1, (ALONE[0], ALONE[1]), (ALONE[0] + TOGETHER, ALONE[1] + TOGETHER)),  # the second and the third as one group
    ],
)
def test_indices_of_a_function_with_known_ones(n_uncertain, first, total):
    found = of_ishigami(n_uncertain)
    assert found.base_points == 1024
    for value, interval, expected in (
        (found.first, found.first_interval, first),
        (found.total, found.total_interval, total),
    ):
        error = np.diff(interval, axis=1)[:, 0] / (2.0 * 1.96)
        assert np.all(np.abs(value - expected) < 4.0 * error + 1e-9)  # four standard errors
        assert np.all(error < 0.06)


def test_formulas_are_those_of_scipy():
    from scipy.stats import sobol_indices as of_scipy

    values = np.random.default_rng(2).standard_normal((64, 5)) + np.array([0.0, 3.0, 1.0, 0.0, 1.0])
    given = {"f_A": values[None, :, 0], "f_B": values[None, :, 1], "f_AB": values.T[2:, None, :]}
    expected = of_scipy(func=given, n=64)
    found = sobol_indices(Design(values, 0, 0))
    np.testing.assert_allclose(found.first, np.ravel(expected.first_order), rtol=1e-12)
    np.testing.assert_allclose(found.total, np.ravel(expected.total_order), rtol=1e-12)


@pytest.mark.slow
def test_intervals_cover():
    weights, repeats, count = np.array([2.0, 1.0, 2.0]), 250, 150
    rng, hits = np.random.default_rng(9), np.zeros((2, 3))
    truth = weights**2 / np.sum(weights**2)
    for _ in range(repeats):
        a, b = rng.standard_normal((2, count, 3)) * weights
        exchanged = a.sum(axis=1)[:, None] - a + b
        found = sobol_indices(Design(np.column_stack([a.sum(axis=1), b.sum(axis=1), exchanged]), 0, 0))
        for line, interval in enumerate((found.first_interval, found.total_interval)):
            hits[line] += (interval[:, 0] <= truth) & (truth <= interval[:, 1])
    # 0.95 less what percentiles lack with 150 base points, 0.02, within four standard errors of the share.
    assert np.all(hits / repeats > 0.93 - 4.0 * sqrt(0.95 * 0.05 / repeats))


def test_base_points_with_failed_or_missing_simulations_are_left_out_and_counted():
    value = np.arange(20.0)
    value[6] = np.nan
    kept = np.delete(np.arange(20), 13)
    found = arrange(rows_of(value[kept], kept), groups=3)
    np.testing.assert_array_equal(found.values, [[0, 1, 2, 3, 4], [15, 16, 17, 18, 19]])
    assert (found.dropped, found.unfinished) == (1, 1)
    assert sobol_indices(found).dropped == 1


def test_other_levels_are_no_part_of_a_design():
    both = Rows(np.repeat([0, 1], 3), np.tile(np.arange(3), 2), np.arange(6.0), np.zeros(6, bool), np.ones(6))
    np.testing.assert_array_equal(arrange(both, 1).values, [[0.0, 1.0, 2.0]])


@pytest.mark.parametrize("values", [np.ones((50, 4)), np.empty((0, 4)), np.full((50, 4), 0.1)])
def test_nothing_varies_or_nothing_is_there(values):
    found = sobol_indices(Design(values, 0, 0))
    assert np.isnan(found.first).all()
    assert found.total_interval.shape == (2, 2)
    assert np.isnan(found.total_interval).all()


def test_few_base_points_have_no_interval():
    found = sobol_indices(Design(np.random.default_rng(1).standard_normal((5, 4)), 0, 0))
    assert np.isfinite(found.first).all()
    assert np.isnan(found.first_interval).all()


def linear(rng, count=400):
    x = rng.standard_normal((count, 3))
    return x, rows_of(2.0 * x[:, 0] + x[:, 1] + 2.0 * rng.standard_normal(count))


@pytest.mark.slow
def test_indices_from_given_data():
    rng, repeats = np.random.default_rng(4), 150
    found = [given_data_indices(*linear(rng)) for _ in range(repeats)]
    first, truth = np.array([one.first for one in found]), np.array([4.0, 1.0, 0.0]) / 9.0
    error = first.std(axis=0, ddof=1) / sqrt(repeats)
    # Twenty classes of a normal number keep 0.98 or more of the variance between them.
    assert np.all(first.mean(axis=0) > 0.98 * truth - 4.0 * error)
    assert np.all(first.mean(axis=0) < truth + 4.0 * error)
    hits = np.mean([(o.interval[:, 0] <= truth) & (truth <= o.interval[:, 1]) for o in found], axis=0)
    alarms = np.mean([o.first[2] > o.noise[2] for o in found])
    share = 4.0 * sqrt(0.05 * 0.95 / repeats)
    assert np.all(hits[:2] > 0.94 - share)  # less the bias of the classes
    assert abs(alarms - 0.05) < share


def test_given_data_leave_failed_rows_out():
    x, rows = linear(np.random.default_rng(8))
    value = rows.value.copy()
    value[::10] = np.nan
    some = given_data_indices(x, rows_of(value))
    assert (some.rows, some.dropped) == (360, 40)
    kept = ~np.isnan(value)
    alone = given_data_indices(x[kept], rows_of(value[kept]))
    np.testing.assert_array_equal(some.first, alone.first)
    np.testing.assert_array_equal(some.noise, alone.noise)
    assert np.isnan(given_data_indices(x, rows_of(np.ones(400))).first).all()
    with pytest.raises(ValueError, match="400 lines of uncertain numbers for 3 rows"):
        given_data_indices(x, rows_of([1.0, 2.0, 3.0]))
