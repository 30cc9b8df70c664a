"""One share of each pass of a step, for a thread of a team."""

from rfmpm.kernel_tools import kernel, part
from rfmpm.mpm.cells import Cells, divide
from rfmpm.mpm.nonlocal_softening import convolve_columns, convolve_rows, share_strain, sum_strain, widen
from rfmpm.mpm.solvers.grid import mix_straining, subtract_second_projection, update_grid
from rfmpm.mpm.stages import collect, make_tally
from rfmpm.mpm.transfer import carry_at_once, load_nodes, move_points, project_twice, strain_points, update_velocities

KINETIC, FALL, WORK, PLASTIC, FASTEST, FRICTION = range(6)


@kernel
def share_of(count, rank, size):
    """First and one after the last of one share of so many things."""
    return count * rank // size, count * (rank + 1) // size


@kernel
def own_rows(box, rank, team):
    """Part of a box whose rows are one share of its."""
    first, end = share_of(box[3] - box[2] + 1, rank, len(team.lost))
    return box[0], box[1], box[2] + first, box[2] + end - 1


@kernel
def own_part(record, points, rank, team):
    """What a record holds of one share of the points."""
    first, end = share_of(points.mass.size, rank, len(team.lost))
    return part(record, first, end)


@kernel
def cells_of(cells, points, rank, team):
    """The cells as one share of the points sees them."""
    first, end = share_of(points.mass.size, rank, len(team.lost))
    of, gradient, change = cells.of[first:end], cells.gradient[4 * first : 4 * end], cells.change[first:end]
    return Cells(of, gradient, change, cells.volume, cells.dilatation, cells.pressure)


@kernel
def note_lost(rank, lost, points, team):
    """Note the point that left the grid by its number among all."""
    team.lost[rank] = lost if lost < 0 else share_of(points.mass.size, rank, len(team.lost))[0] + lost


@kernel
def put_box(team, rank, box):
    """Note the nodes that one share of the points touches."""
    for k in range(len(box)):
        team.boxes[rank, k] = box[k]


@kernel
def note_motion(rank, tally, team):
    """Note the sums over the points that are known when they have moved."""
    team.found[rank, KINETIC], team.found[rank, FALL] = tally.kinetic.sum(), tally.fall.sum()
    team.found[rank, FASTEST] = tally.fastest.max()


@kernel
def note_work(rank, tally, team):
    """Note those that are known when they have been strained."""
    team.found[rank, WORK], team.found[rank, PLASTIC] = tally.work.sum(), tally.plastic.sum()


@kernel
def gather_rows(stack, boxes, total, box):
    """Sum into `total` what all have added, for the nodes of a box; their own is zero afterwards.

    Args:
        stack: shape (shares, rows, columns, 4).
        boxes: nodes that each share has added to.
        total: shape (rows, columns, 4).
        box: first and last column and row of the nodes to sum.
    """
    left, right = box[0], box[1] + 1
    for row in range(box[2], box[3] + 1):
        is_new = True
        for rank in range(len(stack)):
            first, end = boxes[rank, 0], boxes[rank, 1] + 1
            if boxes[rank, 2] <= row <= boxes[rank, 3]:
                if is_new:
                    total[row, left:first] = 0.0
                    total[row, end:right] = 0.0
                take(stack[rank, row, first:end].reshape(-1), total[row, first:end].reshape(-1), is_new)
                is_new = False
        if is_new:
            total[row, left:right] = 0.0


@kernel
def take(own, total, is_new):
    """Move numbers to what they replace or are added to."""
    if is_new:
        for k in range(own.size):
            total[k] = own[k]
            own[k] = 0.0
    else:
        for k in range(own.size):
            total[k] += own[k]
            own[k] = 0.0


@kernel
def gather_cells(stack, ranges, total, rank):
    """Sum into `total` what all have added to one share of the cells; their own is zero afterwards.

    `ranges`: first and last cell that each share of the points has added to. Returns first and one after the last of
    the share of the cells.
    """
    lowest = ranges[:, 0].min()
    first, end = share_of(ranges[:, 1].max() + 1 - lowest, rank, len(stack))
    first, end = lowest + first, lowest + end
    total[first:end] = 0.0
    for other in range(len(stack)):
        low, high = max(first, ranges[other, 0]), min(end, ranges[other, 1] + 1)
        take(stack[other, low:high], total[low:high], False)
    return first, end


@kernel
def update_rows(rank, grid, walls, box, gravity, damping, dt, share, team):
    """Momentum equation on one share of the rows."""
    update_grid(grid, walls, own_rows(box, rank, team), gravity, damping, dt, share)


@kernel
def project_some(rank, points, axes, grid, team):
    """Second projection of one share of the points."""
    project_twice(own_part(points, points, rank, team), axes, grid, team.values[rank])


@kernel
def filter_rows(rank, grid, box, team):
    """Filtered velocity on one share of the rows."""
    own = own_rows(box, rank, team)
    gather_rows(team.values, team.boxes, grid.filtered, own)
    subtract_second_projection(grid, own)


@kernel
def update_some(rank, points, axes, grid, filtered, blend, team):
    """Velocities and momentum of one share of the points."""
    update_velocities(own_part(points, points, rank, team), axes, grid, filtered, blend, team.values[rank])


@kernel
def mix_rows(rank, grid, box, own_share, team):
    """Straining velocity on one share of the rows, and the work of its walls."""
    own = own_rows(box, rank, team)
    gather_rows(team.values, team.boxes, grid.straining, own)
    team.found[rank, FRICTION] = mix_straining(grid, own, own_share)


@kernel
def carry_some(rank, points, law, history, axes, grid, dt, team):
    """Motion, stress and load of one share of the points."""
    tally = make_tally()
    own, own_law, own_history = (
        own_part(points, points, rank, team), own_part(law, points, rank, team), own_part(history, points, rank, team),
    )  # fmt: skip
    lost, box = carry_at_once(
        own, own_law, own_history, axes, grid.straining, team.parts[rank], team.values[rank], dt, tally
    )
    note_lost(rank, lost, points, team)
    put_box(team, rank, box)
    note_motion(rank, tally, team)
    note_work(rank, tally, team)


@kernel
def move_some(rank, points, axes, grid, cells, dt, team):
    """Motion of one share of the points."""
    tally = make_tally()
    own, own_cells = own_part(points, points, rank, team), cells_of(cells, points, rank, team)
    lost = move_points(own, axes, grid.straining, own_cells, team.contents[rank], dt, tally)
    note_lost(rank, lost, points, team)
    note_motion(rank, tally, team)


@kernel
def mean_dilatation(rank, cells, team):
    """Mean volumetric strain rate of one share of the cells."""
    first, end = gather_cells(team.contents, team.ranges, cells.dilatation, rank)
    divide(cells.dilatation[first:end], cells.volume[first:end])


@kernel
def strain_some(rank, points, law, history, axes, cells, dt, team):
    """Stress of one share of the points."""
    tally = make_tally()
    own, own_law, own_history = (
        own_part(points, points, rank, team), own_part(law, points, rank, team), own_part(history, points, rank, team),
    )  # fmt: skip
    own_cells = cells_of(cells, points, rank, team)
    strain_points(own, own_law, own_history, axes, own_cells, team.volumes[rank], team.contents[rank], dt, tally)
    team.ranges[rank, 0], team.ranges[rank, 1] = own_cells.of.min(), own_cells.of.max()
    note_work(rank, tally, team)


@kernel
def mean_pressure(rank, cells, team):
    """Volume and mean pressure of one share of the cells."""
    gather_cells(team.volumes, team.ranges, cells.volume, rank)
    first, end = gather_cells(team.contents, team.ranges, cells.pressure, rank)
    divide(cells.pressure[first:end], cells.volume[first:end])


@kernel
def load_some(rank, points, axes, cells, team):
    """Load by one share of the points."""
    own, own_cells = own_part(points, points, rank, team), cells_of(cells, points, rank, team)
    put_box(team, rank, load_nodes(own, axes, own_cells, team.parts[rank], team.values[rank]))


@kernel
def collect_rows(rank, grid, axes, box, team):
    """Mass, momentum and force on one share of the rows."""
    own = own_rows(box, rank, team)
    gather_rows(team.parts, team.boxes, grid.parts, own)
    gather_rows(team.values, team.boxes, grid.sums, own)
    collect(grid.parts, grid.mass, own, axes)


@kernel
def sum_some(rank, points, history, axes, team):
    """Plastic strain that one share of the points brings to the nodes."""
    own, own_history = own_part(points, points, rank, team), own_part(history, points, rank, team)
    sum_strain(own, own_history, axes, team.values[rank])


@kernel
def average_along_rows(rank, averaging, box, team):
    """Average along one share of the rows."""
    own, wide = own_rows(box, rank, team), widen(averaging, box)
    gather_rows(team.values, team.boxes, averaging.sums, (wide[0], wide[1], own[2], own[3]))
    convolve_rows(averaging, box, own)


@kernel
def average_along_columns(rank, averaging, box, team):
    """Average along the columns, for one share of the rows."""
    convolve_columns(averaging, box, own_rows(box, rank, team))


@kernel
def share_some(rank, points, history, axes, averaging, team):
    """Softening strain of one share of the points."""
    own, own_history = own_part(points, points, rank, team), own_part(history, points, rank, team)
    share_strain(own, own_history, axes, averaging)
