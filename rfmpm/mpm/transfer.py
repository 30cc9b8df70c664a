"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994) for the scheme, Nairn and Hammerquist (2021) for FMPM.
"""

from rfmpm.kernel_tools import BLOCK, gather, kernel, part, scatter
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
from rfmpm.mpm.state import CHANGE_X, X, Y


@kernel
def carry_points(points, law, history, axes, grid, filtered, blend, straining, dt):
    """Carry the points through the grid: grid to point, stress, point to grid.

    One pass over the points, a block at a time, so that a point's data cross the memory once a step. It reads the
    velocities of the old positions from `grid.flow` and adds to `grid.mass` and `grid.sums`, which must be zero, at the
    new ones; with zero `flow` and `dt` it only adds.

    `filtered`, where given, is the velocity towards which a fraction `blend` of the point's velocity goes (FMPM);
    `straining`, where given, the velocity that strains the points, whose own is then already up to date (MUSL), beside
    the one that moves them.

    Returns (kinetic energy [J/m], sum of mass times fall [kg m/m], work of stress [J/m], largest squared speed, box of
    nodes touched, index of a point that left the grid or -1).
    """
    box = grid.mass.shape[1], 0, grid.mass.shape[0], 0
    scratch, tally, lost = make_scratch(axes), make_tally(), -1
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        count, block = last - first, part(points, first, last)
        locate(axes.x, block.position.x, scratch.x)
        locate(axes.y, block.position.y, scratch.y)
        lane = X
        if straining is None:
            interpolate_slopes(grid.flow, scratch, count)
            if filtered is not None:
                interpolate(filtered, scratch, count, scratch.smooth)
                accelerate(block.velocity, scratch.motion, scratch.smooth, blend)
            else:
                accelerate(block.velocity, scratch.motion, None, blend)
        else:
            interpolate_slopes(straining, scratch, count)
            lane = CHANGE_X
        if move(block, axes, scratch.motion, lane, dt, tally):
            lost = first + first_outside(block, axes)
            break
        rotate(block.stress, scratch.gradient, dt)
        deform(block, part(law, first, last), part(history, first, last), scratch.gradient, dt, tally)
        locate(axes.x, block.position.x, scratch.x)
        locate(axes.y, block.position.y, scratch.y)
        load(block, scratch)
        spread(block.mass, scratch, grid)
        box = extend(box, scratch, count)
    width = len(scratch.x.like)
    box = box[0], box[1] + width - 1, box[2], box[3] + len(scratch.y.like) - 1
    collect(grid.parts, grid.mass, box, width)
    return tally.kinetic.sum(), tally.fall.sum(), tally.work.sum(), tally.fastest.max(), box, lost


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
