"""What happens on the nodes within a step: momentum equation, walls, and the filtered and straining velocities."""

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.protocols import constrain
from rfmpm.mpm.state import CHANGE_X, CHANGE_Y, FORCE_X, FORCE_Y, MOVING_X, X, Y


@kernel
def apply_walls(walls, vx, vy, push_x, push_y, row, column, last_column):
    """Velocity of a wall's node before and after the step, (x, y, x, y), from the one before and its trial change.

    The velocity before is constrained too: what the lumped projection puts on a wall moves nothing and does no work.
    """
    after_x, after_y = vx + push_x, vy + push_y
    if column == 0:
        vx, vy, after_x, after_y = constrain(walls.sides, vx, vy, push_x, push_y)
    elif column == last_column:
        vx, vy, after_x, after_y = constrain(walls.sides, -vx, vy, -push_x, push_y)
        vx, after_x = -vx, -after_x
    if row == 0:
        vy, vx, after_y, after_x = constrain(walls.base, vy, vx, after_y - vy, after_x - vx)
    return vx, vy, after_x, after_y


@kernel
def inertia(grid, row, column, last_column, share):
    """Factor by which a node beside a wall is slowed down, at most 1.

    Within half a cell of a wall the hat of the node beside it holds next to no mass where the body is thin, but all of
    its stiffness k^2 V M: at a share s of the mass of both nodes it swings at c k / sqrt(s), too fast for any step.
    Below the share that the step resolves its inertia is that share of the mass of both.
    """
    m, factor = grid.mass[row, column], 1.0
    if row == 1:
        factor = min(factor, m / (share * (m + grid.mass[0, column])))
    if column == 1:
        factor = min(factor, m / (share * (m + grid.mass[row, 0])))
    elif column == last_column - 1:
        factor = min(factor, m / (share * (m + grid.mass[row, last_column])))
    return factor


@kernel
def update_grid(grid, walls, box, gravity, damping, dt, share):
    """Solve m dv/dt = f - m g - damping m v on the touched nodes, within what the walls allow.

    The change of velocity that goes back to the points includes what the walls took of the mapped momentum. What they
    took of the step's own momentum is left in their nodes' `grid.sums`. `share`: of the mass at a wall, see `inertia`.
    """
    lost = 1.0 - 1.0 / (1.0 + damping * dt)
    last_column = grid.mass.shape[1] - 1
    for row in range(box[2], box[3] + 1):
        for column in range(box[0], box[1] + 1):
            m = grid.mass[row, column]
            mapped_x = mapped_y = vx = vy = 0.0
            if m > 0.0:
                inverse = 1.0 / m
                mapped_x, mapped_y = grid.sums[row, column, X] * inverse, grid.sums[row, column, Y] * inverse
                pace = dt
                if row == 1 or column == 1 or column == last_column - 1:
                    pace *= inertia(grid, row, column, last_column, share)
                push_x = pace * grid.sums[row, column, FORCE_X] * inverse
                push_y = pace * (grid.sums[row, column, FORCE_Y] * inverse - gravity)
                push_x, push_y = push_x - lost * (mapped_x + push_x), push_y - lost * (mapped_y + push_y)
                old_x, old_y, vx, vy = mapped_x, mapped_y, mapped_x + push_x, mapped_y + push_y
                if row == 0 or column == 0 or column == last_column:
                    old_x, old_y, vx, vy = apply_walls(walls, old_x, old_y, push_x, push_y, row, column, last_column)
                    grid.sums[row, column, X] = m * (old_x + push_x - vx)
                    grid.sums[row, column, Y] = m * (old_y + push_y - vy)
            grid.flow[row, column, X], grid.flow[row, column, Y] = vx, vy
            grid.flow[row, column, CHANGE_X], grid.flow[row, column, CHANGE_Y] = vx - mapped_x, vy - mapped_y


@kernel
def subtract_second_projection(grid, box):
    """Turn `grid.filtered` from the momentum of the second projection into the velocity of FMPM(2).

    v = 2 v+ - S+ S v+ (Nairn and Hammerquist 2021, eq. 27 with two terms); a wall's own nodes keep v+, which meets the
    wall's condition.
    """
    last_column = grid.mass.shape[1] - 1
    for row in range(box[2], box[3] + 1):
        for column in range(box[0], box[1] + 1):
            m = grid.mass[row, column]
            vx, vy = grid.flow[row, column, X], grid.flow[row, column, Y]
            if m > 0.0 and row > 0 and 0 < column < last_column:
                inverse = 1.0 / m
                vx = 2.0 * vx - grid.filtered[row, column, X] * inverse
                vy = 2.0 * vy - grid.filtered[row, column, Y] * inverse
            grid.filtered[row, column, X], grid.filtered[row, column, Y] = vx, vy


@kernel
def mix_straining(grid, box, own_share):
    """Turn `grid.straining` from the momentum of the updated points into the velocity that strains them.

    That is the velocity of this momentum, and a share of the grid's own, whose noise the strain then answers at once
    and damps; what a wall holds stays held.

    The grid's own velocity goes beside it, so that the points read both at once.

    Returns the work that the walls take from the points [J/m]: the momentum they took, times the mean of the points'
    velocity before and after. The node's own velocity would not do: with a shape whose slope does not vanish with its
    weight, a node of next to no mass is as good as infinitely fast, and no point follows it.
    """
    friction, last_column = 0.0, grid.mass.shape[1] - 1
    for row in range(box[2], box[3] + 1):
        for column in range(box[0], box[1] + 1):
            m, at_wall = grid.mass[row, column], row == 0 or column == 0 or column == last_column
            for k in range(2):
                v, mapped = grid.flow[row, column, k], 0.0
                if m > 0.0 and v != 0.0:
                    mapped = grid.straining[row, column, k] / m
                    if at_wall:
                        before = v - grid.flow[row, column, CHANGE_X + k]
                        friction += 0.5 * grid.sums[row, column, k] * (before + mapped)
                grid.straining[row, column, k] = mapped + own_share * (v - mapped)
                grid.straining[row, column, MOVING_X + k] = v
    return friction


@kernel
def clear(values, box):
    """Set the touched nodes of an array (rows, columns, ...) to zero."""
    values[box[2] : box[3] + 1, box[0] : box[1] + 1] = 0.0
