"""Quadratic B-splines with nodes at the cell corners and interpolating walls."""

from typing import NamedTuple


class QuadraticBSpline(NamedTuple):
    """Three nodes along one axis of `cells` cells between two walls.

    Inside: Steffen, Kirby and Berzins (2008), eq. 17. Beyond a wall there are no nodes: the value of the missing one is
    extrapolated linearly, v_ghost = 2 v_wall - v_second, which leaves weights 1 - s and s within half a cell of the
    wall, so that the wall's own value is met exactly there.
    """

    COURANT = 0.8  # wave speed times critical time step over cell: an elastic block is stable at 0.8, not at 0.9
    FEWEST_CELLS = 2
    SECOND_MAPPING = None  # not needed

    inverse_cell: float  # [1/m]
    cells: int

    def weights(self, x):
        """First node, three weights and slopes."""
        s, k = x * self.inverse_cell, self.inverse_cell
        if s < 0.5:
            return 0, (1.0 - s, s, 0.0), (-k, k, 0.0)
        if s >= self.cells - 0.5:
            t = self.cells - s
            return self.cells - 2, (0.0, t, 1.0 - t), (0.0, -k, k)
        i = int(s - 0.5)
        f = s - i
        left, right = 1.5 - f, f - 0.5
        return (
            i,
            (0.5 * left * left, 0.75 - (f - 1.0) * (f - 1.0), 0.5 * right * right),
            (-left * k, -2.0 * (f - 1.0) * k, right * k),
        )
