"""The passes of a step shared by several threads, for one large scene.

Every thread has a range of the points, and arrays of its own that these add to; then every thread sums the arrays of
all over its share of the rows of nodes, in their order. So results depend on the number of threads, by rounding, but
not on which of them is faster.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel, side_by_side, start_threads, zeros
from rfmpm.mpm.solvers.shares import (
    FALL,
    FASTEST,
    FRICTION,
    KINETIC,
    PLASTIC,
    WORK,
    average_along_columns,
    average_along_rows,
    carry_some,
    collect_rows,
    filter_rows,
    load_some,
    mean_dilatation,
    mean_pressure,
    mix_rows,
    move_some,
    project_some,
    share_some,
    strain_some,
    sum_some,
    update_rows,
    update_some,
)

CACHE_LINE = 8  # numbers


class Team(NamedTuple):
    """Threads, and what each has for itself; the arrays are zero between the passes."""

    threads: int  # that there are; if fewer than shares, a thread takes several
    values: np.ndarray  # (shares, rows, columns, 4)
    parts: np.ndarray  # (shares, rows, columns, 4)
    volumes: np.ndarray  # (shares, cells) [m3/m]
    contents: np.ndarray  # (shares, cells): volume times volumetric strain rate, or times pressure
    boxes: np.ndarray  # (shares, CACHE_LINE) first and last column and row of the nodes that the points of each touch
    ranges: np.ndarray  # (shares, CACHE_LINE) first and last of the cells that they are in
    found: np.ndarray  # (shares, CACHE_LINE) energies and the like
    lost: np.ndarray  # (shares,) point that left the grid, or -1

    def update_nodes(self, grid, walls, box, gravity, damping, dt, share):
        """By shares of the rows."""
        share_out(update_rows, self, (grid, walls, box, gravity, damping, dt, share, self))

    def filter_nodes(self, points, axes, grid, box):
        """By shares of the points, then of the rows."""
        share_out(project_some, self, (points, axes, grid, self))
        share_out(filter_rows, self, (grid, box, self))

    def update_points(self, points, axes, grid, filtered, blend, box, own_share):
        """By shares of the points, then of the rows."""
        share_out(update_some, self, (points, axes, grid, filtered, blend, self))
        share_out(mix_rows, self, (grid, box, own_share, self))
        return self.found[:, FRICTION].sum()

    def carry(self, points, law, history, axes, grid, cells, box, dt):
        """By shares of the points, with shares of the cells in between, then of the rows."""
        if cells is None:
            share_out(carry_some, self, (points, law, history, axes, grid, dt, self))
        else:
            share_out(move_some, self, (points, axes, grid, cells, dt, self))
            if self.lost.max() < 0:
                share_out(mean_dilatation, self, (cells, self))
                share_out(strain_some, self, (points, law, history, axes, cells, dt, self))
                share_out(mean_pressure, self, (cells, self))
                share_out(load_some, self, (points, axes, cells, self))
        boxes, found = self.boxes, self.found
        touched = boxes[:, 0].min(), boxes[:, 1].max(), boxes[:, 2].min(), boxes[:, 3].max()
        share_out(collect_rows, self, (grid, axes, touched, self))
        kinetic, fall, fastest = found[:, KINETIC].sum(), found[:, FALL].sum(), found[:, FASTEST].max()
        return kinetic, fall, found[:, WORK].sum(), found[:, PLASTIC].sum(), fastest, touched, self.lost.max()

    def average(self, points, history, axes, averaging, box):
        """By shares of the points, of the rows twice, of the points."""
        share_out(sum_some, self, (points, history, axes, self))
        share_out(average_along_rows, self, (averaging, box, self))
        share_out(average_along_columns, self, (averaging, box, self))
        share_out(share_some, self, (points, history, axes, averaging, self))


def make_team(size: int, grid, cells) -> Team:
    """Make a team for one run.

    Args:
        size: number of shares, at least 1; as many threads take them as there are cores.
        grid: nodes of the run.
        cells: sums over the points of a cell of the run, or None.

    Returns:
        The team.
    """
    rows, columns = grid.mass.shape
    count = 0 if cells is None else cells.volume.size
    nodes = (zeros(size * rows, columns).reshape(size, rows, columns, 4) for _ in range(2))
    own = np.zeros((size, count)), np.zeros((size, count))
    boxes, ranges = (np.zeros((size, CACHE_LINE), np.int64) for _ in range(2))
    found, lost = np.zeros((size, CACHE_LINE)), np.full(size, -1)
    return Team(min(size, start_threads()), *nodes, *own, boxes, ranges, found, lost)


@kernel
def share_out(function, team, arguments):
    """Call a kernel for every share."""
    side_by_side(function, len(team.lost), team.threads, arguments)
