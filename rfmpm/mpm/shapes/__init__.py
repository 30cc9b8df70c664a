"""Shape functions by name."""

from math import sqrt

from rfmpm.mpm.shapes.cubic_bspline import CubicBSpline
from rfmpm.mpm.shapes.gimp import Gimp
from rfmpm.mpm.shapes.linear import Linear
from rfmpm.mpm.shapes.quadratic_bspline import QuadraticBSpline

SHAPES = {"linear": Linear, "gimp": Gimp, "quadratic_bspline": QuadraticBSpline, "cubic_bspline": CubicBSpline}


def build_axis(shape: str, cell: float, cells: int, points_per_cell: int):
    """Make the shape function of one axis.

    Args:
        shape: name of the shape function.
        cell: side of a cell [m].
        cells: number of cells.
        points_per_cell: points in a full cell, a square number; the size of a point, where the shape needs it.

    Returns:
        The shape function.
    """
    kind = SHAPES[shape]
    if "half_size" in kind._fields:
        return kind(1.0 / cell, cells, 0.5 / sqrt(points_per_cell))
    return kind(1.0 / cell, cells)
