"""Stages of a step for a block of points: weights, grid to point, motion, stress, point to grid.

Each is one loop over the block. Those that hold arithmetic alone read and write contiguous arrays and have no branches,
so that the compiler takes several points at once; those that sum over nodes take the four values of one node at once.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import (
    BLOCK,
    Stencil,
    Tensor,
    at,
    gather,
    gather_slopes,
    inlined,
    kernel,
    lanes,
    make_stencil,
    part,
    put,
    put_lanes,
    put_stencil,
    scatter,
    scatter_rows,
    scatter_slopes,
)
from rfmpm.mpm.protocols import update_stress, weights
from rfmpm.mpm.state import CHANGE_X, CHANGE_Y, FORCE_X, FORCE_Y, MOVING_X, MOVING_Y, X, Y

XX, XY, YX, YY = range(4)


class Scratch(NamedTuple):
    """What the stages of a block pass on; but for the stencils, four values of a point side by side."""

    x: Stencil
    y: Stencil
    motion: np.ndarray  # grid velocity x y and its change x y, or straining velocity x y and grid velocity x y [m/s]
    smooth: np.ndarray  # filtered velocity x y [m/s]
    gradient: np.ndarray  # of the velocity: xx, xy, yx, yy [1/s]


class Tally(NamedTuple):
    """Sums over the points, kept apart by place in the block, so that their order depends on no machine."""

    kinetic: np.ndarray  # [J/m]
    fall: np.ndarray  # mass times fall [kg m/m]
    work: np.ndarray  # of the stress [J/m]
    plastic: np.ndarray  # part of it that is not stored elastically [J/m]
    fastest: np.ndarray  # largest squared speed [m2/s2]


@kernel
def make_scratch(axes):
    """Make the room that a block's stages need."""
    (_, across, _), (_, up, _), four = weights(axes.x, 0.0), weights(axes.y, 0.0), 4 * BLOCK
    return Scratch(make_stencil(across), make_stencil(up), np.empty(four), np.empty(four), np.empty(four))


@kernel
def make_tally():
    """Make empty sums."""
    return Tally(np.zeros(BLOCK), np.zeros(BLOCK), np.zeros(BLOCK), np.zeros(BLOCK), np.zeros(BLOCK))


@kernel
def locate(axis, coordinate, stencil):
    """Find nodes, weights and slopes along one axis."""
    for p in range(coordinate.size):
        first, weight, slope = weights(axis, coordinate[p])
        put_stencil(stencil, p, first, weight, slope)


@kernel
def interpolate(values, scratch, count, out):
    """Grid to point: the four values of the nodes."""
    for p in range(count):
        put_lanes(out, p, gather(values, scratch.x, scratch.y, p))


@kernel
def interpolate_slopes(values, scratch, count, gradient):
    """Grid to point: the four values of the nodes, into `motion`, and the gradient of the first two."""
    for p in range(count):
        value, along_x, along_y = gather_slopes(values, scratch.x, scratch.y, p)
        put_lanes(scratch.motion, p, value)
        put_lanes(gradient, p, (along_x[X], along_y[X], along_x[Y], along_y[Y]))


@kernel
def accelerate(velocity, motion, smooth, blend):
    """Change the points' velocities, by the grid's change and towards the filtered one."""
    for p in range(velocity.x.size):
        vx, vy = velocity.x[p] + motion[4 * p + CHANGE_X], velocity.y[p] + motion[4 * p + CHANGE_Y]
        if smooth is not None:
            vx, vy = vx + blend * (smooth[4 * p + X] - vx), vy + blend * (smooth[4 * p + Y] - vy)
        velocity.x[p], velocity.y[p] = vx, vy


@kernel
def move(points, axes, motion, dt, tally):
    """Move the points with the grid's velocity, the last two of `motion`. Returns the number of points outside."""
    length, height = axes.x.cells / axes.x.inverse_cell, axes.y.cells / axes.y.inverse_cell
    outside = 0
    for p in range(points.mass.size):
        mass, vx, vy = points.mass[p], points.velocity.x[p], points.velocity.y[p]
        speed = vx * vx + vy * vy
        right, up = dt * motion[4 * p + MOVING_X], dt * motion[4 * p + MOVING_Y]
        tally.kinetic[p] += 0.5 * mass * speed
        tally.fall[p] -= mass * up
        tally.fastest[p] = max(tally.fastest[p], speed)
        x, y = points.position.x[p] + right, points.position.y[p] + up
        points.position.x[p], points.position.y[p] = x, y
        outside += not ((x >= 0.0) & (x <= length) & (y >= 0.0) & (y <= height))
    return outside


@kernel
def rotate(stress, gradient, dt):
    """Turn the stress with the body: by the rotation in the polar decomposition of I + dt L (plane: closed form)."""
    for p in range(stress.xx.size):
        even = 1.0 + 0.5 * dt * (gradient[4 * p + XX] + gradient[4 * p + YY])
        odd = 0.5 * dt * (gradient[4 * p + YX] - gradient[4 * p + XY])
        scale = 1.0 / (even * even + odd * odd)
        cosine, sine = (even * even - odd * odd) * scale, 2.0 * even * odd * scale
        xx, yy, xy = stress.xx[p], stress.yy[p], stress.xy[p]
        mean, half = 0.5 * (xx + yy), 0.5 * (xx - yy)
        turned = half * cosine - xy * sine
        stress.xx[p], stress.yy[p], stress.xy[p] = mean + turned, mean - turned, half * sine + xy * cosine


@inlined
def elastic_density(stress, lame, shear):
    """Elastic energy of a stress per volume [Pa]: sigma : C^-1 : sigma / 2."""
    trace = stress.xx + stress.yy + stress.zz
    square = stress.xx * stress.xx + stress.yy * stress.yy + stress.zz * stress.zz + 2.0 * stress.xy * stress.xy
    return (square - lame / (3.0 * lame + 2.0 * shear) * trace * trace) * (0.25 / shear)


@kernel
def deform(points, law, history, gradient, dt, tally):
    """Strain the points, whose stresses have been rotated: stress, history and volume.

    A loop apart from the rotation's: two short chains of divisions overlap between points, one long one does not.
    """
    for p in range(points.volume.size):
        xx, xy = dt * gradient[4 * p + XX], dt * gradient[4 * p + XY]
        yx, yy = dt * gradient[4 * p + YX], dt * gradient[4 * p + YY]
        old, change = at(points.stress, p), Tensor(xx, yy, 0.0, 0.5 * (xy + yx))
        stress, past = update_stress(at(law, p), old, change, at(history, p), dt)
        put(points.stress, p, stress)
        put(history, p, past)
        volume = points.volume[p]
        points.volume[p] = volume * ((1.0 + xx) * (1.0 + yy) - xy * yx)
        twice = (old.xx + stress.xx) * change.xx + (old.yy + stress.yy) * change.yy
        work = 0.5 * (twice + 2.0 * (old.xy + stress.xy) * change.xy)
        stored = elastic_density(stress, law.lame, law.shear) - elastic_density(old, law.lame, law.shear)
        tally.work[p] += volume * work
        tally.plastic[p] += volume * (work - stored)


@kernel
def deform_range(law, history, first, last, points, gradient, dt, tally):
    """Strain the points of one soil."""
    deform(part(points, first, last), law, history, gradient[4 * first : 4 * last], dt, tally)


@kernel
def load(points, pressure, scratch):
    """Make what the points bring to the nodes: momentum; force in terms of the slopes along y, and of those along x.

    `pressure`, where given, is added to the in-plane mean stress [Pa].
    """
    carried, pushed = scratch.motion, scratch.gradient
    for p in range(points.mass.size):
        mass, volume = points.mass[p], -points.volume[p]
        xx, yy, shear = points.stress.xx[p], points.stress.yy[p], volume * points.stress.xy[p]
        if pressure is not None:
            xx, yy = xx + pressure[p], yy + pressure[p]
        carried[4 * p + X], carried[4 * p + Y] = mass * points.velocity.x[p], mass * points.velocity.y[p]
        carried[4 * p + FORCE_X], carried[4 * p + FORCE_Y] = shear, volume * yy
        pushed[4 * p + X], pushed[4 * p + Y] = 0.0, 0.0
        pushed[4 * p + FORCE_X], pushed[4 * p + FORCE_Y] = volume * xx, shear


@kernel
def spread(mass, scratch, parts, sums):
    """Point to grid: add mass, momentum m v and internal force -V sigma grad w to the nodes."""
    for p in range(mass.size):
        carried, along_x = lanes(scratch.motion, p), lanes(scratch.gradient, p)
        momentum = carried[X], carried[Y], 0.0, 0.0
        along_y = 0.0, 0.0, carried[FORCE_X], carried[FORCE_Y]
        scatter_rows(parts, scratch.x, scratch.y, p, mass[p])
        scatter_slopes(sums, scratch.x, scratch.y, p, momentum, along_x, along_y)


@kernel
def extend(box, scratch, count):
    """The box of first nodes used so far and by the block: first and last column, first and last row."""
    x, y = scratch.x.first, scratch.y.first
    left, low = x[0], y[0]
    right, high = left, low
    for p in range(count):
        left, right = min(left, x[p]), max(right, x[p])
        low, high = min(low, y[p]), max(high, y[p])
    return min(box[0], int(left)), max(box[1], int(right)), min(box[2], int(low)), max(box[3], int(high))


@kernel
def add_momentum(mass, velocity, scratch, values):
    """Point to grid: add the momentum m v to the first two values of the nodes."""
    for p in range(mass.size):
        m = mass[p]
        scatter(values, scratch.x, scratch.y, p, (m * velocity.x[p], m * velocity.y[p], 0.0, 0.0))


@kernel
def collect(parts, mass, box, axes):
    """Sum the masses that rows of nodes brought, which lie in lanes of their first node, into each node's."""
    (left, right, low, high), width = box, len(weights(axes.x, 0.0)[1])
    for j in range(low, high + 1):
        for i in range(left, right + 1):
            mass[j, i] = parts[j, i, 0]
        for k in range(1, width):
            for i in range(left + k, right + 1):
                mass[j, i] += parts[j, i - k, k]
