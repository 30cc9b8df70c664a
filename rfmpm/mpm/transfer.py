"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994) for the scheme, Nairn and Hammerquist (2021) for FMPM.
"""

from math import inf

import numpy as np

from rfmpm.kernel_tools import (
    Tensor,
    at,
    gather,
    gather_slopes,
    inlined,
    kernel,
    part,
    put,
    scatter,
    scatter_scalar,
    scatter_slopes,
)
from rfmpm.mpm.protocols import update_stress, weights
from rfmpm.mpm.state import CHANGE_X, CHANGE_Y, X, Y

BLOCK = 512  # points; their data fit the second-level cache


@inlined
def rotate(stress, xx, xy, yx, yy):
    """Turn the stress with the body: by the rotation in the polar decomposition of I + dt L (plane: closed form)."""
    even = 1.0 + 0.5 * (xx + yy)
    odd = 0.5 * (yx - xy)
    scale = 1.0 / (even * even + odd * odd)
    cosine, sine = (even * even - odd * odd) * scale, 2.0 * even * odd * scale
    mean, half = 0.5 * (stress.xx + stress.yy), 0.5 * (stress.xx - stress.yy)
    turned = half * cosine - stress.xy * sine
    return Tensor(mean + turned, mean - turned, stress.zz, half * sine + stress.xy * cosine)


@kernel
def move(points, axes, grid, filtered, blend, straining, dt, strain):
    """Grid to point: velocity, position and, into `strain` (rows lxx, lxy, lyx, lyy), the velocity gradient times dt.

    Returns (kinetic energy [J/m], sum of mass times fall [kg m/m], largest squared speed, point that left the grid or
    -1).
    """
    kinetic = fall = fastest = 0.0
    length, height = axes.x.cells / axes.x.inverse_cell, axes.y.cells / axes.y.inverse_cell
    for p in range(points.mass.size):
        x, y, mass = points.position.x[p], points.position.y[p], points.mass[p]
        vx, vy = points.velocity.x[p], points.velocity.y[p]
        i, wx, dx = weights(axes.x, x)
        j, wy, dy = weights(axes.y, y)
        flow, slope_x, slope_y = gather_slopes(grid.flow, i, wx, dx, j, wy, dy)
        if straining is None:
            vx, vy = vx + flow[CHANGE_X], vy + flow[CHANGE_Y]
            if filtered is not None:
                smooth = gather(filtered, i, wx, j, wy)
                vx, vy = vx + blend * (smooth[X] - vx), vy + blend * (smooth[Y] - vy)
            points.velocity.x[p], points.velocity.y[p] = vx, vy
        else:
            _, slope_x, slope_y = gather_slopes(straining, i, wx, dx, j, wy, dy)
        x, y = x + dt * flow[X], y + dt * flow[Y]
        if not (0.0 <= x <= length and 0.0 <= y <= height):
            return kinetic, fall, inf, p
        points.position.x[p], points.position.y[p] = x, y
        strain[0, p], strain[1, p] = dt * slope_x[X], dt * slope_y[X]
        strain[2, p], strain[3, p] = dt * slope_x[Y], dt * slope_y[Y]
        speed = vx * vx + vy * vy
        kinetic += 0.5 * mass * speed
        fall -= mass * dt * flow[Y]
        fastest = max(fastest, speed)
    return kinetic, fall, fastest, -1


@kernel
def deform(points, law, history, strain):
    """Strain the points: stress, history and volume. Leaves the work of the stress [J/m] in row 4 of `strain`.

    The loop holds nothing but arithmetic on contiguous arrays, so that the compiler can take several points at once.
    """
    xx, xy, yx, yy, work = strain[0], strain[1], strain[2], strain[3], strain[4]
    for p in range(points.volume.size):
        old = rotate(at(points.stress, p), xx[p], xy[p], yx[p], yy[p])
        change = Tensor(xx[p], yy[p], 0.0, 0.5 * (xy[p] + yx[p]))
        stress, past = update_stress(at(law, p), old, change, at(history, p))
        put(points.stress, p, stress)
        put(history, p, past)
        volume = points.volume[p]
        points.volume[p] = volume * ((1.0 + xx[p]) * (1.0 + yy[p]) - xy[p] * yx[p])
        twice = (old.xx + stress.xx) * change.xx + (old.yy + stress.yy) * change.yy
        work[p] = 0.5 * volume * (twice + 2.0 * (old.xy + stress.xy) * change.xy)


@kernel
def spread(points, axes, grid, box):
    """Point to grid: add mass, momentum m v and internal force -V sigma grad w to the nodes.

    Returns the box of nodes touched so far: first and last column, first and last row.
    """
    i_first, i_last, j_first, j_last = box
    for p in range(points.mass.size):
        i, wx, dx = weights(axes.x, points.position.x[p])
        j, wy, dy = weights(axes.y, points.position.y[p])
        mass, volume, stress = points.mass[p], points.volume[p], at(points.stress, p)
        scatter_scalar(grid.mass, i, wx, j, wy, mass)
        momentum = mass * points.velocity.x[p], mass * points.velocity.y[p], 0.0, 0.0
        force_x = 0.0, 0.0, -volume * stress.xx, -volume * stress.xy
        force_y = 0.0, 0.0, -volume * stress.xy, -volume * stress.yy
        scatter_slopes(grid.sums, i, wx, dx, j, wy, dy, momentum, force_x, force_y)
        i_first, i_last = min(i_first, i), max(i_last, i + len(wx) - 1)
        j_first, j_last = min(j_first, j), max(j_last, j + len(wy) - 1)
    return i_first, i_last, j_first, j_last


@kernel
def carry_points(points, law, history, axes, grid, filtered, blend, straining, dt):
    """Carry the points through the grid: grid to point, stress, point to grid.

    One pass over the points, a block at a time, so that a point's data cross the memory once a step. It reads the
    velocities of the old positions from `grid.flow` and adds to `grid.mass` and `grid.sums`, which must be zero, at the
    new ones; with zero `flow` and `dt` it only adds.

    `filtered`, where given, is the velocity towards which a fraction `blend` of the point's velocity goes (FMPM);
    `straining`, where given, the velocity that strains the points, whose own is then already up to date (MUSL).

    Returns (kinetic energy [J/m], sum of mass times fall [kg m/m], work of stress [J/m], largest squared speed, box of
    nodes touched, index of a point that left the grid or -1).
    """
    kinetic = fall = work = fastest = 0.0
    box = grid.mass.shape[1], 0, grid.mass.shape[0], 0
    strain = np.empty((5, BLOCK))
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        block = part(points, first, last)
        energy, fallen, speed, lost = move(block, axes, grid, filtered, blend, straining, dt, strain)
        kinetic, fall, fastest = kinetic + energy, fall + fallen, max(fastest, speed)
        if lost >= 0:
            return kinetic, fall, work, fastest, box, first + lost
        deform(block, part(law, first, last), part(history, first, last), strain)
        for p in range(last - first):
            work += strain[4, p]
        box = spread(block, axes, grid, box)
    return kinetic, fall, work, fastest, box, -1


@kernel
def project_twice(points, axes, grid):
    """Add to `grid.filtered` the momentum of the interpolated grid velocity: sum over points of w m (sum of w v)."""
    for p in range(points.mass.size):
        i, wx, _ = weights(axes.x, points.position.x[p])
        j, wy, _ = weights(axes.y, points.position.y[p])
        flow, m = gather(grid.flow, i, wx, j, wy), points.mass[p]
        scatter(grid.filtered, i, wx, j, wy, (m * flow[X], m * flow[Y], 0.0, 0.0))


@kernel
def update_velocities(points, axes, grid, filtered, blend):
    """Update the points' velocities and add their momentum to `grid.straining` at the old positions (MUSL)."""
    for p in range(points.mass.size):
        i, wx, _ = weights(axes.x, points.position.x[p])
        j, wy, _ = weights(axes.y, points.position.y[p])
        flow, m = gather(grid.flow, i, wx, j, wy), points.mass[p]
        vx, vy = points.velocity.x[p] + flow[CHANGE_X], points.velocity.y[p] + flow[CHANGE_Y]
        if filtered is not None:
            smooth = gather(filtered, i, wx, j, wy)
            vx, vy = vx + blend * (smooth[X] - vx), vy + blend * (smooth[Y] - vy)
        points.velocity.x[p], points.velocity.y[p] = vx, vy
        scatter(grid.straining, i, wx, j, wy, (m * vx, m * vy, 0.0, 0.0))
