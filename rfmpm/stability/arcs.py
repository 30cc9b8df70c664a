"""Circular slip surfaces: arcs between two places on the ground, and the search for the one of least factor.

Three numbers name an arc: where it enters and where it leaves the ground [m along the ground from its upper end], and a
share from 0 to 1 of its depth, from the flattest arc that stays in the ground to the deepest one that neither crosses
the base nor overhangs where it enters. Where soil can slide along the base the share goes on to 2, from that arc to the
one that enters vertically, and what lies below the base is replaced by the base.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.stability.equilibrium import BISHOP, factor
from rfmpm.stability.slices import cohesion_above, cut, ground_level

THINNEST = 2.0  # squares: a body nowhere thicker is a crumb of the raster, no slide
FLATTEST = 1e-3  # share of the deepest arc's half angle, in place of a chord
BISECTIONS = 40
ALMOST = 1e-9  # of a radius or in radians: what rounding makes of an arc that touches the base


class Line(NamedTuple):
    """Points of a surface from its upper end to its lower one, shape (m,) each [m]; room for more than are used."""

    x: np.ndarray
    y: np.ndarray


@kernel
def place_on_ground(ground, way):
    """The place (x, y) on the ground at a way along it."""
    way = min(max(way, 0.0), ground.along[-1])
    j = min(max(np.searchsorted(ground.along, way, "right") - 1, 0), len(ground.x) - 2)
    share = (way - ground.along[j]) / (ground.along[j + 1] - ground.along[j])
    x = ground.x[j] + share * (ground.x[j + 1] - ground.x[j])
    return x, ground.y[j] + share * (ground.y[j + 1] - ground.y[j])


@kernel
def arc(ground, entry, leaving, depth):
    """Centre, radius, first and last angle from straight down of an arc; radius 0 where there is none."""
    none = (0.0, 0.0, 0.0, 0.0, 0.0)
    x_in, y_in = place_on_ground(ground, entry)
    x_out, y_out = place_on_ground(ground, leaving)
    across, down = x_out - x_in, y_in - y_out
    if across <= 0.0 or down <= 0.0:
        return none
    chord, dip = np.sqrt(across * across + down * down), np.arctan2(down, across)
    # With a half angle a beyond the dip the lowest point lies chord / (2 sin a) (1 - cos(a - dip)) below the exit.
    beside, up = np.cos(dip), np.sin(dip) + 2.0 * (y_out - ground.base) / chord
    touching = np.arctan2(up, beside) + np.arccos(min(1.0 / np.sqrt(beside * beside + up * up), 1.0))
    steepest = 0.5 * np.pi - dip
    deepest = min(touching, steepest)
    flattest = FLATTEST * deepest
    for j in range(len(ground.x)):
        if entry < ground.along[j] < leaving:
            # A corner below the chord: the arc through it sees the chord from there under pi less its half angle.
            ax, ay, bx, by = x_in - ground.x[j], y_in - ground.y[j], x_out - ground.x[j], y_out - ground.y[j]
            turn = ay * bx - ax * by
            if turn > 0.0:
                flattest = max(flattest, np.pi - np.arctan2(turn, ax * bx + ay * by))
    if flattest >= deepest:
        return none
    half = flattest + min(depth, 1.0) * (deepest - flattest) + max(depth - 1.0, 0.0) * (steepest - deepest)
    radius = 0.5 * chord / np.sin(half)
    x = 0.5 * (x_in + x_out) + radius * np.cos(half) * np.sin(dip)
    y = 0.5 * (y_in + y_out) + radius * np.cos(half) * np.cos(dip)
    return x, y, radius, -dip - half, half - dip


@kernel
def draw(ground, found, count, line):
    """Put count + 1 points of an arc into a line, from the foot of the tension crack on; False where there is none."""
    x, y, radius, start, end = found
    if radius == 0.0:
        return False
    if ground.crack > 0.0:
        above, below = start, 0.5 * (start + end)
        if ground_level(ground, x + radius * np.sin(below)) - (y - radius * np.cos(below)) < ground.crack:
            return False
        for _ in range(BISECTIONS):
            angle = 0.5 * (above + below)
            if ground_level(ground, x + radius * np.sin(angle)) - (y - radius * np.cos(angle)) < ground.crack:
                above = angle
            else:
                below = angle
        start = below
    lowest = y - radius * np.cos(min(end, 0.0))  # where the arc leaves the ground if it still descends there
    if ground.base_friction < np.inf and lowest < ground.base - ALMOST * radius:
        return draw_cut_off(ground, x, y, radius, start, end, count, line)
    for i in range(count + 1):
        angle = start + (end - start) * i / count
        line.x[i], line.y[i] = x + radius * np.sin(angle), y - radius * np.cos(angle)
    return True


@kernel
def draw_cut_off(ground, x, y, radius, start, end, count, line):
    """As `draw`, of an arc whose part below the base is replaced by the base, which no slice leaves in its middle."""
    meeting = np.arccos(max((y - ground.base) / radius, -1.0))
    if start >= -meeting:
        return False
    whole = np.sin(end) - np.sin(start)
    first = max(int(count * (np.sin(-meeting) - np.sin(start)) / whole), 1)
    last = 0 if end <= meeting + ALMOST else max(int(count * (np.sin(end) - np.sin(meeting)) / whole), 1)
    along, far = count - first - last, min(end, meeting)
    if along < 1:
        return False
    for i in range(count + 1):
        if i <= first:
            angle = start + (-meeting - start) * i / first
        elif i < count - last:
            line.x[i] = x + radius * (np.sin(far) * (i - first) - np.sin(meeting) * (first + along - i)) / along
            line.y[i] = ground.base
            continue
        else:
            angle = far if last == 0 else far + (end - far) * (i - first - along) / last
        line.x[i], line.y[i] = x + radius * np.sin(angle), y - radius * np.cos(angle)
    line.y[first] = line.y[count - last] = ground.base
    return True


@kernel
def of_arc(ground, soil, entry, leaving, depth, count, method, line, slices):
    """Factor of an arc by a method; infinite where there is none."""
    chain = arc(ground, entry, leaving, depth)
    if not draw(ground, chain, count, line):
        return np.inf
    if cut(ground, soil, line.x, line.y, count, slices) < THINNEST * soil.square:
        return np.inf
    if ground.base_friction < np.inf:
        meet_base(ground, soil, chain, count, method, line, slices)
    return factor(slices, count, method)


@kernel
def meet_base(ground, soil, chain, count, method, line, slices):
    """Levers of the slices on the base, and what it costs by Bishop's method that the body bends where it meets it.

    There the soil that turns shears past the soil that slides, with its cohesion, on the vertical above. Its lever is
    the sine of the dip of the arc; the slice of the arc that ends there takes it.
    """
    _, y, radius, _, _ = chain
    lever = (y - ground.base) / radius
    for i in range(count):
        if slices.limit[i] == np.inf:
            continue
        slices.lever[i] = lever
        if method == BISHOP and i > 0 and slices.limit[i - 1] == np.inf:
            slices.cohesion[i - 1] += cohesion_above(ground, soil, line.x[i], ground.base) * slope_of(lever)
        if method == BISHOP and i + 1 < count and slices.limit[i + 1] == np.inf:
            slices.cohesion[i + 1] += cohesion_above(ground, soil, line.x[i + 1], ground.base) * slope_of(lever)


@kernel
def slope_of(cosine):
    """Sine of the angle of a cosine."""
    return np.sqrt(max(1.0 - cosine * cosine, 0.0))


@kernel
def survey(ground, soil, ways, depths, count, method, line, slices, found):
    """Factor of the arcs between all ways along the ground, at all depths, into found, shape (n, n, m)."""
    for i in range(len(ways)):
        for j in range(len(ways)):
            for k in range(len(depths)):
                found[i, j, k] = np.inf
                if i < j:
                    found[i, j, k] = of_arc(ground, soil, ways[i], ways[j], depths[k], count, method, line, slices)


@kernel
def refine(ground, soil, entry, leaving, depth, steps, rounds, count, method, line, slices):
    """Walk from an arc to a better neighbour while there is one, then with half the steps; shape (3,) in and out."""
    best = of_arc(ground, soil, entry, leaving, depth, count, method, line, slices)
    wide, high = steps
    deepest = 2.0 if ground.base_friction < np.inf else 1.0
    for _ in range(rounds):
        here = (entry, leaving, depth)
        for i in range(-1, 2):
            for j in range(-1, 2):
                for k in range(-1, 2):
                    a = max(here[0] + i * wide, 0.0)
                    b = min(here[1] + j * wide, ground.along[-1])
                    c = min(max(here[2] + k * high, 0.0), deepest)
                    tried = of_arc(ground, soil, a, b, c, count, method, line, slices)
                    if tried < best:
                        best, entry, leaving, depth = tried, a, b, c
        if here == (entry, leaving, depth):
            wide, high = 0.5 * wide, 0.5 * high
    return best, entry, leaving, depth
