"""Regression, stand-ins for indicators, nested levels and how they share the work."""

import numpy as np
import pytest
from scipy.stats import norm

from rfmpm.estimators import surrogate
from rfmpm.estimators.allocation import allocate, choose_levels
from rfmpm.estimators.levels import FOLDS, Nested, contributions
from rfmpm.estimators.regression import fit


def test_unpenalised_regression_is_least_squares():
    generator = np.random.default_rng(0)
    x, features = generator.standard_normal((2000, 1)), generator.standard_normal((2000, 3))
    y = 2.0 * x + features @ np.array([[1.0], [0.0], [-1.0]]) + 0.1 * generator.standard_normal((2000, 1))
    found = fit(y, x, features)
    # 4 standard errors of 0.1 / sqrt(2000), and a shrinkage of at most 0.001 by the least penalty
    assert found.slope[0] == pytest.approx(2.0, abs=0.01)
    np.testing.assert_allclose(found.weights[:, 0], [1.0, 0.0, -1.0], atol=0.011)


def test_pure_noise_is_shrunk_and_a_constant_regressor_has_no_slope():
    generator = np.random.default_rng(1)
    features = generator.standard_normal((40, 30))
    found = fit(generator.standard_normal((40, 1)), np.ones((40, 1)), features)
    assert found.slope[0] == 0.0
    assert np.linalg.norm(found.weights) < 0.3  # least squares gives about sqrt(30 / 10)


def test_slopes_can_be_bounded():
    x = np.arange(10.0)[:, None]
    assert fit(5.0 * x, x, None, most=1.5).slope[0] == 1.5
    assert fit(-5.0 * x, x, None, most=1.5).slope[0] == 0.0


def test_expectation_of_a_step_of_a_normal():
    generator = np.random.default_rng(2)
    limits, width = np.array([-1.0, 0.5]), np.array([0.3, 2.0])
    steps = surrogate.steps(1.0 + 2.0 * generator.standard_normal(200_000), limits, width)
    error = steps.std(axis=0) / np.sqrt(200_000)
    assert np.all(np.abs(steps.mean(axis=0) - surrogate.steps_mean(1.0, 2.0, limits, width)) < 4.0 * error)


def test_width_of_a_step_follows_the_error_of_the_prediction():
    generator = np.random.default_rng(3)
    prediction = generator.standard_normal(4000)
    exceeds = (prediction + 0.5 * generator.standard_normal(4000) > 0.0)[:, None].astype(float)
    assert surrogate.widths(exceeds, prediction, np.zeros(1), 0.5)[0] == 0.5
    sharp = (prediction > 0.0)[:, None].astype(float)
    assert surrogate.widths(sharp, prediction, np.zeros(1), 0.5)[0] == 0.01


def nested(seed: int, numbers=(64, 512), correlation: float = 0.98, is_fitted: bool = True, limit=None) -> Nested:
    """Standard normals on two levels; the first component explains 0.6 of the coarse variance."""
    generator = np.random.default_rng(seed)
    normals = generator.standard_normal((numbers[-1], 2))
    coarse = np.sqrt(0.6) * normals[:, 0] + np.sqrt(0.4) * generator.standard_normal(numbers[-1])
    rest = np.sqrt(1.0 - correlation**2) * generator.standard_normal(numbers[0])
    quantity = [correlation * coarse[: numbers[0]] + rest, coarse]
    limits = None if limit is None else np.array([limit])
    outcome = [q[:, None] if limit is None else (q[:, None] > limits).astype(float) for q in quantity]
    return Nested(outcome, quantity, limit is not None, limits, normals, is_fitted)


@pytest.mark.parametrize("limit", [None, 1.0])
def test_cross_fitted_estimates_are_unbiased(limit):
    truth = 0.0 if limit is None else norm.sf(limit)
    values = np.array([contributions(nested(seed, (40, 168), limit=limit)).value[0] for seed in range(100)])
    assert abs(values.mean() - truth) < 4.0 * values.std() / np.sqrt(100)  # 4 standard errors


def test_components_that_say_nothing_and_a_useless_level_do_little_harm():
    problem = nested(1, correlation=0.0)
    plain = problem.outcome[0].std(ddof=1) / np.sqrt(64)
    assert contributions(problem).standard_error()[0] < 1.15 * plain  # 3 coefficients from 56 rows


@pytest.mark.parametrize("numbers", [(13, 29), (64, 65), (5, 40)])
def test_odd_numbers_of_indices(numbers):
    for is_fitted in (True, False):
        found = contributions(nested(2, numbers, is_fitted=is_fitted))
        assert np.isfinite([found.value[0], found.standard_error()[0]]).all()


def test_difference_of_levels_by_hand():
    problem = nested(4, (16, 64), is_fitted=False)
    fine, coarse = problem.outcome
    plain = Nested(problem.outcome, problem.quantity, False)
    by_hand = np.mean(fine - coarse[:16]) + coarse.mean()  # folds are of equal size on both levels
    assert 16 % FOLDS == 64 % FOLDS == 0
    assert contributions(plain).value[0] == pytest.approx(by_hand, rel=1e-12)


def test_work_is_shared_as_the_optimum_has_it():
    problem = nested(5, (4000, 4000), correlation=0.98, is_fitted=False)
    problem = Nested(problem.outcome, problem.quantity, False)
    found = allocate(problem, (1.0, 0.1), (0, 1))
    difference = (1.0 - 0.98) ** 2 + 1.0 - 0.98**2
    exact = np.sqrt((1.0 - difference) / difference / 0.1)
    assert found.ratio[1] == 2.0 ** np.round(np.log2(exact))


@pytest.mark.parametrize(("correlation", "work", "levels"), [(0.98, 0.1, (0, 1)), (0.98, 1.0, (0,)), (0.2, 0.1, (0,))])
def test_levels_that_do_not_pay_are_dropped(correlation, work, levels):
    problem = nested(6, (400, 400), correlation=correlation)
    assert choose_levels(problem, (1.0, work), (0, 1)).levels == levels
