"""Generalised interpolation with points of fixed size (uGIMP): hat functions averaged over a point's own length."""

from typing import NamedTuple


class Gimp(NamedTuple):
    """Three nodes along one axis of `cells` cells between two walls.

    Inside: Bardenhagen and Kober (2004), eq. 32 to 34, contiguous domains that keep their first size. Beyond a wall
    there are no nodes: the value of the missing one is extrapolated linearly, v_ghost = 2 v_wall - v_second, so the
    first cell's line goes on beyond the wall, and its average over a point's length is its value at the point: weights
    1 - s and s, that meet the wall's own value exactly.
    """

    FEWEST_CELLS = 2
    OWN_SHARE = 0.0  # of the grid in what strains the points: with any, an elastic block in the air blows up

    inverse_cell: float  # [1/m]
    cells: int
    half_size: float = 0.25  # half of a point's length over a cell; at most 0.5, the quadratic B-spline [-]

    def weights(self, x):
        """First node, three weights and slopes."""
        s, k, size = x * self.inverse_cell, self.inverse_cell, self.half_size
        if s < 0.5:
            return 0, (1.0 - s, s, 0.0), (-k, k, 0.0)
        if s >= self.cells - 0.5:
            t = self.cells - s
            return self.cells - 2, (0.0, t, 1.0 - t), (0.0, -k, k)
        i = int(s - 0.5)
        f = s - i - 1.0
        if f >= size:
            return i, (0.0, 1.0 - f, f), (0.0, -k, k)
        if f <= -size:
            return i, (-f, 1.0 + f, 0.0), (-k, k, 0.0)
        left, right, part = size - f, size + f, 0.25 / size
        return (
            i,
            (part * left * left, 1.0 - 2.0 * part * (f * f + size * size), part * right * right),
            (-2.0 * part * left * k, -4.0 * part * f * k, 2.0 * part * right * k),
        )
