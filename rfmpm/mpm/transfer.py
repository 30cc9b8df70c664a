"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994) for the scheme, Nairn and Hammerquist (2021) for FMPM.
"""

from math import inf

from rfmpm.kernel_tools import (
    Tensor,
    at,
    gather,
    gather_slopes,
    inlined,
    kernel,
    put,
    scatter,
    scatter_scalar,
    scatter_slopes,
)
from rfmpm.mpm.protocols import update_stress, weights
from rfmpm.mpm.state import CHANGE_X, CHANGE_Y, X, Y


@inlined
def rotate(stress, lxx, lxy, lyx, lyy, dt):
    """Turn the stress with the body: by the rotation in the polar decomposition of I + dt L (plane: closed form)."""
    even = 1.0 + 0.5 * dt * (lxx + lyy)
    odd = 0.5 * dt * (lyx - lxy)
    scale = 1.0 / (even * even + odd * odd)
    cosine, sine = (even * even - odd * odd) * scale, 2.0 * even * odd * scale
    mean, half = 0.5 * (stress.xx + stress.yy), 0.5 * (stress.xx - stress.yy)
    turned = half * cosine - stress.xy * sine
    return Tensor(mean + turned, mean - turned, stress.zz, half * sine + stress.xy * cosine)


@inlined
def deform(points, p, law, history, gradient, dt):
    """Strain one point: its stress, history and volume. Returns the work of its stress [J/m]."""
    lxx, lxy, lyx, lyy = gradient
    old = rotate(at(points.stress, p), lxx, lxy, lyx, lyy, dt)
    strain = Tensor(dt * lxx, dt * lyy, 0.0, 0.5 * dt * (lxy + lyx))
    stress, changed = update_stress(at(law, p), old, strain, at(history, p))
    put(points.stress, p, stress)
    put(history, p, changed)
    volume = points.volume[p]
    points.volume[p] = volume * ((1.0 + dt * lxx) * (1.0 + dt * lyy) - dt * dt * lxy * lyx)
    return (0.5 * volume) * (
        (old.xx + stress.xx) * strain.xx + (old.yy + stress.yy) * strain.yy + 2.0 * (old.xy + stress.xy) * strain.xy
    )


@inlined
def add_to_nodes(grid, i, wx, dx, j, wy, dy, mass, vx, vy, volume, stress):
    """Add a point's mass, momentum m v and internal force -V sigma grad w to its nodes."""
    scatter_scalar(grid.mass, i, wx, j, wy, mass)
    momentum = mass * vx, mass * vy, 0.0, 0.0
    force_x = 0.0, 0.0, -volume * stress.xx, -volume * stress.xy
    force_y = 0.0, 0.0, -volume * stress.xy, -volume * stress.yy
    scatter_slopes(grid.sums, i, wx, dx, j, wy, dy, momentum, force_x, force_y)


@kernel
def carry_points(points, law, history, axes, grid, filtered, blend, straining, dt):
    """Carry the points through the grid in one pass: grid to point, stress, point to grid.

    One pass instead of three, because a point's data then cross the memory once a step. It reads the velocities of the
    old positions from `grid.flow` and adds to `grid.mass` and `grid.sums`, which must be zero, at the new ones; with zero
    `flow` and `dt` it only adds.

    `filtered`, where given, is the velocity towards which a fraction `blend` of the point's velocity goes (FMPM);
    `straining`, where given, the velocity that strains the points, whose own is then already up to date (MUSL).

    Returns (kinetic energy [J/m], work of gravity per unit g [kg], work of stress [J/m], largest squared speed,
    first and last node column and row touched, index of a point that left the grid or -1).
    """
    kinetic = fall = work = fastest = 0.0
    i_first, i_last, j_first, j_last = grid.mass.shape[1], 0, grid.mass.shape[0], 0
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
            return kinetic, fall, work, inf, i_first, i_last, j_first, j_last, p
        points.position.x[p], points.position.y[p] = x, y
        work += deform(points, p, law, history, (slope_x[X], slope_y[X], slope_x[Y], slope_y[Y]), dt)
        i, wx, dx = weights(axes.x, x)
        j, wy, dy = weights(axes.y, y)
        add_to_nodes(grid, i, wx, dx, j, wy, dy, mass, vx, vy, points.volume[p], at(points.stress, p))
        i_first, i_last = min(i_first, i), max(i_last, i + len(wx) - 1)
        j_first, j_last = min(j_first, j), max(j_last, j + len(wy) - 1)
        speed = vx * vx + vy * vy
        kinetic += 0.5 * mass * speed
        fall -= mass * dt * flow[Y]
        fastest = max(fastest, speed)
    return kinetic, fall, work, fastest, i_first, i_last, j_first, j_last, -1


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
