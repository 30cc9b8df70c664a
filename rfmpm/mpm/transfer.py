"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994) for the scheme, Nairn and Hammerquist (2021) for FMPM.
"""

from math import inf

from rfmpm.kernel_tools import Tensor, at, inlined, kernel, put
from rfmpm.mpm.protocols import update_stress, weights
from rfmpm.mpm.state import (
    CHANGE_X,
    CHANGE_Y,
    FORCE_X,
    FORCE_Y,
    MASS,
    MOMENTUM_X,
    MOMENTUM_Y,
    VELOCITY_X,
    VELOCITY_Y,
)


@inlined
def gather_pair(values, i, wx, j, wy):
    """Interpolate the first two values of the nodes: sum over nodes of w v."""
    first = second = 0.0
    for b in range(len(wy)):
        row_first = row_second = 0.0
        for a in range(len(wx)):
            row_first += wx[a] * values[j + b, i + a, 0]
            row_second += wx[a] * values[j + b, i + a, 1]
        first += wy[b] * row_first
        second += wy[b] * row_second
    return first, second


@inlined
def gather_change(flow, i, wx, j, wy):
    """Interpolate the change of velocity: sum over nodes of w dv."""
    change_x = change_y = 0.0
    for b in range(len(wy)):
        row_x = row_y = 0.0
        for a in range(len(wx)):
            row_x += wx[a] * flow[j + b, i + a, CHANGE_X]
            row_y += wx[a] * flow[j + b, i + a, CHANGE_Y]
        change_x += wy[b] * row_x
        change_y += wy[b] * row_y
    return change_x, change_y


@inlined
def gather_gradient(values, i, wx, dx, j, wy, dy):
    """Velocity gradient [1/s]: sum over nodes of v (x) grad w, as (lxx, lxy, lyx, lyy)."""
    lxx = lxy = lyx = lyy = 0.0
    for b in range(len(wy)):
        row_x = row_y = slope_x = slope_y = 0.0
        for a in range(len(wx)):
            vx, vy = values[j + b, i + a, VELOCITY_X], values[j + b, i + a, VELOCITY_Y]
            row_x += wx[a] * vx
            row_y += wx[a] * vy
            slope_x += dx[a] * vx
            slope_y += dx[a] * vy
        lxx += wy[b] * slope_x
        lxy += dy[b] * row_x
        lyx += wy[b] * slope_y
        lyy += dy[b] * row_y
    return lxx, lxy, lyx, lyy


@inlined
def scatter_momentum(values, i, wx, j, wy, momentum_x, momentum_y):
    """Add a point's momentum to its nodes: sum over points of w m v."""
    for b in range(len(wy)):
        for a in range(len(wx)):
            w = wy[b] * wx[a]
            values[j + b, i + a, 0] += w * momentum_x
            values[j + b, i + a, 1] += w * momentum_y


@inlined
def scatter_state(sums, i, wx, dx, j, wy, dy, mass, vx, vy, volume, stress):
    """Add a point's mass, momentum and internal force -V sigma grad w to its nodes."""
    for b in range(len(wy)):
        row_mass = wy[b] * mass
        along_xx, along_xy = -volume * stress.xx * wy[b], -volume * stress.xy * wy[b]
        across_xy, across_yy = -volume * stress.xy * dy[b], -volume * stress.yy * dy[b]
        for a in range(len(wx)):
            m = wx[a] * row_mass
            sums[j + b, i + a, MASS] += m
            sums[j + b, i + a, MOMENTUM_X] += m * vx
            sums[j + b, i + a, MOMENTUM_Y] += m * vy
            sums[j + b, i + a, FORCE_X] += dx[a] * along_xx + wx[a] * across_xy
            sums[j + b, i + a, FORCE_Y] += dx[a] * along_xy + wx[a] * across_yy


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


@kernel
def carry_points(points, law, history, axes, grid, filtered, blend, straining, dt):
    """Carry the points through the grid in one pass: grid to point, stress, point to grid.

    One pass instead of three, because a point's data then cross the memory once a step. It reads the velocities of the
    old positions from `grid.flow` and adds to `grid.sums`, which must be zero, at the new ones; with zero `flow` and
    `dt` it only adds.

    `filtered`, where given, is the velocity towards which a fraction `blend` of the point's velocity goes (FMPM);
    `straining`, where given, the velocity that strains the points, whose own is then already up to date (MUSL).

    Returns (kinetic energy [J/m], work of gravity per unit g [kg], work of stress [J/m], largest squared speed,
    first and last node column and row touched, index of a point that left the grid or -1).
    """
    kinetic = fall = work = fastest = 0.0
    i_first, i_last, j_first, j_last = grid.sums.shape[1], 0, grid.sums.shape[0], 0
    length, height = axes.x.cells / axes.x.inverse_cell, axes.y.cells / axes.y.inverse_cell
    for p in range(points.mass.size):
        x, y, mass = points.position.x[p], points.position.y[p], points.mass[p]
        vx, vy = points.velocity.x[p], points.velocity.y[p]
        i, wx, dx = weights(axes.x, x)
        j, wy, dy = weights(axes.y, y)
        move_x, move_y = gather_pair(grid.flow, i, wx, j, wy)
        if straining is None:
            gradient = gather_gradient(grid.flow, i, wx, dx, j, wy, dy)
            change_x, change_y = gather_change(grid.flow, i, wx, j, wy)
            vx, vy = vx + change_x, vy + change_y
            if filtered is not None:
                smooth_x, smooth_y = gather_pair(filtered, i, wx, j, wy)
                vx, vy = vx + blend * (smooth_x - vx), vy + blend * (smooth_y - vy)
            points.velocity.x[p], points.velocity.y[p] = vx, vy
        else:
            gradient = gather_gradient(straining, i, wx, dx, j, wy, dy)
        x, y = x + dt * move_x, y + dt * move_y
        if not (0.0 <= x <= length and 0.0 <= y <= height):
            return kinetic, fall, work, inf, i_first, i_last, j_first, j_last, p
        points.position.x[p], points.position.y[p] = x, y
        work += deform(points, p, law, history, gradient, dt)
        i, wx, dx = weights(axes.x, x)
        j, wy, dy = weights(axes.y, y)
        scatter_state(grid.sums, i, wx, dx, j, wy, dy, mass, vx, vy, points.volume[p], at(points.stress, p))
        i_first, i_last = min(i_first, i), max(i_last, i + len(wx) - 1)
        j_first, j_last = min(j_first, j), max(j_last, j + len(wy) - 1)
        speed = vx * vx + vy * vy
        kinetic += 0.5 * mass * speed
        fall -= mass * dt * move_y
        fastest = max(fastest, speed)
    return kinetic, fall, work, fastest, i_first, i_last, j_first, j_last, -1


@kernel
def project_twice(points, axes, grid):
    """Add to `grid.filtered` the momentum of the interpolated grid velocity: sum over points of w m (sum of w v)."""
    for p in range(points.mass.size):
        i, wx, _ = weights(axes.x, points.position.x[p])
        j, wy, _ = weights(axes.y, points.position.y[p])
        vx, vy = gather_pair(grid.flow, i, wx, j, wy)
        scatter_momentum(grid.filtered, i, wx, j, wy, points.mass[p] * vx, points.mass[p] * vy)


@kernel
def update_velocities(points, axes, grid, filtered, blend, momentum):
    """Update the points' velocities and add their momentum to `momentum` at the old positions (MUSL, first half)."""
    for p in range(points.mass.size):
        i, wx, _ = weights(axes.x, points.position.x[p])
        j, wy, _ = weights(axes.y, points.position.y[p])
        change_x, change_y = gather_change(grid.flow, i, wx, j, wy)
        vx, vy = points.velocity.x[p] + change_x, points.velocity.y[p] + change_y
        if filtered is not None:
            smooth_x, smooth_y = gather_pair(filtered, i, wx, j, wy)
            vx, vy = vx + blend * (smooth_x - vx), vy + blend * (smooth_y - vy)
        points.velocity.x[p], points.velocity.y[p] = vx, vy
        scatter_momentum(momentum, i, wx, j, wy, points.mass[p] * vx, points.mass[p] * vy)
