"""Quadratic B-splines with nodes at the cell corners and interpolating walls."""

from typing import NamedTuple

import numpy as np


class QuadraticBSpline(NamedTuple):
    """Three nodes along one axis of `cells` cells between two walls.

    Inside: Steffen, Kirby and Berzins (2008), eq. 17. Beyond a wall there are no nodes: the value of the missing one is
    extrapolated linearly, v_ghost = 2 v_wall - v_second, which leaves weights 1 - s and s within half a cell of the
    wall, so that the wall's own value is met exactly there.
    """

    FEWEST_CELLS = 2
    OWN_SHARE = 0.2  # of the grid in what strains the points: without, noise drives thin soil on fine cells

    inverse_cell: float  # [1/m]
    cells: int

    def weights(self, x):
        """First node, three weights and slopes; without branches, so that loops over points become vector code.

        With f the distance from the first node in cells, a spline in the piece 1/2 <= f <= 3/2; what f exceeds the
        piece by, it does within half a cell of a wall, where the outer weight goes on linearly and the others follow.
        """
        s, k = x * self.inverse_cell, self.inverse_cell
        first = np.int32(min(max(s - 0.5, 0.0), self.cells - 2.0))
        f = s - first
        inside = min(max(f, 0.5), 1.5)
        left, right, excess = 1.5 - inside, inside - 0.5, inside - f
        w0 = 0.5 * left * left + max(excess, 0.0)
        w2 = 0.5 * right * right + max(-excess, 0.0)
        return first, (w0, 1.0 - w0 - w2, w2), (-left * k, (left - right) * k, right * k)
