"""Transfer between points and grid: the sums over nodes and points that the material point method is made of.

Sulsky, Chen and Schreyer (1994), with the points strained by their updated velocities (Sulsky, Zhou and Schreyer 1995);
Nairn and Hammerquist (2021) for FMPM.
"""

from rfmpm.kernel_tools import BLOCK, by_range, gather, kernel, part, scatter
from rfmpm.mpm.cells import divide, share_dilatation, share_pressure, sum_dilatation, sum_pressure
from rfmpm.mpm.protocols import weights
from rfmpm.mpm.stages import (
    accelerate,
    add_momentum,
    collect,
    deform_range,
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
def update_velocities(points, axes, grid, filtered, blend, straining):
    """Update the points' velocities and add their momentum to the nodes of `straining`.

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
        add_momentum(block.mass, block.velocity, scratch, straining)


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
    tally, box = make_tally(), (0, -1, 0, -1)
    if cells is None:
        lost, box = carry_at_once(points, law, history, axes, grid.straining, grid.parts, grid.sums, dt, tally)
    else:
        cells.dilatation[:] = 0.0
        lost = move_points(points, axes, grid.straining, cells, cells.dilatation, dt, tally)
        if lost < 0:
            divide(cells.dilatation, cells.volume)
            cells.volume[:] = 0.0
            cells.pressure[:] = 0.0
            strain_points(points, law, history, axes, cells, cells.volume, cells.pressure, dt, tally)
            divide(cells.pressure, cells.volume)
            box = load_nodes(points, axes, cells, grid.parts, grid.sums)
    collect(grid.parts, grid.mass, box, axes)
    return tally.kinetic.sum(), tally.fall.sum(), tally.work.sum(), tally.plastic.sum(), tally.fastest.max(), box, lost


@kernel
def carry_at_once(points, law, history, axes, straining, parts, sums, dt, tally):
    """Move, strain and load in one pass. Returns the point that left the grid or -1, and the box of nodes touched."""
    scratch, box = make_scratch(axes), no_nodes(axes)
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        block = part(points, first, last)
        if grid_to_points(block, axes, straining, scratch, scratch.gradient, dt, tally):
            return first + first_outside(block, axes), box
        strain(block, part(law, first, last), part(history, first, last), scratch.gradient, dt, tally)
        box = points_to_grid(block, None, axes, parts, sums, scratch, box)
    return -1, whole(box, axes)


@kernel
def move_points(points, axes, straining, cells, sums, dt, tally):
    """Move the points and add their volumetric strain rates to the `sums` of their cells.

    Returns the point that left the grid or -1.
    """
    scratch = make_scratch(axes)
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        block, gradient = part(points, first, last), cells.gradient[4 * first : 4 * last]
        if grid_to_points(block, axes, straining, scratch, gradient, dt, tally):
            return first + first_outside(block, axes)
        sum_dilatation(block, sums, cells.of[first:last], gradient)
    return -1


@kernel
def strain_points(points, law, history, axes, cells, volumes, sums, dt, tally):
    """Strain the points with the mean dilatation of their cells, and add volumes and pressures to those they are in."""
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        block, gradient = part(points, first, last), cells.gradient[4 * first : 4 * last]
        share_dilatation(cells, cells.of[first:last], gradient)
        strain(block, part(law, first, last), part(history, first, last), gradient, dt, tally)
        sum_pressure(block, axes, volumes, sums, cells.of[first:last])


@kernel
def load_nodes(points, axes, cells, parts, sums):
    """Load the nodes by the points, with the mean pressure of their cells. Returns the box of nodes touched."""
    scratch, box = make_scratch(axes), no_nodes(axes)
    for first in range(0, points.mass.size, BLOCK):
        last = min(first + BLOCK, points.mass.size)
        block, change = part(points, first, last), cells.change[first:last]
        share_pressure(block.stress, cells, cells.of[first:last], change)
        box = points_to_grid(block, change, axes, parts, sums, scratch, box)
    return whole(box, axes)


@kernel
def no_nodes(axes):
    """An empty box of first nodes, to be extended."""
    return axes.x.cells + 1, 0, axes.y.cells + 1, 0


@kernel
def whole(box, axes):
    """The box of all nodes around points whose first nodes fill a box."""
    (_, across, _), (_, up, _) = weights(axes.x, 0.0), weights(axes.y, 0.0)
    return box[0], box[1] + len(across) - 1, box[2], box[3] + len(up) - 1


@kernel
def place(points, axes, scratch):
    """Find nodes, weights and slopes of a block."""
    locate(axes.x, points.position.x, scratch.x)
    locate(axes.y, points.position.y, scratch.y)


@kernel
def grid_to_points(points, axes, straining, scratch, gradient, dt, tally):
    """Velocity gradient and position of a block. Returns how many points are no longer within the grid."""
    place(points, axes, scratch)
    interpolate_slopes(straining, scratch, points.mass.size, gradient)
    return move(points, axes, scratch.motion, dt, tally)


@kernel
def strain(points, law, history, gradient, dt, tally):
    """Turn the stresses of a block with the body and strain its points."""
    rotate(points.stress, gradient, dt)
    by_range(deform_range, (law, history), points.mass.size, (points, gradient, dt, tally))


@kernel
def points_to_grid(points, pressure, axes, parts, sums, scratch, box):
    """Mass, momentum and internal force of a block at its new positions. Returns the box of first nodes so far.

    `pressure`, where given, is added to the points' in-plane mean stress in the force [Pa].
    """
    place(points, axes, scratch)
    load(points, pressure, scratch)
    spread(points.mass, scratch, parts, sums)
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
def project_twice(points, axes, grid, filtered):
    """Add to `filtered` the momentum of the interpolated grid velocity: sum over points of w m (sum of w v)."""
    scratch = make_scratch(axes)
    for first in range(0, points.mass.size, BLOCK):
        block = part(points, first, min(first + BLOCK, points.mass.size))
        place(block, axes, scratch)
        for p in range(block.mass.size):
            m = block.mass[p]
            flow = gather(grid.flow, scratch.x, scratch.y, p)
            scatter(filtered, scratch.x, scratch.y, p, (m * flow[X], m * flow[Y], 0.0, 0.0))
