"""Slip surfaces of any shape: lines with corners, moved from a circle to where the factor is least.

A surface is admissible where it stays in the ground and above the base, never steepens on its way down, so that the
body can slide off it without a gap, and rises no steeper at its end than a passive wedge without friction. It turns
sharply only where the strength along it changes: a body that slides round a sharp corner shears within, above the
corner, which costs strength that no method of slices counts. Without this rule homogeneous slopes come out up to 5 %
below the upper bound of limit analysis, on surfaces whose line of thrust is as it should be.
"""

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.stability.arcs import THINNEST, arc, draw, place_on_ground
from rfmpm.stability.equilibrium import factor, strength
from rfmpm.stability.slices import cut, ground_level

STEEPEST_RISE = 1.0  # of the last piece: 45 degrees
SHORTEST = 0.25  # horizontal width of a piece, in squares
WORTHWHILE = 1e-5  # gain of a step, relative to the factor
SHARPEST = 1.5  # turn of a corner per length, over that of the whole surface; a spiral comes to 1.3
CONTRAST = 1.5  # of strength before and behind a corner that may be sharper: a thin weak layer, the base
STRAIGHT = 1e-9  # what a corner may turn the wrong way, as a difference of slopes


@kernel
def is_admissible(ground, square, corners, count):
    """Whether a line of count corners is one along which a body can slide."""
    before = -np.inf
    for i in range(count - 1):
        width = corners.x[i + 1] - corners.x[i]
        if width < SHORTEST * square:
            return False
        rise = (corners.y[i + 1] - corners.y[i]) / width
        if rise < before - STRAIGHT:
            return False
        before = rise
        if i > 0 and not ground.base <= corners.y[i] <= ground_level(ground, corners.x[i]):
            return False
    return before <= STEEPEST_RISE


@kernel
def fill_in(corners, count, pieces, line):
    """Put points between the corners of a line, about as many as pieces in all; returns the number of pieces."""
    whole, last = corners.x[count - 1] - corners.x[0], 0
    line.x[0], line.y[0] = corners.x[0], corners.y[0]
    for i in range(count - 1):
        width, rise = corners.x[i + 1] - corners.x[i], corners.y[i + 1] - corners.y[i]
        own = int(np.ceil(pieces * width / whole))
        for k in range(1, own + 1):
            line.x[last + k], line.y[last + k] = corners.x[i] + k / own * width, corners.y[i] + k / own * rise
        last += own
    return last


@kernel
def of_corners(ground, soil, corners, count, pieces, method, line, slices):
    """Factor of the surface through count corners; infinite where it is not admissible."""
    if not is_admissible(ground, soil.square, corners, count):
        return np.inf
    own = fill_in(corners, count, pieces, line)
    if cut(ground, soil, line.x, line.y, own, slices) < THINNEST * soil.square:
        return np.inf
    if not turns_gently(corners, count, pieces, slices):
        return np.inf
    return factor(slices, own, method)


@kernel
def turns_gently(corners, count, pieces, slices):
    """Whether no corner of a surface cut into slices is sharp but where the strength along it changes."""
    last, whole, length = count - 1, corners.x[count - 1] - corners.x[0], 0.0
    for i in range(last):
        length += np.hypot(corners.x[i + 1] - corners.x[i], corners.y[i + 1] - corners.y[i])
    first = np.arctan2(corners.y[1] - corners.y[0], corners.x[1] - corners.x[0])
    final = np.arctan2(corners.y[last] - corners.y[last - 1], corners.x[last] - corners.x[last - 1])
    sharpest, done = SHARPEST * (final - first) / length, 0
    angle_before, length_before, resistance_before = first, 0.0, 0.0
    for i in range(last):
        width, rise = corners.x[i + 1] - corners.x[i], corners.y[i + 1] - corners.y[i]
        angle, own, resistance = np.arctan2(rise, width), np.hypot(width, rise), 0.0
        ends = done + int(np.ceil(pieces * width / whole))  # of its slices, as `fill_in` cuts them
        for k in range(done, ends):
            weight = slices.weight[k]
            cohesion, friction = strength(slices.cohesion[k], slices.friction[k], weight, slices.limit[k])
            resistance += cohesion + weight * slices.cosine[k] * friction
        resistance /= own
        is_sharp = i > 0 and angle - angle_before > 0.5 * sharpest * (length_before + own)
        if is_sharp and max(resistance, resistance_before) < CONTRAST * min(resistance, resistance_before):
            return False
        angle_before, length_before, resistance_before, done = angle, own, resistance, ends
    return True


@kernel
def set_corners(ground, level, chain, corners, count):
    """Put count corners on the surface of an arc, its part below a level replaced by the level; False if none."""
    if not draw(ground, chain, count - 1, corners):
        return False
    for i in range(1, count - 1):
        corners.y[i] = max(corners.y[i], level)
    return True


@kernel
def survey_clipped(ground, deep, soil, ways, depths, levels, count, pieces, method, corners, line, slices, found):
    """Factor of the arcs between all ways along the ground, cut off below all levels, into found, (n, n, m, l).

    The arcs are those of the same ground on a base out of reach, deep.
    """
    for i in range(len(ways)):
        for j in range(len(ways)):
            for k in range(len(depths)):
                found[i, j, k, :] = np.inf
                chain = arc(deep, ways[i], ways[j], depths[k]) if i < j else arc(deep, 0.0, 0.0, 0.0)
                for m in range(len(levels)):
                    if levels[m] < chain[1] - chain[2] or not set_corners(ground, levels[m], chain, corners, count):
                        continue
                    found[i, j, k, m] = of_corners(ground, soil, corners, count, pieces, method, line, slices)


@kernel
def nudge(ground, corners, last, i, way, ends):
    """Move one corner: an end along the ground, another one to a side (way 0, 1), up or down (2, 3), by its step."""
    step = ends[2] if way % 2 else -ends[2]
    if i == 0 or i == last:
        side = 0 if i == 0 else 1
        ends[side] = min(max(ends[side] + step, 0.0), ground.along[-1])
        corners.x[i], corners.y[i] = place_on_ground(ground, ends[side])
        if i == 0:
            corners.y[i] -= ground.crack
    elif way < 2:
        corners.x[i] += step
    else:
        corners.y[i] = max(corners.y[i] + step, ground.base)  # so that it may come to lie on the base


@kernel
def improve(ground, soil, corners, count, entry, leaving, step, least, pieces, method, line, slices):
    """Move the corners of a surface, one after the other, until no step of the least length lowers its factor."""
    best = of_corners(ground, soil, corners, count, pieces, method, line, slices)
    ends = np.array([entry, leaving, step])
    while ends[2] >= least:
        moved = False
        for i in range(count):
            for way in range(2 if i in (0, count - 1) else 4):
                x, y, first, second = corners.x[i], corners.y[i], ends[0], ends[1]
                nudge(ground, corners, count - 1, i, way, ends)
                tried = of_corners(ground, soil, corners, count, pieces, method, line, slices)
                if tried < best * (1.0 - WORTHWHILE):
                    best, moved = tried, True
                else:
                    corners.x[i], corners.y[i], ends[0], ends[1] = x, y, first, second
        if not moved:
            ends[2] *= 0.5
    return best
