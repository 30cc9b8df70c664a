"""Expectations given an event."""

import numpy as np
import pytest
from scipy.stats import norm

from rfmpm.estimators import Exceedances, MonteCarlo, Multilevel, Question, Rows, Value
from rfmpm.estimators.conditional import given
from rfmpm.estimators.intervals import clopper_pearson

REPEATS = 200
FAILS = Exceedances(np.array([0.0]))


def rows_of(value, numbers) -> Rows:
    level = np.repeat(np.arange(len(numbers)), numbers)
    index = np.concatenate([np.arange(n) for n in numbers])
    return Rows(level, index, np.asarray(value, float), np.zeros(level.size, bool), np.ones(level.size))


def estimator(levels: int):
    question = Question("run_out")
    return Multilevel(question, 1, 100) if levels == 2 else MonteCarlo(question, 100)


@pytest.mark.parametrize("levels", [1, 2])
def test_probability_and_mean_given_failure_are_covered(levels):
    generator = np.random.default_rng(1)
    limit = Exceedances(np.array([1.0]))
    truth = norm.sf(1.0) / norm.sf(0.0), norm.pdf(0.0) / norm.sf(0.0)  # of a standard normal given that it is positive
    hits = np.zeros(2)
    for _ in range(REPEATS):
        coarse = generator.standard_normal(400)
        fine = 0.95 * coarse[:100] + np.sqrt(1.0 - 0.95**2) * generator.standard_normal(100)
        numbers = (100, 400)[:levels]
        rows = rows_of(np.concatenate([fine, coarse][:levels]), numbers)
        for k, functions in enumerate((limit, _Positive())):
            found = given(estimator(levels), rows, functions, FAILS)
            hits[k] += found.lower[0] <= truth[k] <= found.upper[0]
    # 3 standard errors of a measured coverage; both intervals rest on a linearised ratio, so a little less than 0.95
    assert np.all(hits / REPEATS > 0.94 - 3.0 * np.sqrt(0.05 * 0.95 / REPEATS))


class _Positive:
    is_probability = False

    def __call__(self, rows):
        return np.maximum(rows.value, 0.0)[:, None]


def test_plain_monte_carlo_gives_the_share_and_mean_of_the_event_s_rows():
    value = np.array([0.0, 0.0, 2.0, 3.0, 7.0])
    rows = rows_of(value, (5,))
    found = given(estimator(1), rows, Exceedances(np.array([2.5])), FAILS)
    assert found.value[0] == pytest.approx(2.0 / 3.0, rel=1e-12)
    assert (found.lower[0], found.upper[0]) == tuple(clopper_pearson(2, 3))
    assert given(estimator(1), rows, Value(), FAILS).value[0] == pytest.approx(4.0, rel=1e-12)


def test_failed_rows_widen_and_no_event_says_nothing():
    rows = rows_of([0.0, 2.0, 3.0, np.nan], (4,))
    found = given(estimator(1), rows, Exceedances(np.array([2.5])), FAILS)
    assert found.value[0] == 0.5
    assert (found.lower[0], found.upper[0]) == (clopper_pearson(1, 3)[0], clopper_pearson(2, 3)[1])
    never = rows_of(np.zeros(6), (6,))
    found = given(estimator(1), never, Exceedances(np.array([2.5])), FAILS)
    assert np.isnan(found.value[0])
    assert (found.lower[0], found.upper[0]) == (0.0, 1.0)
    assert given(estimator(1), never, Value(), FAILS).upper[0] == np.inf
