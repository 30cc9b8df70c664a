"""What happens on the nodes."""

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.solvers.grid import apply_walls


@kernel
def solve(nodes, walls, gravity, dt):
    """m dv/dt = f - m g, within what the walls allow; the change starts from the velocity that was mapped."""
    rows, columns = nodes.mass.shape
    for row in range(rows):
        for column in range(columns):
            m, vx, vy = nodes.mass[row, column], 0.0, 0.0
            mapped_x = mapped_y = 0.0
            if m > 0.0:
                mapped_x, mapped_y = nodes.momentum.x[row, column] / m, nodes.momentum.y[row, column] / m
                push_x = dt * nodes.force.x[row, column] / m
                push_y = dt * (nodes.force.y[row, column] / m - gravity)
                vx, vy = mapped_x + push_x, mapped_y + push_y
                if row == 0 or column == 0 or column == columns - 1:
                    _, _, vx, vy = apply_walls(walls, mapped_x, mapped_y, push_x, push_y, row, column, columns - 1)
            nodes.velocity.x[row, column], nodes.velocity.y[row, column] = vx, vy
            nodes.change.x[row, column], nodes.change.y[row, column] = vx - mapped_x, vy - mapped_y


@kernel
def divide(velocity, mass, momentum):
    """v = (m v) / m."""
    rows, columns = mass.shape
    for row in range(rows):
        for column in range(columns):
            m = mass[row, column]
            velocity.x[row, column] = momentum.x[row, column] / m if m > 0.0 else 0.0
            velocity.y[row, column] = momentum.y[row, column] / m if m > 0.0 else 0.0


@kernel
def hold(velocity, walls):
    """What walls do to a velocity that nothing pushes."""
    rows, columns = velocity.x.shape
    for row in range(rows):
        for column in range(columns):
            if row == 0 or column == 0 or column == columns - 1:
                vx, vy = velocity.x[row, column], velocity.y[row, column]
                _, _, vx, vy = apply_walls(walls, vx, vy, 0.0, 0.0, row, column, columns - 1)
                velocity.x[row, column], velocity.y[row, column] = vx, vy


@kernel
def hold_where_held(velocity, held):
    """Components that are zero in `held` become zero."""
    rows, columns = velocity.x.shape
    for row in range(rows):
        for column in range(columns):
            if held.x[row, column] == 0.0:
                velocity.x[row, column] = 0.0
            if held.y[row, column] == 0.0:
                velocity.y[row, column] = 0.0


@kernel
def mix(velocity, other, share):
    """v <- (1 - share) v + share other."""
    rows, columns = velocity.x.shape
    for row in range(rows):
        for column in range(columns):
            velocity.x[row, column] += share * (other.x[row, column] - velocity.x[row, column])
            velocity.y[row, column] += share * (other.y[row, column] - velocity.y[row, column])


@kernel
def add_term(nodes):
    """Next term of FMPM's series, and its sum: t <- t - S+ S t,  v* <- v* + t; not on walls, whose own v+ stays."""
    rows, columns = nodes.mass.shape
    for row in range(rows):
        for column in range(columns):
            m = nodes.mass[row, column]
            if m > 0.0 and row > 0 and 0 < column < columns - 1:
                nodes.term.x[row, column] -= nodes.projected.x[row, column] / m
                nodes.term.y[row, column] -= nodes.projected.y[row, column] / m
                nodes.filtered.x[row, column] += nodes.term.x[row, column]
                nodes.filtered.y[row, column] += nodes.term.y[row, column]
            else:
                nodes.term.x[row, column] = nodes.term.y[row, column] = 0.0


@kernel
def copy(vector, source):
    """Copy both components."""
    rows, columns = vector.x.shape
    for row in range(rows):
        for column in range(columns):
            vector.x[row, column], vector.y[row, column] = source.x[row, column], source.y[row, column]


@kernel
def clear(vector):
    """Set both components to zero."""
    rows, columns = vector.x.shape
    for row in range(rows):
        for column in range(columns):
            vector.x[row, column] = vector.y[row, column] = 0.0
