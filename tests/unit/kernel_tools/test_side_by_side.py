"""Kernels called by several threads at once."""

from typing import NamedTuple

import numpy as np
import pytest

from rfmpm.kernel_tools import Vector, kernel, side_by_side, start_threads


class Body(NamedTuple):
    """A record in a record, as kernels have them."""

    place: Vector
    weight: float


@kernel
def shift(rank, body, extra):
    """Write what only the call of this number writes."""
    body.place.x[rank] += body.weight * rank
    if extra is not None:
        body.place.y[rank] += extra[rank]


@kernel
def shift_all(count, threads, body, extra):
    """Call it for every number."""
    side_by_side(shift, count, threads, (body, extra))


def plainly(count, threads, body, extra):
    """The same without compilation."""
    side_by_side(shift.py_func, count, threads, (body, extra))


@pytest.mark.parametrize("call", [shift_all, plainly])
@pytest.mark.parametrize("extra", [None, np.arange(5.0)], ids=["without", "with"])
@pytest.mark.parametrize("count", [0, 1, 5])
def test_every_number_is_called_once(call, extra, count):
    threads = start_threads()  # on two cores or so fewer than the five calls
    body = Body(Vector(np.zeros(5), np.zeros(5)), 2.0)
    call(count, threads, body, extra)
    called = np.arange(5) < count
    np.testing.assert_array_equal(body.place.x, np.where(called, 2.0 * np.arange(5), 0.0))
    np.testing.assert_array_equal(body.place.y, np.where(called, 0.0 if extra is None else extra, 0.0))
