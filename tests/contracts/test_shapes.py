"""Every shape function: partition of unity, linear reproduction, slopes, and walls that are met from inside."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.protocols import weights
from rfmpm.mpm.shapes import SHAPES, build_axis

every_shape = pytest.mark.parametrize("kind", SHAPES.values(), ids=SHAPES)
# Cells whose multiples round up and down, and so do the walls' coordinates.
CELLS, COUNTS = (0.25, 0.1, 0.3, 1.0 / 3.0, 7e-3), (2, 3, 7, 80)
IDENTITY = 1e-12
untimed = settings(deadline=None)  # the first example compiles


# Pieces of polynomials meet at half cells; those of the hat averaged over half a cell (4 points) at quarter cells.
PIECES_PER_CELL = 4


def axis_of(kind, cell, count):
    """An axis of about as many cells; the wider splines need some."""
    return kind(1.0 / cell, max(count, kind.FEWEST_CELLS))


@kernel
def compiled(axis, x):
    return weights(axis, x)


@st.composite
def places(draw):
    """(cell, number of cells, coordinate), the ends and the knots of the axis as often as the rest."""
    cell, count = draw(st.sampled_from(CELLS)), draw(st.sampled_from(COUNTS))
    length = count / (1.0 / cell)
    knots = st.integers(0, PIECES_PER_CELL * count).map(lambda knot: knot * cell / PIECES_PER_CELL)
    x = draw(st.one_of(st.floats(0.0, length), knots, st.sampled_from((0.0, length, np.nextafter(length, 0.0)))))
    return cell, count, min(x, length)


def on_all_nodes(axis, x):
    """Weights and slopes of the nodes 0, 1, ... of the whole axis; nodes beyond it are an error."""
    first, value, slope = weights(axis, x)
    assert first >= 0
    assert first + len(value) - 1 <= axis.cells
    assert len(value) == len(slope)
    all_values, all_slopes = np.zeros(axis.cells + 1), np.zeros(axis.cells + 1)
    all_values[first : first + len(value)], all_slopes[first : first + len(slope)] = value, slope
    return all_values, all_slopes


@every_shape
@untimed
@given(place=places())
def test_weights_sum_to_one_and_reproduce_a_line_up_to_the_walls(kind, place):
    cell, count, x = place
    axis = axis_of(kind, cell, count)
    value, slope = on_all_nodes(axis, x)
    nodes = np.arange(axis.cells + 1) * cell
    assert value.sum() == pytest.approx(1.0, abs=IDENTITY)
    assert slope.sum() * cell == pytest.approx(0.0, abs=IDENTITY)
    assert value @ nodes == pytest.approx(x, abs=IDENTITY * count * cell)
    assert slope @ nodes == pytest.approx(1.0, abs=IDENTITY * count)
    # A coordinate that rounds past the far wall may leave a rounding below zero.
    assert value.min() >= -IDENTITY


@every_shape
@untimed
@given(place=places())
def test_slopes_are_those_of_the_weights(kind, place):
    cell, count, x = place
    axis, step, knot = axis_of(kind, cell, count), 1e-3 * cell, cell / PIECES_PER_CELL
    piece = np.floor(x / knot)  # stay inside one
    x = knot * (min(piece, PIECES_PER_CELL * count - 1) + np.clip(x / knot - piece, 0.01, 0.99))
    near, far = (
        (on_all_nodes(axis, x + reach)[0] - on_all_nodes(axis, x - reach)[0]) / (2.0 * reach)
        for reach in (step, 2.0 * step)
    )
    # Central differences, extrapolated, of polynomials up to third order are exact but for rounding over the step.
    difference = (4.0 * near - far) / 3.0
    np.testing.assert_allclose(on_all_nodes(axis, x)[1] * cell, difference * cell, rtol=0.0, atol=1e-10)


@every_shape
@untimed
@given(place=places())
def test_weights_are_continuous(kind, place):
    cell, count, x = place
    axis = axis_of(kind, cell, count)
    near = abs(x - 1e-9 * cell)
    # No weight changes faster than one per cell.
    np.testing.assert_allclose(on_all_nodes(axis, x)[0], on_all_nodes(axis, near)[0], rtol=0.0, atol=1.1e-9)


@every_shape
@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("count", COUNTS)
def test_a_wall_has_the_value_of_its_node(kind, cell, count):
    axis = axis_of(kind, cell, count)
    assert np.array_equal(on_all_nodes(axis, 0.0)[0], np.eye(axis.cells + 1)[0])
    # Identity: the far wall's coordinate is rounded.
    far = on_all_nodes(axis, axis.cells * cell)[0]
    np.testing.assert_allclose(far, np.eye(axis.cells + 1)[-1], rtol=0.0, atol=IDENTITY)


@every_shape
def test_weights_mirror_from_wall_to_wall(kind):
    axis = kind(4.0, 7)
    for x in np.linspace(0.0, 1.75, 36):
        value, slope = on_all_nodes(axis, x)
        mirrored, turned = on_all_nodes(axis, 1.75 - x)
        np.testing.assert_allclose(value, mirrored[::-1], rtol=0.0, atol=IDENTITY)
        if abs(x % 0.125 - 0.0625) < 0.06:
            np.testing.assert_allclose(slope, -turned[::-1], rtol=0.0, atol=IDENTITY * 4.0)


@every_shape
@untimed
@given(place=places())
def test_compiled_weights_are_the_plain_python_ones(kind, place):
    cell, count, x = place
    axis = axis_of(kind, cell, count)
    first, value, slope = weights(axis, x)
    found_first, found_value, found_slope = compiled(axis, x)
    assert found_first == first
    np.testing.assert_allclose(found_value, value, rtol=0.0, atol=IDENTITY)
    np.testing.assert_allclose(found_slope, slope, rtol=0.0, atol=IDENTITY / cell)


def test_points_of_fixed_size_lie_between_hats_and_quadratic_splines():
    hat, spline = SHAPES["linear"](4.0, 7), SHAPES["quadratic_bspline"](4.0, 7)
    for x in np.linspace(0.0, 1.75, 36):
        widest, narrowest = SHAPES["gimp"](4.0, 7, 0.5), SHAPES["gimp"](4.0, 7, 1e-9)
        np.testing.assert_allclose(on_all_nodes(widest, x)[0], on_all_nodes(spline, x)[0], rtol=0.0, atol=IDENTITY)
        # A point of no length differs from a hat only within its own length of a node.
        np.testing.assert_allclose(on_all_nodes(narrowest, x)[0], on_all_nodes(hat, x)[0], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(("points_per_cell", "half_size"), [(1, 0.5), (4, 0.25), (16, 0.125)])
def test_points_fill_their_cell(points_per_cell, half_size):
    assert build_axis("gimp", 0.5, 8, points_per_cell) == SHAPES["gimp"](2.0, 8, half_size)


@every_shape
def test_every_shape_is_built_by_its_name(kind):
    name = next(name for name, value in SHAPES.items() if value is kind)
    assert build_axis(name, 0.5, 8, 4) == kind(2.0, 8)
