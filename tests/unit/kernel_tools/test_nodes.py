"""Sums over nodes: the compiled ones are the plain Python ones of the same name, and scatter is gather's transpose."""

import numpy as np
import pytest

from rfmpm.kernel_tools import (
    gather,
    gather_slopes,
    kernel,
    make_stencil,
    put_stencil,
    scatter,
    scatter_rows,
    scatter_slopes,
)

ROWS, COLUMNS, POINT = 6, 7, 5
IDENTITY = 1e-12  # a few tens of roundings, fused or not, of values of order one
every_width = pytest.mark.parametrize("width", [2, 3, 4])
every_corner = pytest.mark.parametrize("corner", [(0, 0), (2, 1), (-1, -1)])


@kernel
def compiled_gather(values, x, y, p):
    return gather(values, x, y, p)


@kernel
def compiled_gather_slopes(values, x, y, p):
    return gather_slopes(values, x, y, p)


@kernel
def compiled_scatter(values, x, y, p, amount):
    scatter(values, x, y, p, amount)


@kernel
def compiled_scatter_slopes(values, x, y, p, amount, along_x, along_y):
    scatter_slopes(values, x, y, p, amount, along_x, along_y)


@kernel
def compiled_scatter_rows(values, x, y, p, amount):
    scatter_rows(values, x, y, p, amount)


@kernel
def stencil(first, weights, slopes):
    made = make_stencil(weights)
    put_stencil(made, POINT, first, weights, slopes)
    return made


@pytest.fixture
def random():
    return np.random.default_rng(3)


@pytest.fixture
def place(random, width, corner):
    """Column, weights and slopes, row, weights and slopes of one point; corner -1 is the last place that fits."""
    i, j = corner
    return (
        *((COLUMNS - width if i < 0 else i), *weights_and_slopes(random, width)),
        *((ROWS - width if j < 0 else j), *weights_and_slopes(random, width)),
    )


def weights_and_slopes(random, width):
    """Weights that sum to one and slopes that sum to zero."""
    weights, slopes = random.uniform(size=width), random.normal(size=width)
    return tuple(weights / weights.sum()), tuple(slopes - slopes.mean())


def both(place):
    return stencil(*place[:3]), stencil(*place[3:])


@every_width
@every_corner
def test_gather(random, place, width):
    (i, wx, dx, j, wy, dy), (x, y) = place, both(place)
    values = random.normal(size=(ROWS, COLUMNS, 4))

    def by_hand(across, up):
        return [
            sum(up[b] * across[a] * values[j + b, i + a, k] for b in range(width) for a in range(width))
            for k in range(4)
        ]

    expected = by_hand(wx, wy), by_hand(dx, wy), by_hand(wx, dy)
    for gathered in (gather, compiled_gather):
        np.testing.assert_allclose(gathered(values, x, y, POINT), expected[0], rtol=0.0, atol=IDENTITY)
    for gathered in (gather_slopes, compiled_gather_slopes):
        np.testing.assert_allclose(gathered(values, x, y, POINT), expected, rtol=0.0, atol=IDENTITY)


@every_width
@every_corner
def test_compiled_scatter_adds_what_the_plain_one_adds(random, place, width):
    (i, _, _, j, _, _), (x, y) = place, both(place)
    before = random.normal(size=(ROWS, COLUMNS, 4))
    amount, along_x, along_y = (tuple(random.normal(size=4)) for _ in range(3))
    touched = np.zeros((ROWS, COLUMNS, 4), dtype=bool)
    touched[j : j + width, i : i + width] = True
    in_lanes = np.zeros((ROWS, COLUMNS, 4), dtype=bool)
    in_lanes[j : j + width, i, :width] = True
    for plain, compiled, arguments, changed in (
        (scatter, compiled_scatter, (amount,), touched),
        (scatter_rows, compiled_scatter_rows, (0.7,), in_lanes),
        (scatter_slopes, compiled_scatter_slopes, (amount, along_x, along_y), touched),
    ):
        expected, found = before.copy(), before.copy()
        plain(expected, x, y, POINT, *arguments)
        compiled(found, x, y, POINT, *arguments)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=IDENTITY)
        assert np.array_equal(found != before, changed)


@every_width
@every_corner
def test_scatter_is_the_transpose_of_gather(random, place, width):
    x, y = both(place)
    values = random.normal(size=(ROWS, COLUMNS, 4))
    amount, along_x, along_y = (tuple(random.normal(size=4)) for _ in range(3))
    for scattered in (scatter, compiled_scatter):
        sums = np.zeros_like(values)
        scattered(sums, x, y, POINT, amount)
        assert np.vdot(sums, values) == pytest.approx(np.dot(gather(values, x, y, POINT), amount), abs=IDENTITY)
    for scattered in (scatter_slopes, compiled_scatter_slopes):
        sums = np.zeros_like(values)
        scattered(sums, x, y, POINT, amount, along_x, along_y)
        gathered = gather_slopes(values, x, y, POINT)
        assert np.vdot(sums, values) == pytest.approx(np.vdot(gathered, (amount, along_x, along_y)), abs=IDENTITY)
    for scattered in (scatter_rows, compiled_scatter_rows):
        sums = np.zeros_like(values)
        scattered(sums, x, y, POINT, 0.7)
        mass = sum(np.pad(sums[:, : COLUMNS - k, k], ((0, 0), (k, 0))) for k in range(width))
        expected = 0.7 * gather(values, x, y, POINT)[2]
        assert np.vdot(mass, values[:, :, 2]) == pytest.approx(expected, abs=IDENTITY)
