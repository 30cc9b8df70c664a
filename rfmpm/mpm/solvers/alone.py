"""The passes of a step taken by the thread that calls."""

from typing import NamedTuple

from rfmpm.mpm.nonlocal_softening import average_softening
from rfmpm.mpm.solvers.grid import clear, mix_straining, subtract_second_projection, update_grid
from rfmpm.mpm.transfer import carry_points, project_twice, update_velocities


class Alone(NamedTuple):
    """One thread, that of the caller."""

    def update_nodes(self, grid, walls, box, gravity, damping, dt, share):
        """All nodes."""
        update_grid(grid, walls, box, gravity, damping, dt, share)

    def filter_nodes(self, points, axes, grid, box):
        """All points, then all nodes."""
        clear(grid.filtered, box)
        project_twice(points, axes, grid, grid.filtered)
        subtract_second_projection(grid, box)

    def update_points(self, points, axes, grid, filtered, blend, box, own_share):
        """All points, then all nodes."""
        clear(grid.straining, box)
        update_velocities(points, axes, grid, filtered, blend, grid.straining)
        return mix_straining(grid, box, own_share)

    def carry(self, points, law, history, axes, grid, cells, box, dt):
        """All points, then all nodes."""
        clear(grid.parts, box)
        clear(grid.sums, box)
        return carry_points(points, law, history, axes, grid, cells, dt)

    def average(self, points, history, axes, averaging, box):
        """All points, all nodes, all points."""
        average_softening(points, history, axes, averaging, box)
