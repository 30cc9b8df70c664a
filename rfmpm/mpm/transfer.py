"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994), with the points strained by their updated velocities (Sulsky, Zhou and Schreyer 1995);
Nairn and Hammerquist (2021) for FMPM.
"""

from rfmpm.kernel_tools import BLOCK, gather, kernel, part, scatter
from rfmpm.mpm.cells import divide, share_dilatation, share_pressure, sum_dilatation, sum_pressure
from rfmpm.mpm.stages import (
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
from rfmpm.mpm.state import X, Y


@kernel
def update_velocities(points, axes, grid, filtered, blend):
    """Update the points' velocities and add their momentum to `grid.straining`, which must be zero.

    `filtered`, where given, is the velocity towards which a fraction `blend` of the point's velocity goes (FMPM).
    """
    scratch = make_scratch(axes)
    for first in range(0, points.mass.size, BLOCK):
        block = part(points, first, min(first + BLOCK, points.mass.size))
        place(block, axes, scratch)
        interpolate(grid.flow, scratch, block.mass.size, scratch.motion)
        if filtered is not None:
            interpolate(filtered, scratch, block.mass.size, scratch.smooth)
            accelerate(block.velocity, scratch.motion, scratch.smooth, blend)
        else:
            accelerate(block.velocity, scratch.motion, None, blend)
        add_momentum(block.mass, block.velocity, scratch, grid.straining)


@kernel
def carry_points(points, law, history, axes, grid, cells, dt):
    """Move and strain the points by `grid.straining`, update their stresses, and take them to the grid.

    It reads the velocities of the old positions and adds to `grid.parts` and `grid.sums`, which must be zero, at the
    new ones; with zero velocity and `dt` it only adds. Without `cells` it is one pass over the points, a block at a
    time, so that a point's data cross the memory once; with them (means over the points of a cell), the sums over all
    points before the stress and before the force make it three.

    Returns (kinetic energy [J/m], sum of mass times fall [kg m/m], work of stress and its plastic part [J/m], largest
    squared speed, box of nodes touched, index of a point that left the grid or -1).
    """
    box = grid.mass.shape[1], 0, grid.mass.shape[0], 0
    scratch, tally, lost, count = make_scratch(axes), make_tally(), -1, points.mass.size
    if cells is None:
        for first in range(0, count, BLOCK):
            last = min(first + BLOCK, count)
            block = part(points, first, last)
            if grid_to_points(block, axes, grid, scratch, scratch.gradient, dt, tally):
                lost = first + first_outside(block, axes)
                break
            strain(block, part(law, first, last), part(history, first, last), scratch.gradient, dt, tally)
            box = points_to_grid(block, None, axes, grid, scratch, box)
    else:
        lost, box = carry_by_cells(points, law, history, axes, grid, cells, dt, scratch, tally, box)
    width = len(scratch.x.like)
    box = box[0], box[1] + width - 1, box[2], box[3] + len(scratch.y.like) - 1
    collect(grid.parts, grid.mass, box, width)
    return tally.kinetic.sum(), tally.fall.sum(), tally.work.sum(), tally.plastic.sum(), tally.fastest.max(), box, lost


@kernel
def carry_by_cells(points, law, history, axes, grid, cells, dt, scratch, tally, box):
    """The same with means over the points of each cell. Returns the point that left the grid or -1, and the box."""
    count = points.mass.size
    cells.dilatation[:] = 0.0
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        block, gradient = part(points, first, last), cells.gradient[4 * first : 4 * last]
        if grid_to_points(block, axes, grid, scratch, gradient, dt, tally):
            return first + first_outside(block, axes), box
        sum_dilatation(block, cells, cells.of[first:last], gradient)
    divide(cells.dilatation, cells.volume)
    cells.volume[:] = 0.0
    cells.pressure[:] = 0.0
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        block, gradient = part(points, first, last), cells.gradient[4 * first : 4 * last]
        share_dilatation(cells, cells.of[first:last], gradient)
        strain(block, part(law, first, last), part(history, first, last), gradient, dt, tally)
        sum_pressure(block, axes, cells, cells.of[first:last])
    divide(cells.pressure, cells.volume)
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        block, change = part(points, first, last), cells.change[first:last]
        share_pressure(block.stress, cells, cells.of[first:last], change)
        box = points_to_grid(block, change, axes, grid, scratch, box)
    return -1, box


@kernel
def place(points, axes, scratch):
    """Find nodes, weights and slopes of a block."""
    locate(axes.x, points.position.x, scratch.x)
    locate(axes.y, points.position.y, scratch.y)


@kernel
def grid_to_points(points, axes, grid, scratch, gradient, dt, tally):
    """Velocity gradient and position of a block. Returns how many points are no longer within the grid."""
    place(points, axes, scratch)
    interpolate_slopes(grid.straining, scratch, points.mass.size, gradient)
    return move(points, axes, scratch.motion, dt, tally)


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
    place(points, axes, scratch)
    load(points, pressure, scratch)
    spread(points.mass, scratch, grid)
    return extend(box, scratch, points.mass.size)


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
        place(block, axes, scratch)
        for p in range(block.mass.size):
            m = block.mass[p]
            flow = gather(grid.flow, scratch.x, scratch.y, p)
            scatter(grid.filtered, scratch.x, scratch.y, p, (m * flow[X], m * flow[Y], 0.0, 0.0))
