"""Discretisation error from levels, and what to spend on next."""

import numpy as np
import pytest

from rfmpm.estimators import Estimate, Rows, Value
from rfmpm.estimators.discretisation import discretisation, error_budget

CELLS = (0.25, 0.5, 1.0)


def rows_of(error, n: int = 200, scatter: float = 0.1, levels: int = 3) -> Rows:
    """Runs whose error on cells h is error(h), about a mean of 10."""
    generator = np.random.default_rng(3)
    truth = 10.0 + generator.standard_normal(n)
    value = [truth + error(h) + scatter * generator.standard_normal(n) for h in CELLS[:levels]]
    level = np.repeat(np.arange(levels), n)
    index = np.tile(np.arange(n), levels)
    return Rows(level, index, np.concatenate(value), np.zeros(level.size, bool), np.ones(level.size))


def estimate(half: float) -> Estimate:
    return Estimate(10.0, 10.0 - half, 10.0 + half, 0.95, 200, "")


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
    assert error_budget(estimate(0.1), found).spend_on == "realisations"
    assert discretisation(rows.on_level(0), Value(), CELLS) is None
    assert error_budget(estimate(0.1), None).spend_on == "levels"


def test_failed_realisations_are_left_out_on_all_levels():
    rows = rows_of(lambda h: -2.0 * h)
    rows.value[[0, 201, 402]] = np.nan
    assert discretisation(rows, Value(), CELLS).n == 197


def test_budget_names_the_larger_error_and_what_would_balance_it():
    found = discretisation(rows_of(lambda h: -2.0 * h, levels=2), Value(), CELLS[:2])
    bias = max(abs(found.lower), abs(found.upper))
    few = error_budget(estimate(4.0 * bias), found)
    assert few.spend_on == "realisations"
    assert few.realisations_factor == pytest.approx(16.0, rel=1e-12)
    many = error_budget(estimate(bias / 4.0), found)
    assert many.spend_on == "cells"
    assert many.cell_m == pytest.approx(0.25 / 4.0, rel=1e-12)
    assert "0.06" in many.advice
    assert error_budget(estimate(bias), found).spend_on == "both"
    assert error_budget(Estimate(1.0, -np.inf, np.inf, 0.95, 1, ""), found).spend_on == "realisations"


def test_a_poorly_known_discretisation_error_asks_for_more_coarse_runs():
    found = discretisation(rows_of(lambda h: 0.0, n=4, scatter=1.0, levels=2), Value(), CELLS[:2])
    assert error_budget(estimate(0.01), found).spend_on == "levels"
