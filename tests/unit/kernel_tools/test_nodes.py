"""Sums over nodes: the compiled ones are the plain Python ones of the same name, and scatter is gather's transpose."""

import numpy as np
import pytest

from rfmpm.kernel_tools import gather, gather_slopes, kernel, scatter, scatter_scalar, scatter_slopes

ROWS, COLUMNS = 6, 7
IDENTITY = 1e-12  # a few tens of roundings, fused or not, of values of order one
both_widths = pytest.mark.parametrize("width", [2, 3])
every_corner = pytest.mark.parametrize("corner", [(0, 0), (2, 1), (-1, -1)])


@kernel
def compiled_gather(values, i, wx, j, wy):
    return gather(values, i, wx, j, wy)


@kernel
def compiled_gather_slopes(values, i, wx, dx, j, wy, dy):
    return gather_slopes(values, i, wx, dx, j, wy, dy)


@kernel
def compiled_scatter(values, i, wx, j, wy, amount):
    scatter(values, i, wx, j, wy, amount)


@kernel
def compiled_scatter_slopes(values, i, wx, dx, j, wy, dy, amount, along_x, along_y):
    scatter_slopes(values, i, wx, dx, j, wy, dy, amount, along_x, along_y)


@kernel
def compiled_scatter_scalar(values, i, wx, j, wy, amount):
    scatter_scalar(values, i, wx, j, wy, amount)


@pytest.fixture
def random():
    return np.random.default_rng(3)


def first_node(corner, width):
    """Column and row of the first node; -1 is the last place where the stencil fits."""
    i, j = corner
    return (COLUMNS - width if i < 0 else i), (ROWS - width if j < 0 else j)


def tuples(random, width, count):
    return [tuple(random.normal(size=width)) for _ in range(count)]


@both_widths
@every_corner
def test_gather(random, width, corner):
    (i, j), values = first_node(corner, width), random.normal(size=(ROWS, COLUMNS, 4))
    wx, wy, dx, dy = tuples(random, width, 4)
    by_hand = [
        sum(wy[b] * wx[a] * values[j + b, i + a, k] for b in range(width) for a in range(width)) for k in range(4)
    ]
    np.testing.assert_allclose(gather(values, i, wx, j, wy), by_hand, rtol=0.0, atol=IDENTITY)
    np.testing.assert_allclose(compiled_gather(values, i, wx, j, wy), by_hand, rtol=0.0, atol=IDENTITY)
    plain = gather_slopes(values, i, wx, dx, j, wy, dy)
    np.testing.assert_allclose(plain[0], by_hand, rtol=0.0, atol=IDENTITY)
    np.testing.assert_allclose(plain[1], gather(values, i, dx, j, wy), rtol=0.0, atol=IDENTITY)
    np.testing.assert_allclose(plain[2], gather(values, i, wx, j, dy), rtol=0.0, atol=IDENTITY)
    found = compiled_gather_slopes(values, i, wx, dx, j, wy, dy)
    np.testing.assert_allclose(found, plain, rtol=0.0, atol=IDENTITY)


@both_widths
@every_corner
def test_compiled_scatter_adds_what_the_plain_one_adds(random, width, corner):
    (i, j), before = first_node(corner, width), random.normal(size=(ROWS, COLUMNS, 4))
    wx, wy, dx, dy = tuples(random, width, 4)
    amount, along_x, along_y = tuples(random, 4, 3)
    mass = before[:, :, 0].copy()
    for plain, compiled, values, arguments in (
        (scatter, compiled_scatter, before, (i, wx, j, wy, amount)),
        (scatter_scalar, compiled_scatter_scalar, mass, (i, wx, j, wy, 0.7)),
        (scatter_slopes, compiled_scatter_slopes, before, (i, wx, dx, j, wy, dy, amount, along_x, along_y)),
    ):
        expected, found = values.copy(), values.copy()
        plain(expected, *arguments)
        compiled(found, *arguments)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=IDENTITY)
        touched = np.zeros((ROWS, COLUMNS), dtype=bool)
        touched[j : j + width, i : i + width] = True
        assert np.array_equal(found[~touched], values[~touched])
        assert not np.any(found[touched] == values[touched])


@both_widths
@every_corner
def test_scatter_is_the_transpose_of_gather(random, width, corner):
    (i, j), values = first_node(corner, width), random.normal(size=(ROWS, COLUMNS, 4))
    wx, wy, dx, dy = tuples(random, width, 4)
    amount, along_x, along_y = tuples(random, 4, 3)
    for scattered in (scatter, compiled_scatter):
        sums = np.zeros_like(values)
        scattered(sums, i, wx, j, wy, amount)
        assert np.vdot(sums, values) == pytest.approx(np.dot(gather(values, i, wx, j, wy), amount), abs=IDENTITY)
    for scattered in (scatter_slopes, compiled_scatter_slopes):
        sums = np.zeros_like(values)
        scattered(sums, i, wx, dx, j, wy, dy, amount, along_x, along_y)
        gathered = gather_slopes(values, i, wx, dx, j, wy, dy)
        assert np.vdot(sums, values) == pytest.approx(np.vdot(gathered, (amount, along_x, along_y)), abs=IDENTITY)
    for scattered in (scatter_scalar, compiled_scatter_scalar):
        mass = np.zeros((ROWS, COLUMNS))
        scattered(mass, i, wx, j, wy, 0.7)
        expected = 0.7 * gather(values, i, wx, j, wy)[2]
        assert np.vdot(mass, values[:, :, 2]) == pytest.approx(expected, abs=IDENTITY)
