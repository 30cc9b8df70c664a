"""Volumetric strain and pressure as means over the points of a cell, so that flow at constant volume does not lock.

Each point's volumetric strain increment is replaced by the volume-weighted mean over the points of its cell, and in the
internal force its in-plane mean stress by the same mean: the two are adjoint, so that the force does on the nodes
exactly the work that the stress does on the mean strain (mean dilatation, Nagtegaal, Parks and Rice 1974; Hughes 1980,
with the material points as quadrature). Averaging the strain alone feeds energy into thin layers.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor, kernel
from rfmpm.mpm.stages import XX, YY
from rfmpm.mpm.state import Points


class Cells(NamedTuple):
    """Sums over the points of each cell, numbered row by row; reals are numbers per cell or point."""

    of: np.ndarray  # (points,) cell of each point
    gradient: np.ndarray  # (4 points,) velocity gradient: xx, xy, yx, yy [1/s]
    stress: Tensor  # (points,) each: stress with the mean pressure of the cell [Pa]
    volume: np.ndarray  # (cells,) [m3/m]
    sums: np.ndarray  # (cells,) of volume times what is averaged, then the mean


def make_cells(count: int, axes) -> Cells:
    """Make the sums of a scene of `count` points."""
    cells = (axes.x.cells + 1) * (axes.y.cells + 1)
    stress = Tensor(*(np.zeros(count) for _ in Tensor._fields))
    return Cells(np.zeros(count, np.int32), np.zeros(4 * count), stress, np.zeros(cells), np.zeros(cells))


@kernel
def sum_dilatation(points, cells, first, last):
    """Add volume times volumetric strain rate of the points first, ..., last - 1 to their cells."""
    for p in range(first, last):
        rate = cells.gradient[4 * p + XX] + cells.gradient[4 * p + YY]
        cells.sums[cells.of[p]] += points.volume[p] * rate


@kernel
def share_dilatation(cells, first, last):
    """Replace the volumetric strain rate of the points by the mean of their cells."""
    for p in range(first, last):
        half = 0.5 * (cells.sums[cells.of[p]] - cells.gradient[4 * p + XX] - cells.gradient[4 * p + YY])
        cells.gradient[4 * p + XX] += half
        cells.gradient[4 * p + YY] += half


@kernel
def sum_pressure(points, axes, cells, first, last):
    """Find the cells of the points anew and add volume, and volume times in-plane mean stress, to them."""
    x, y, pitch = points.position.x, points.position.y, axes.x.cells + 1
    for p in range(first, last):
        cells.of[p] = np.int32(y[p] * axes.y.inverse_cell) * pitch + np.int32(x[p] * axes.x.inverse_cell)
    for p in range(first, last):
        cells.volume[cells.of[p]] += points.volume[p]
        cells.sums[cells.of[p]] += points.volume[p] * 0.5 * (points.stress.xx[p] + points.stress.yy[p])


@kernel
def share_pressure(points, cells, first, last):
    """Put the stress with the mean of the cell in place of the in-plane mean stress into `cells.stress`."""
    xx, yy = points.stress.xx, points.stress.yy
    for p in range(first, last):
        change = cells.sums[cells.of[p]] - 0.5 * (xx[p] + yy[p])
        cells.stress.xx[p], cells.stress.yy[p] = xx[p] + change, yy[p] + change
        cells.stress.xy[p] = points.stress.xy[p]


@kernel
def divide(cells):
    """Turn the sums into means."""
    for c in range(cells.sums.size):
        cells.sums[c] = cells.sums[c] / cells.volume[c] if cells.volume[c] > 0.0 else 0.0


@kernel
def with_mean_pressure(points, cells):
    """The points with the stresses that make the internal force."""
    return Points(points.position, points.velocity, points.mass, points.volume, cells.stress)
