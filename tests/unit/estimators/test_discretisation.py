"""Discretisation error from levels, and what to spend on next."""

import numpy as np
import pytest

from rfmpm.estimators import Exceedances, Rows, Value
from rfmpm.estimators.discretisation import discretisation

CELLS = (0.25, 0.5, 1.0)


def rows_of(error, n: int = 200, scatter: float = 0.1, levels: int = 3) -> Rows:
    """Runs whose error on cells h is error(h), about a mean of 10."""
    generator = np.random.default_rng(3)
    truth = 10.0 + generator.standard_normal(n)
    value = [truth + error(h) + scatter * generator.standard_normal(n) for h in CELLS[:levels]]
    level = np.repeat(np.arange(levels), n)
    index = np.tile(np.arange(n), levels)
    return Rows(level, index, np.concatenate(value), np.zeros(level.size, bool), np.ones(level.size))


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_order_and_error_are_found_from_three_levels(order):
    found = discretisation(rows_of(lambda h: -2.0 * h**order), Value(), CELLS)
    assert found.is_observed
    # statistical: differences of 1 or more known to 0.01 give the order to 0.05; 4 standard errors of the error
    assert found.order == pytest.approx(order, abs=0.1)
    assert abs(found.error + 2.0 * 0.25**order) < 4.0 * found.standard_error + 0.1 * abs(found.error)
    assert found.lower < found.error < found.upper


def test_two_levels_assume_an_order_and_say_so():
    found = discretisation(rows_of(lambda h: -2.0 * h, levels=2), Value(), CELLS[:2])
    assert not found.is_observed
    assert "order 1 assumed" in found.note
    assert found.lower < -0.5 < found.upper
    assert found.n == 200


@pytest.mark.parametrize("error", [lambda h: 0.0, lambda h: (h - 0.5) ** 2, lambda h: h**6])
def test_differences_without_an_order_assume_one(error):
    assert "assumed" in discretisation(rows_of(error), Value(), CELLS).note


def test_identical_levels_have_no_error_and_one_level_none_known():
    rows = rows_of(lambda h: 0.0, scatter=0.0)
    found = discretisation(rows, Value(), CELLS)
    assert (found.error, found.lower, found.upper) == (0.0, 0.0, 0.0)
    assert discretisation(rows.on_level(0), Value(), CELLS) is None


def test_failed_realisations_are_left_out_on_all_levels():
    rows = rows_of(lambda h: -2.0 * h)
    rows.value[[0, 201, 402]] = np.nan
    assert discretisation(rows, Value(), CELLS).n == 197


def test_indicators_that_never_differ_leave_room_for_some_that_would():
    found = discretisation(rows_of(lambda h: 0.0, n=64, levels=2), Exceedances(np.array([50.0])), [0.25, 0.5])
    assert found.error == 0.0
    # 1.96 / 66: half a difference of either sign more than none (Agresti and Min 2005)
    assert found.upper == -found.lower == pytest.approx(1.96 / 66.0, rel=1e-3)
