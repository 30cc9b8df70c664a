import numpy as np
import pytest

from rfmpm.random_fields.lattice import find_lattice, require_lattice


def places(lattice):
    row, column = np.divmod(lattice.index, lattice.columns)
    return np.column_stack([lattice.x0 + column * lattice.dx, lattice.y0 + row * lattice.dy])


def slope(spacing=0.125):
    x, y = np.meshgrid(np.arange(0.5 * spacing, 15.0, spacing), np.arange(0.5 * spacing, 5.0, spacing))
    inside = x + y <= 15.0
    return np.column_stack([x[inside], y[inside]])


def test_points_of_a_slope_are_on_their_lattice_in_any_order():
    points = np.random.default_rng(1).permutation(slope())
    lattice = find_lattice(points)
    assert (lattice.columns, lattice.rows) == (120, 40)
    np.testing.assert_allclose(places(lattice), points, rtol=0, atol=1e-12)  # identity


@pytest.mark.parametrize("far", [0.0, 1e5])
def test_rounding_of_a_billionth_of_a_spacing_is_no_scatter(far):
    points = slope() + far
    moved = points + 0.125e-9 * np.random.default_rng(2).uniform(-1.0, 1.0, points.shape)
    lattice = find_lattice(moved)
    assert (lattice.columns, lattice.rows) == (120, 40)
    np.testing.assert_array_equal(lattice.index, find_lattice(points).index)


def test_the_spacing_is_the_common_measure_of_the_gaps():
    points = np.array([[0.0, 1.0], [0.2, 1.0], [0.5, 1.0], [1.1, 1.3]])
    lattice = find_lattice(points)
    assert (lattice.dx, lattice.dy) == pytest.approx((0.1, 0.3))
    assert (lattice.columns, lattice.rows) == (12, 2)


@pytest.mark.parametrize(
    ("points", "shape", "spacings"),
    [
        ([[3.0, 4.0]], (1, 1), (1.0, 1.0)),
        ([[3.0, 4.0], [3.0, 4.0]], (1, 1), (1.0, 1.0)),
        ([[0.0, 2.0], [0.5, 2.0], [1.0, 2.0]], (3, 1), (0.5, 0.5)),
        ([[1.0, 0.0], [1.0, 0.25]], (1, 2), (0.25, 0.25)),
    ],
)
def test_single_points_rows_and_columns(points, shape, spacings):
    lattice = find_lattice(np.array(points))
    assert (lattice.columns, lattice.rows) == shape
    assert (lattice.dx, lattice.dy) == spacings


def test_scattered_points_have_none():
    rng = np.random.default_rng(3)
    assert find_lattice(rng.uniform(0.0, 10.0, (50, 2))) is None
    points = slope()
    points[7, 0] += 1e-5  # one point beside its node
    assert find_lattice(points) is None
    diagonal = np.repeat(np.arange(1000.0)[:, None], 2, axis=1)  # a million nodes for a thousand points
    assert find_lattice(diagonal) is None
    with pytest.raises(ValueError, match="kronecker: these 1000 points are not on a uniform lattice; take"):
        require_lattice(diagonal, "kronecker")
