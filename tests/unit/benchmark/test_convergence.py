"""Extrapolation over grids: exact where the error is a power of the cell, honest where it is not."""

from math import inf, isnan

import pytest

from rfmpm.benchmark.convergence import extrapolate


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_an_error_that_is_a_power_of_the_cell_is_taken_off(order):
    limit = extrapolate([3.0 + 0.7 * cell**order for cell in (1.0, 0.5, 0.25, 0.125)])
    assert limit.value == pytest.approx(3.0, rel=1e-12)
    assert limit.order == pytest.approx(order, rel=1e-9)
    assert limit.band == pytest.approx(1.25 * 0.7 * 0.125**order, rel=1e-9)


def test_an_order_beyond_the_scheme_is_not_believed():
    values = [1.0 + cell**4 for cell in (1.0, 0.5, 0.25)]
    limit = extrapolate(values)
    assert limit.order == pytest.approx(4.0)
    assert limit.value == pytest.approx(values[-1] + (values[-1] - values[-2]) / 3.0)


@pytest.mark.parametrize("values", [[1.0, 2.0, 1.5], [1.0, 1.1, 1.3], [1.0, 0.9, 0.7]])
def test_values_that_approach_nothing_are_not_extrapolated(values):
    limit = extrapolate(values)
    assert limit.value == values[-1]
    assert limit.band == pytest.approx(3.0 * abs(values[-1] - values[-2]))
    assert isnan(limit.order)


def test_values_that_no_longer_change_are_there():
    assert extrapolate([1.0, 2.0, 2.0]) == (2.0, 0.0, inf)


def test_two_grids_are_too_few():
    with pytest.raises(ValueError, match="at least three grids"):
        extrapolate([1.0, 2.0])
