"""Common random fields on several grids: a reference lattice carries the field, and larger cells take from it.

Each cell is divided into equal squares, one material point each. The reference lattice belongs to the smallest cells;
the squares of larger cells hold a whole number of its squares. `mean`: a lattice point in the middle of each reference
square, and a material point takes the arithmetic mean over its own square. `point`: a lattice of half that spacing, on
which the middles of the squares of every such grid lie, and a material point takes the value in the middle of its
square. A point of a square that the ground surface cuts stands for the whole square.

The lattice covers the squares of every grid that the geometry allows, so that one vector `xi` belongs to all of them.
"""

from math import ceil
from typing import NamedTuple

import numpy as np


class Reference(NamedTuple):
    """Points that carry a field, shape (m, 2) [m], and which of them each material point takes, shape (n, k)."""

    points: np.ndarray
    members: np.ndarray


def reference(points: np.ndarray, square: float, ratio: int, extent: tuple[float, float], value: str) -> Reference:
    """Make the reference lattice of some material points.

    Args:
        points: material points, each in its square, shape (n, 2) [m].
        square: side of a material point's square [m].
        ratio: that side over the side of a reference square.
        extent: length and height from the origin that squares of any grid may touch [m].
        value: mean or point.

    Returns:
        the lattice and its points that each material point takes.
    """
    fine = square / ratio
    place = np.floor(points / square + 1e-9).astype(int) * ratio  # lowest left reference square
    columns, rows = (ceil(length / fine - 1e-9) for length in extent)
    if value == "mean":
        offset = np.arange(ratio)
        column = place[:, :1, None] + offset[None, None, :]
        row = place[:, 1:, None] + offset[None, :, None]
        members = (row * columns + column).reshape(len(points), -1)
        return Reference(_lattice(0.5 * fine, fine, columns, rows), members)
    column, row = (2 * place + ratio).T
    wide = 2 * columns + 1
    return Reference(_lattice(0.0, 0.5 * fine, wide, 2 * rows + 1), (row * wide + column)[:, None])


def take(values: np.ndarray, members: np.ndarray) -> np.ndarray:
    """Arithmetic mean, shape (n,), over the points, shape (n, k), that each material point takes of a field (m,)."""
    return values[members].mean(axis=1)


def _lattice(first: float, spacing: float, columns: int, rows: int) -> np.ndarray:
    x, y = (first + spacing * np.arange(count) for count in (columns, rows))
    return np.column_stack([np.tile(x, rows), np.repeat(y, columns)])
