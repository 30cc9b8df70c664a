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
    dilatation: np.ndarray  # (cells,) sum of volume times volumetric strain rate, then its mean [1/s]
    pressure: np.ndarray  # (cells,) sum of volume times in-plane mean stress, then its mean [Pa]


def make_cells(count: int, axes) -> Cells:
    """Make the sums of a scene of `count` points."""
    cells = (axes.x.cells + 1) * (axes.y.cells + 1)
    own = np.zeros(count, np.int32), np.zeros(4 * count), np.zeros(count)
    return Cells(*own, np.zeros(cells), np.zeros(cells), np.zeros(cells))


@kernel
def sum_dilatation(points, sums, of, gradient):
    """Add volume times volumetric strain rate of a block's points to the sums of their cells.

    Points of one cell mostly follow each other: their sum is kept until the cell changes.
    """
    cell, total = of[0], 0.0
    for p in range(of.size):
        if of[p] != cell:
            sums[cell] += total
            cell, total = of[p], 0.0
        total += points.volume[p] * (gradient[4 * p + XX] + gradient[4 * p + YY])
    sums[cell] += total


@kernel
def share_dilatation(cells, of, gradient):
    """Replace the volumetric strain rate of a block's points by the mean of their cells."""
    for p in range(of.size):
        half = 0.5 * (cells.dilatation[of[p]] - gradient[4 * p + XX] - gradient[4 * p + YY])
        gradient[4 * p + XX] += half
        gradient[4 * p + YY] += half


@kernel
def sum_pressure(points, axes, volumes, sums, of):
    """Find the cells of a block's points anew and add volume, and volume times in-plane mean stress, to their sums."""
    x, y, pitch = points.position.x, points.position.y, axes.x.cells + 1
    for p in range(of.size):
        of[p] = np.int32(y[p] * axes.y.inverse_cell) * pitch + np.int32(x[p] * axes.x.inverse_cell)
    cell, volume, total = of[0], 0.0, 0.0
    for p in range(of.size):
        if of[p] != cell:
            volumes[cell] += volume
            sums[cell] += total
            cell, volume, total = of[p], 0.0, 0.0
        volume += points.volume[p]
        total += points.volume[p] * 0.5 * (points.stress.xx[p] + points.stress.yy[p])
    volumes[cell] += volume
    sums[cell] += total


@kernel
def share_pressure(stress, cells, of, change):
    """Find by how much the mean pressure of the cell differs from that of each point of a block."""
    for p in range(of.size):
        change[p] = cells.pressure[of[p]] - 0.5 * (stress.xx[p] + stress.yy[p])


@kernel
def divide(sums, volume):
    """Turn sums into means; an empty cell keeps its zero."""
    for c in range(sums.size):
        sums[c] /= max(volume[c], SMALLEST)
