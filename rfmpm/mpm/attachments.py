"""What acts on a body from outside the grid's walls: a load on its surface, and obstacles in its way."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.protocols import weights
from rfmpm.mpm.state import CHANGE_X, CHANGE_Y, FORCE_Y, X, Y


class Load(NamedTuple):
    """A force downwards on some points, without inertia; they carry it wherever they go."""

    point: np.ndarray  # (k,) numbers of the points
    force: np.ndarray  # (k,) [N/m]
    height: np.ndarray  # (k,) of the points when the work was last counted [m]


class Obstacle(NamedTuple):
    """Nodes into which nothing moves, with Coulomb friction along the nearest face."""

    row: np.ndarray  # (k,)
    column: np.ndarray  # (k,)
    normal_x: np.ndarray  # (k,) of that face, outwards [-]
    normal_y: np.ndarray  # (k,)
    friction: np.ndarray  # (k,) coefficient [-]
    impulse: np.ndarray  # (2,) that the obstacle has taken so far, x and y [N s/m]


@kernel
def press(points, load, axes, grid):
    """Add the load to the force on the nodes. Returns its work since the last time [J/m]."""
    work = 0.0
    for k in range(load.point.size):
        p, force = load.point[k], load.force[k]
        y = points.position.y[p]
        column, across, _ = weights(axes.x, points.position.x[p])
        row, up, _ = weights(axes.y, y)
        for b in range(len(up)):
            for a in range(len(across)):
                grid.sums[row + b, column + a, FORCE_Y] -= force * across[a] * up[b]
        work += force * (load.height[k] - y)
        load.height[k] = y
    return work


@kernel
def hold_off(obstacle, grid, box):
    """Stop what moves into the obstacle; oppose what slides along it by at most friction times the impulse of that."""
    for k in range(obstacle.row.size):
        row, column = obstacle.row[k], obstacle.column[k]
        if not (box[0] <= column <= box[1] and box[2] <= row <= box[3]):
            continue
        nx, ny, m = obstacle.normal_x[k], obstacle.normal_y[k], grid.mass[row, column]
        vx, vy = grid.flow[row, column, X], grid.flow[row, column, Y]
        inward = vx * nx + vy * ny
        if inward < 0.0:
            along, hold = vy * nx - vx * ny, -obstacle.friction[k] * inward
            along = max(along - hold, 0.0) if along > 0.0 else min(along + hold, 0.0)
            after_x, after_y = -along * ny, along * nx
            grid.flow[row, column, X], grid.flow[row, column, Y] = after_x, after_y
            grid.flow[row, column, CHANGE_X] += after_x - vx
            grid.flow[row, column, CHANGE_Y] += after_y - vy
            obstacle.impulse[0] += m * (vx - after_x)
            obstacle.impulse[1] += m * (vy - after_y)
