"""When a campaign may stop, and plans on rows that say little."""

import numpy as np
import pytest

from rfmpm.estimators import ControlVariate, MonteCarlo, Multilevel, Question, Rows
from rfmpm.estimators.staged import EQUAL_ENOUGH


def rows_of(*levels) -> Rows:
    level = np.repeat(np.arange(len(levels)), [len(y) for y in levels])
    index = np.concatenate([np.arange(len(y)) for y in levels])
    value = np.concatenate([np.asarray(y, float) for y in levels])
    return Rows(level, index, value, np.zeros(value.size, bool), np.ones(value.size))


def test_equal_values_are_no_precise_mean():
    estimator = MonteCarlo(Question("run_out", half_width=0.1))
    assert estimator.plan(rows_of(np.zeros(64)))[0].indices == range(64, 128)
    number = EQUAL_ENOUGH
    assert estimator.plan(rows_of(np.zeros(number))) == []


@pytest.mark.parametrize("make", [Multilevel, ControlVariate])
@pytest.mark.parametrize("completed", [0, 1])
@pytest.mark.parametrize("asked", [{"kind": "exceedance", "limit": 1.0}, {"kind": "quantile", "probability": 0.9}])
def test_a_plan_goes_on_where_nearly_all_failed(make, completed, asked):
    own = np.full(64, np.nan)
    own[:completed] = 2.0
    estimator = make(Question("run_out", **asked, half_width=0.05, at_most=200), 1)
    assert estimator.plan(rows_of(own, np.linspace(0.0, 3.0, 64)))


def test_a_quantile_at_an_atom_of_the_least_value_has_a_lower_bound():
    values = np.concatenate([np.zeros(150), np.linspace(1.0, 2.0, 106)])
    asked = Question("run_out", "quantile", probability=0.5)
    found = Multilevel(asked, 1, 256).estimate(rows_of(np.random.default_rng(2).permutation(values)))
    assert (found.lower, found.value, found.upper) == (0.0, 0.0, 0.0)
