"""What one writes first: three loops, linear shapes, FLIP, stress last, nothing else. The yardstick of speed."""

import numpy as np

from rfmpm.kernel_tools import Tensor, at, kernel, put
from rfmpm.mpm.protocols import update_stress


@kernel
def to_nodes(points, inverse, nodes):
    """Mass, momentum and force of the nodes, columns 0 to 4 of `nodes` (rows, columns, 5)."""
    nodes[:] = 0.0
    for p in range(points.mass.size):
        s, t = points.position.x[p] * inverse, points.position.y[p] * inverse
        i, j = int(s), int(t)
        f, g = s - i, t - j
        mass, volume = points.mass[p], points.volume[p]
        vx, vy = points.velocity.x[p], points.velocity.y[p]
        sxx, syy, sxy = points.stress.xx[p], points.stress.yy[p], points.stress.xy[p]
        wx, wy, d = (1.0 - f, f), (1.0 - g, g), (-inverse, inverse)
        for b in range(2):
            for a in range(2):
                w, slope_x, slope_y = wx[a] * wy[b], d[a] * wy[b], wx[a] * d[b]
                nodes[j + b, i + a, 0] += w * mass
                nodes[j + b, i + a, 1] += w * mass * vx
                nodes[j + b, i + a, 2] += w * mass * vy
                nodes[j + b, i + a, 3] -= volume * (sxx * slope_x + sxy * slope_y)
                nodes[j + b, i + a, 4] -= volume * (sxy * slope_x + syy * slope_y)


@kernel
def on_nodes(nodes, gravity, dt):
    """Turn momentum into velocity and force into its change; the base holds, the left side slides."""
    rows, columns, _ = nodes.shape
    for j in range(rows):
        for i in range(columns):
            m = nodes[j, i, 0]
            if m > 0.0:
                old_x, old_y = nodes[j, i, 1] / m, nodes[j, i, 2] / m
                vx, vy = old_x + dt * nodes[j, i, 3] / m, old_y + dt * (nodes[j, i, 4] / m - gravity)
                if i == 0 or j == 0:
                    vx = 0.0
                if j == 0:
                    vy = 0.0
                nodes[j, i, 1], nodes[j, i, 2] = vx, vy
                nodes[j, i, 3], nodes[j, i, 4] = vx - old_x, vy - old_y


@kernel
def to_points(points, law, history, inverse, nodes, dt):
    """Velocity, position, and with the strain volume and stress."""
    for p in range(points.mass.size):
        s, t = points.position.x[p] * inverse, points.position.y[p] * inverse
        i, j = int(s), int(t)
        f, g = s - i, t - j
        vx = vy = ax = ay = lxx = lxy = lyx = lyy = 0.0
        wx, wy, d = (1.0 - f, f), (1.0 - g, g), (-inverse, inverse)
        for b in range(2):
            for a in range(2):
                w, slope_x, slope_y = wx[a] * wy[b], d[a] * wy[b], wx[a] * d[b]
                ux, uy = nodes[j + b, i + a, 1], nodes[j + b, i + a, 2]
                vx, vy = vx + w * ux, vy + w * uy
                ax, ay = ax + w * nodes[j + b, i + a, 3], ay + w * nodes[j + b, i + a, 4]
                lxx, lxy = lxx + slope_x * ux, lxy + slope_y * ux
                lyx, lyy = lyx + slope_x * uy, lyy + slope_y * uy
        points.velocity.x[p] += ax
        points.velocity.y[p] += ay
        points.position.x[p] += dt * vx
        points.position.y[p] += dt * vy
        xx, yy, half, spin = dt * lxx, dt * lyy, 0.5 * dt * (lxy + lyx), 0.5 * dt * (lyx - lxy)
        points.volume[p] *= (1.0 + xx) * (1.0 + yy) - dt * lxy * dt * lyx
        old = at(points.stress, p)
        turned = Tensor(
            old.xx - 2.0 * spin * old.xy, old.yy + 2.0 * spin * old.xy, old.zz, old.xy + spin * (old.xx - old.yy)
        )
        stress, past = update_stress(at(law, p), turned, Tensor(xx, yy, 0.0, half), at(history, p), dt)
        put(points.stress, p, stress)
        put(history, p, past)


@kernel
def three_loops(points, law, history, inverse, nodes, gravity, dt, steps):
    """Take so many steps of a fixed length [s]; points, history and nodes change in place."""
    for _ in range(steps):
        to_nodes(points, inverse, nodes)
        on_nodes(nodes, gravity, dt)
        to_points(points, law, history, inverse, nodes, dt)


def empty_nodes(rows: int, columns: int) -> np.ndarray:
    """Make the nodes of a grid of so many rows and columns of cells."""
    return np.zeros((rows + 1, columns + 1, 5))
