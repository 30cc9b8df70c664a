"""Volumetric strain and pressure as means over the points of a cell, so that flow at constant volume does not lock.

Each point's volumetric strain increment is replaced by the volume-weighted mean over the points of its cell, and in the
internal force its in-plane mean stress by the same mean: the two are adjoint, so that the force does on the nodes
exactly the work that the stress does on the mean strain (mean dilatation, Nagtegaal, Parks and Rice 1974; Hughes 1980,
with the material points as quadrature). Averaging the strain alone feeds energy into thin layers.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.stages import XX, YY

SMALLEST = 1e-300  # [m3/m]


class Cells(NamedTuple):
    """Sums over the points of each cell, numbered row by row."""

    of: np.ndarray  # (points,) cell of each point
    gradient: np.ndarray  # (4 points,) velocity gradient: xx, xy, yx, yy [1/s]
    change: np.ndarray  # (points,) mean pressure of the cell less the point's own, tension positive [Pa]
    volume: np.ndarray  # (cells,) [m3/m]
    sums: np.ndarray  # (cells,) of volume times what is averaged, then the mean


def make_cells(count: int, axes) -> Cells:
    """Make the sums of a scene of `count` points."""
    cells = (axes.x.cells + 1) * (axes.y.cells + 1)
    return Cells(np.zeros(count, np.int32), np.zeros(4 * count), np.zeros(count), np.zeros(cells), np.zeros(cells))


@kernel
def sum_dilatation(points, cells, first, last):
    """Add volume times volumetric strain rate of the points first, ..., last - 1 to their cells.

    Points of one cell mostly follow each other: their sum is kept until the cell changes.
    """
    of, gradient, cell, total = cells.of, cells.gradient, cells.of[first], 0.0
    for p in range(first, last):
        if of[p] != cell:
            cells.sums[cell] += total
            cell, total = of[p], 0.0
        total += points.volume[p] * (gradient[4 * p + XX] + gradient[4 * p + YY])
    cells.sums[cell] += total


@kernel
def share_dilatation(cells, first, last):
    """Replace the volumetric strain rate of the points by the mean of their cells."""
    gradient = cells.gradient
    for p in range(first, last):
        half = 0.5 * (cells.sums[cells.of[p]] - gradient[4 * p + XX] - gradient[4 * p + YY])
        gradient[4 * p + XX] += half
        gradient[4 * p + YY] += half


@kernel
def sum_pressure(points, axes, cells, first, last):
    """Find the cells of the points anew and add volume, and volume times in-plane mean stress, to them."""
    x, y, pitch, of = points.position.x, points.position.y, axes.x.cells + 1, cells.of
    for p in range(first, last):
        of[p] = np.int32(y[p] * axes.y.inverse_cell) * pitch + np.int32(x[p] * axes.x.inverse_cell)
    cell, volume, total = of[first], 0.0, 0.0
    for p in range(first, last):
        if of[p] != cell:
            cells.volume[cell] += volume
            cells.sums[cell] += total
            cell, volume, total = of[p], 0.0, 0.0
        volume += points.volume[p]
        total += points.volume[p] * 0.5 * (points.stress.xx[p] + points.stress.yy[p])
    cells.volume[cell] += volume
    cells.sums[cell] += total


@kernel
def share_pressure(stress, cells, first, last):
    """Find by how much the mean pressure of the cell differs from that of the points."""
    for p in range(first, last):
        cells.change[p] = cells.sums[cells.of[p]] - 0.5 * (stress.xx[p] + stress.yy[p])


@kernel
def divide(cells):
    """Turn the sums into means; an empty cell keeps its zero."""
    sums, volume = cells.sums, cells.volume
    for c in range(sums.size):
        sums[c] /= max(volume[c], SMALLEST)
