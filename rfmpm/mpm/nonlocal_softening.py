"""Softening over a length of the soil: strength follows an average of the plastic strain around each point.

Over-nonlocal softening (Vermeer and Brinkgreve 1994; Bazant and Jirasek 2002, section 4): the strength follows
(1 - m) e + m <e>, where <e> is the average of the plastic strain e over the volume around the point, weighted by a
Gaussian whose standard deviation is the length. Only with m > 1 does a shear band get a width of its own.
"""

from math import ceil, exp, sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import BLOCK, by_range, gather, kernel, part, scatter, zeros
from rfmpm.mpm.stages import locate, make_scratch

OVERSHOOT = 2.0  # m
REACH = 3.5  # standard deviations, beyond which the Gaussian is cut off
COARSEST = 0.05  # least variance that is left to the Gaussian on the grid, in square cells


class Averaging(NamedTuple):
    """How the plastic strain is averaged, and whose; the grid's own node arrays are not touched."""

    history: tuple  # of the points that soften by the average; those of another soil bring nothing to it
    overshoot: float  # m [-]
    taps: np.ndarray  # (2 r + 1,) weights of neighbouring nodes along one axis [-]
    sums: np.ndarray  # (rows, columns, 4): volume, volume times plastic strain, two unused
    spread: np.ndarray  # the same, while the other axis is averaged


def averaging(length: float, history: tuple, axes) -> Averaging:
    """Prepare the averages of a scene.

    Going from the points to the nodes and back spreads a value by itself, with the variance of the shape functions; the
    Gaussian between nodes adds what is missing to the square of the length.

    Args:
        length: standard deviation of the average [m].
        history: of the points that soften by it.
        axes: shape functions.

    Returns:
        The averaging, with node arrays of its own.
    """
    cell = 1.0 / axes.x.inverse_cell
    variance = max((length / cell) ** 2 - 2.0 * shape_variance(axes.x), COARSEST)
    radius = ceil(REACH * sqrt(variance))
    taps = np.array([exp(-0.5 * k * k / variance) for k in range(-radius, radius + 1)])
    rows, columns = axes.y.cells + 1, axes.x.cells + 1
    room = zeros(rows, columns), zeros(rows, columns)
    return Averaging(history, OVERSHOOT, taps / taps.sum(), *room)


def shape_variance(axis) -> float:
    """Variance of the shape function about the point, mean over the places in a cell far from walls [square cells]."""
    places = axis.cells // 2 + (np.arange(64) + 0.5) / 64
    spread = 0.0
    for place in places:
        first, weight, _ = axis.weights(place / axis.inverse_cell)
        spread += sum(w * (first + a - place) ** 2 for a, w in enumerate(weight))
    return spread / len(places)


@kernel
def average_softening(points, history, axes, averaging, box):
    """Renew the softening strain of every point: the largest over-nonlocal average of the plastic strain so far."""
    wide = widen(averaging, box)
    averaging.sums[wide[2] : wide[3] + 1, wide[0] : wide[1] + 1] = 0.0
    sum_strain(points, history, axes, averaging.sums)
    convolve_rows(averaging, box, box)
    convolve_columns(averaging, box, box)
    share_strain(points, history, axes, averaging)


@kernel
def widen(averaging, box):
    """The box of nodes that the Gaussian reaches from those of a box."""
    rows, columns, _ = averaging.sums.shape
    radius = len(averaging.taps) // 2
    across = max(box[0] - radius, 0), min(box[1] + radius, columns - 1)
    return across[0], across[1], max(box[2] - radius, 0), min(box[3] + radius, rows - 1)


@kernel
def sum_strain(points, history, axes, sums):
    """Add volume, and volume times plastic strain, to the nodes of `sums`."""
    by_range(sum_range, (history,), points.mass.size, (points, axes, sums))


@kernel
def sum_range(history, start, end, points, axes, sums):
    """Add those of one soil."""
    own = part(points, start, end)
    scratch = make_scratch(axes)
    for first in range(0, own.mass.size, BLOCK):
        block, last = locate_block(own, axes, scratch, first)
        for p in range(last - first):
            volume = block.volume[p]
            amount = volume, volume * history.plastic_strain[first + p], 0.0, 0.0
            scatter(sums, scratch.x, scratch.y, p, amount)


@kernel
def convolve_rows(averaging, box, own):
    """Average along the rows of the box `own`, part of the touched ones."""
    wide = widen(averaging, box)
    for row in range(own[2], own[3] + 1):
        convolve_row(averaging.sums[row], averaging.spread[row], averaging.taps, wide[0], wide[1])


@kernel
def convolve_columns(averaging, box, own):
    """Average along the columns, for the rows of the box `own`."""
    for row in range(own[2], own[3] + 1):
        convolve_column(averaging.spread, averaging.sums, averaging.taps, row, box)


@kernel
def share_strain(points, history, axes, averaging):
    """Let the points soften by the average around them."""
    by_range(share_range, (history,), points.mass.size, (points, axes, averaging))


@kernel
def share_range(history, start, end, points, axes, averaging):
    """Let those of one soil soften."""
    own = part(points, start, end)
    scratch, m = make_scratch(axes), averaging.overshoot
    for first in range(0, own.mass.size, BLOCK):
        _, last = locate_block(own, axes, scratch, first)
        for p in range(first, last):
            around = gather(averaging.sums, scratch.x, scratch.y, p - first)
            mixed = (1.0 - m) * history.plastic_strain[p] + m * around[1] / around[0]
            history.averaged_strain[p] = max(history.averaged_strain[p], mixed)


@kernel
def locate_block(points, axes, scratch, first):
    """Find the nodes around the points of a block. Returns the block and the index after its last point."""
    last = min(first + BLOCK, points.mass.size)
    block = part(points, first, last)
    locate(axes.x, block.position.x, scratch.x)
    locate(axes.y, block.position.y, scratch.y)
    return block, last


@kernel
def convolve_row(values, out, taps, first, last):
    """Weighted sums over neighbouring nodes of a row, into columns first, ..., last."""
    radius = len(taps) // 2
    out[first : last + 1] = 0.0
    for k in range(len(taps)):
        shift = k - radius
        start, stop = max(first, first - shift), min(last, last - shift)
        for column in range(start, stop + 1):
            for lane in range(2):
                out[column, lane] += taps[k] * values[column + shift, lane]


@kernel
def convolve_column(values, out, taps, row, box):
    """Weighted sums over the same nodes of neighbouring rows, within the touched ones, into one row."""
    radius = len(taps) // 2
    out[row, box[0] : box[1] + 1] = 0.0
    for k in range(len(taps)):
        other = row + k - radius
        if box[2] <= other <= box[3]:
            for column in range(box[0], box[1] + 1):
                for lane in range(2):
                    out[row, column, lane] += taps[k] * values[other, column, lane]
