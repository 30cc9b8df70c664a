"""Common fields: what larger cells take from the reference lattice is an exact average, or an exact point value."""

import numpy as np
import pytest

from rfmpm.random_fields.common import reference, take

EXTENT = (7.25, 2.0)
FINE = 0.125  # side of a reference square


def middles(square):
    """Middles of the squares that cover 6 x 2 m, row by row."""
    x, y = np.meshgrid(np.arange(square / 2, 6.0, square), np.arange(square / 2, 2.0, square))
    return np.column_stack([x.ravel(), y.ravel()])


def taken(points, square, value, field):
    carrier = reference(points, square, round(square / FINE), EXTENT, value)
    return take(field(*carrier.points.T), carrier.members)


def rough(x, y):
    """A value that differs from place to place and has no symmetry."""
    return np.exp(np.sin(37.0 * x) + np.cos(53.0 * y) * x)


@pytest.mark.parametrize("ratio", [1, 2, 3, 4, 8])
def test_a_mean_is_that_over_the_reference_points_in_the_square(ratio):
    square = FINE * ratio
    points = middles(square)
    fine = middles(FINE)
    found = taken(points, square, "mean", rough)
    for point, value in zip(points, found, strict=True):
        inside = np.all(np.abs(fine - point) < 0.5 * square, axis=1)
        if inside.sum() == ratio**2:  # six metres may not hold a whole number of these squares
            assert value == pytest.approx(rough(*fine[inside].T).mean(), rel=1e-12)


@pytest.mark.parametrize("value", ["mean", "point"])
def test_one_lattice_belongs_to_all_cell_sizes(value):
    lattices = [reference(middles(FINE * k), FINE * k, k, EXTENT, value).points for k in (1, 2, 4)]
    np.testing.assert_array_equal(lattices[0], lattices[1])
    np.testing.assert_array_equal(lattices[0], lattices[2])


def test_coarse_means_are_means_of_the_four_finer_ones():
    by_size = {k: (middles(FINE * k), taken(middles(FINE * k), FINE * k, "mean", rough)) for k in (1, 2, 4)}
    for fine, coarse in ((1, 2), (2, 4)):
        (children, values), (parents, means) = by_size[fine], by_size[coarse]
        for parent, mean in zip(parents, means, strict=True):
            own = np.all(np.abs(children - parent) < 0.5 * FINE * coarse, axis=1)
            assert own.sum() == 4
            assert mean == pytest.approx(values[own].mean(), rel=1e-12)


@pytest.mark.parametrize("ratio", [1, 2, 3, 4])
def test_a_point_value_is_that_in_the_middle_of_the_square(ratio):
    points = middles(FINE * ratio)
    np.testing.assert_allclose(taken(points, FINE * ratio, "point", rough), rough(*points.T), rtol=1e-12)


@pytest.mark.parametrize("value", ["mean", "point"])
def test_a_point_beside_the_middle_stands_for_its_whole_square(value):
    points = middles(0.25)
    moved = points + np.random.default_rng(2).uniform(-0.124, 0.124, points.shape)
    found = reference(moved, 0.25, 2, EXTENT, value)
    np.testing.assert_array_equal(found.members, reference(points, 0.25, 2, EXTENT, value).members)
