"""The soil above a slip surface, cut into vertical slices. Sliding is to the right; angles fall to the right."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel

TOUCHING = 1e-9  # a slip surface this far above the ground still lies in it, relative to the size of a square


class Slices(NamedTuple):
    """Slices from the upper end of a surface to its lower one; room for more than are used. Arrays of shape (m,)."""

    width: np.ndarray  # [m]
    sine: np.ndarray  # of the dip of the base
    cosine: np.ndarray
    weight: np.ndarray  # [N/m]
    cohesion: np.ndarray  # force of the cohesion along the base [N/m]
    friction: np.ndarray  # mean tangent along the base
    limit: np.ndarray  # coefficient of friction of the firm base where it is the slice's; infinite elsewhere
    lever: np.ndarray  # of the shear force about the centre of a circle, over its radius; 1 but on the firm base
    share: np.ndarray  # of the forces between slices, what a method needs on the way; shape (m + 1,)
    held: np.ndarray
    pushed: np.ndarray


def make_slices(room: int) -> Slices:
    """Make room for slices."""
    return Slices(*(np.empty(room + (name == "share")) for name in Slices._fields))


@kernel
def ground_level(ground, x):
    """Height of the ground at x, of the right one at a vertical face."""
    j = min(max(np.searchsorted(ground.x, x, "right") - 1, 0), len(ground.x) - 2)
    run = ground.x[j + 1] - ground.x[j]
    if run <= 0.0:
        return ground.y[j + 1]
    return ground.y[j] + (x - ground.x[j]) / run * (ground.y[j + 1] - ground.y[j])


@kernel
def weight_below(soil, column, y):
    """Weight of a column of soil below y, per area."""
    place = (y - soil.bottom) / soil.square
    row = min(max(int(np.floor(place)), 0), soil.cohesion.shape[0] - 1)
    return soil.weight[row, column] + (place - row) * (soil.weight[row + 1, column] - soil.weight[row, column])


@kernel
def cohesion_above(ground, soil, x, y):
    """Force of the cohesion on the vertical through x from y to the ground [N/m]."""
    height = ground_level(ground, x) - y
    column = min(max(int((x - soil.left) / soil.square), 0), soil.cohesion.shape[1] - 1)
    samples, whole = int(height / soil.square) + 1, 0.0
    for k in range(samples):
        row = int((y + (k + 0.5) / samples * height - soil.bottom) / soil.square)
        whole += soil.cohesion[min(max(row, 0), soil.cohesion.shape[0] - 1), column]
    return whole / samples * height


@kernel
def load_before(ground, x):
    """Force of the load on the ground to the left of x."""
    last = len(ground.load_x) - 1
    if last < 0 or x <= ground.load_x[0]:
        return 0.0
    if x >= ground.load_x[last]:
        return ground.load[last]
    j = np.searchsorted(ground.load_x, x, "right") - 1
    share = (x - ground.load_x[j]) / (ground.load_x[j + 1] - ground.load_x[j])
    return ground.load[j] + share * (ground.load[j + 1] - ground.load[j])


@kernel
def cut(ground, soil, x, y, count, slices):
    """Cut the soil above the line through x, y, shape (count + 1,), into slices between its points.

    Cohesion and friction of a slice are means over its base, read about once in each square it crosses. There is no
    water: pore pressure would enter here, as a force u l on each base, taken from its normal force in the methods.

    Returns the height of the thickest slice [m], or -1 where the line leaves the ground or crosses the base.
    """
    rows, columns = soil.cohesion.shape
    touching, per_square = TOUCHING * soil.square, 1.0 / soil.square
    thickest, last, j = 0.0, len(ground.x) - 2, 0
    area = 0.0  # below the ground, from its left end to the slice
    for i in range(count + 1):
        while j < last and ground.x[j + 1] <= x[i]:
            j += 1
        run, on = ground.x[j + 1] - ground.x[j], x[i] - ground.x[j]
        slope = (ground.y[j + 1] - ground.y[j]) / run if run > 0.0 else 0.0
        before, area = area, ground.area[j] + on * (ground.y[j] + 0.5 * on * slope)
        if i == 0:
            continue
        width, drop = x[i] - x[i - 1], y[i - 1] - y[i]
        if width <= 0.0:
            return -1.0
        top, middle = (area - before) / width, 0.5 * (y[i - 1] + y[i])
        if top < middle - touching or y[i] < ground.base - touching:
            return -1.0
        thickest = max(thickest, top - middle)
        length = np.sqrt(width * width + drop * drop)
        column = min(max(int((x[i] - 0.5 * width - soil.left) * per_square), 0), columns - 1)
        slices.weight[i - 1] = width * (weight_below(soil, column, top) - weight_below(soil, column, middle))
        slices.weight[i - 1] += load_before(ground, x[i]) - load_before(ground, x[i - 1])
        samples = int(length * per_square) + 1
        cohesion, friction = 0.0, 0.0
        for k in range(samples):
            share = (k + 0.5) / samples
            column = min(max(int((x[i] - share * width - soil.left) * per_square), 0), columns - 1)
            row = min(max(int((y[i] + share * drop - soil.bottom) * per_square), 0), rows - 1)
            cohesion += soil.cohesion[row, column]
            friction += soil.friction[row, column]
        slices.width[i - 1] = width
        slices.sine[i - 1] = drop / length
        slices.cosine[i - 1] = width / length
        slices.cohesion[i - 1] = cohesion / samples * length
        slices.friction[i - 1] = friction / samples
        slices.limit[i - 1] = ground.base_friction if max(y[i - 1], y[i]) <= ground.base + touching else np.inf
        slices.lever[i - 1] = 1.0
    return thickest
