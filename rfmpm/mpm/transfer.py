"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994) for the scheme, Nairn and Hammerquist (2021) for FMPM.
"""

from rfmpm.kernel_tools import BLOCK, gather, kernel, part, scatter
from rfmpm.mpm.cells import (
    divide,
    share_dilatation,
    share_pressure,
    sum_dilatation,
    sum_pressure,
)
from rfmpm.mpm.stages import (
    Scratch,
    accelerate,
    add_momentum,
    collect,
    deform,
    extend,
    interpolate,
    interpolate_slopes,
    load,
    locate,
    make_scratch,
    make_tally,
    move,
    rotate,
    spread,
)
from rfmpm.mpm.state import CHANGE_X, X, Y


@kernel
def carry_points(points, law, history, axes, grid, cells, filtered, blend, straining, dt):
    """Carry the points through the grid: grid to point, stress, point to grid.

    It reads the velocities of the old positions from `grid.flow` and adds to `grid.parts` and `grid.sums`, which must
    be zero, at the new ones; with zero `flow` and `dt` it only adds. Without `cells` it is one pass over the points, a
    block at a time, so that a point's data cross the memory once a step; with them (means over the points of a cell),
    the sums over all points before the stress and before the force make it three.

    `filtered`, where given, is the velocity towards which a fraction `blend` of the point's velocity goes (FMPM);
    `straining`, where given, the velocity that strains the points, whose own is then already up to date (MUSL), beside
    the one that moves them.

    Returns (kinetic energy [J/m], sum of mass times fall [kg m/m], work of stress and its plastic part [J/m], largest
    squared speed, box of nodes touched, index of a point that left the grid or -1).
    """
    box = grid.mass.shape[1], 0, grid.mass.shape[0], 0
    scratch, tally, lost, count = make_scratch(axes), make_tally(), -1, points.mass.size
    if cells is None:
        for first in range(0, count, BLOCK):
            last = min(first + BLOCK, count)
            block = part(points, first, last)
            if grid_to_points(block, axes, grid, scratch, filtered, blend, straining, dt, tally):
                lost = first + first_outside(block, axes)
                break
            strain(block, part(law, first, last), part(history, first, last), scratch.gradient, dt, tally)
            box = points_to_grid(block, None, axes, grid, scratch, box)
    else:
        lost, box = carry_by_cells(
            points, law, history, axes, grid, cells, filtered, blend, straining, dt, scratch, tally, box
        )
    width = len(scratch.x.like)
    box = box[0], box[1] + width - 1, box[2], box[3] + len(scratch.y.like) - 1
    collect(grid.parts, grid.mass, box, width)
    return tally.kinetic.sum(), tally.fall.sum(), tally.work.sum(), tally.plastic.sum(), tally.fastest.max(), box, lost


@kernel
def carry_by_cells(points, law, history, axes, grid, cells, filtered, blend, straining, dt, scratch, tally, box):
    """Carry the points with means over those of a cell. Returns the point that left the grid or -1, and the box."""
    count = points.mass.size
    cells.sums[:] = 0.0
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        block, own = part(points, first, last), keep_gradient(scratch, cells.gradient[4 * first : 4 * last])
        if grid_to_points(block, axes, grid, own, filtered, blend, straining, dt, tally):
            return first + first_outside(block, axes), box
        sum_dilatation(points, cells, first, last)
    divide(cells)
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        share_dilatation(cells, first, last)
        gradient = cells.gradient[4 * first : 4 * last]
        strain(part(points, first, last), part(law, first, last), part(history, first, last), gradient, dt, tally)
    cells.sums[:] = 0.0
    cells.volume[:] = 0.0
    sum_pressure(points, axes, cells, 0, count)
    divide(cells)
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        share_pressure(points.stress, cells, first, last)
        box = points_to_grid(part(points, first, last), cells.change[first:last], axes, grid, scratch, box)
    return -1, box


@kernel
def grid_to_points(points, axes, grid, scratch, filtered, blend, straining, dt, tally):
    """Velocity gradient, velocity and position of a block. Returns how many points are no longer within the grid."""
    count = points.mass.size
    locate(axes.x, points.position.x, scratch.x)
    locate(axes.y, points.position.y, scratch.y)
    lane = X
    if straining is None:
        interpolate_slopes(grid.flow, scratch, count)
        if filtered is not None:
            interpolate(filtered, scratch, count, scratch.smooth)
            accelerate(points.velocity, scratch.motion, scratch.smooth, blend)
        else:
            accelerate(points.velocity, scratch.motion, None, blend)
    else:
        interpolate_slopes(straining, scratch, count)
        lane = CHANGE_X
    return move(points, axes, scratch.motion, lane, dt, tally)


@kernel
def strain(points, law, history, gradient, dt, tally):
    """Turn the stresses of a block with the body and strain its points."""
    rotate(points.stress, gradient, dt)
    deform(points, law, history, gradient, dt, tally)


@kernel
def points_to_grid(points, pressure, axes, grid, scratch, box):
    """Mass, momentum and internal force of a block at its new positions. Returns the box of first nodes so far.

    `pressure`, where given, is added to the points' in-plane mean stress in the force [Pa].
    """
    locate(axes.x, points.position.x, scratch.x)
    locate(axes.y, points.position.y, scratch.y)
    load(points, pressure, scratch)
    spread(points.mass, scratch, grid)
    return extend(box, scratch, points.mass.size)


@kernel
def keep_gradient(scratch, gradient):
    """The same room, but for a place elsewhere for the velocity gradient."""
    return Scratch(scratch.x, scratch.y, scratch.motion, scratch.smooth, gradient)


@kernel
def first_outside(points, axes):
    """Index of the first point that is not within the grid."""
    length, height = axes.x.cells / axes.x.inverse_cell, axes.y.cells / axes.y.inverse_cell
    for p in range(points.mass.size):
        if not (0.0 <= points.position.x[p] <= length and 0.0 <= points.position.y[p] <= height):
            return p
    return -1


@kernel
def project_twice(points, axes, grid):
    """Add to `grid.filtered` the momentum of the interpolated grid velocity: sum over points of w m (sum of w v)."""
    scratch = make_scratch(axes)
    for first in range(0, points.mass.size, BLOCK):
        block = part(points, first, min(first + BLOCK, points.mass.size))
        locate(axes.x, block.position.x, scratch.x)
        locate(axes.y, block.position.y, scratch.y)
        for p in range(block.mass.size):
            m = block.mass[p]
            flow = gather(grid.flow, scratch.x, scratch.y, p)
            scatter(grid.filtered, scratch.x, scratch.y, p, (m * flow[X], m * flow[Y], 0.0, 0.0))


@kernel
def update_velocities(points, axes, grid, filtered, blend):
    """Update the points' velocities and add their momentum to `grid.straining` at the old positions (MUSL)."""
    scratch = make_scratch(axes)
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        block = part(points, first, last)
        locate(axes.x, block.position.x, scratch.x)
        locate(axes.y, block.position.y, scratch.y)
        interpolate(grid.flow, scratch, last - first, scratch.motion)
        if filtered is not None:
            interpolate(filtered, scratch, last - first, scratch.smooth)
            accelerate(block.velocity, scratch.motion, scratch.smooth, blend)
        else:
            accelerate(block.velocity, scratch.motion, None, blend)
        add_momentum(block.mass, block.velocity, scratch, grid.straining)
