"""Cubic B-splines with nodes at the cell corners and interpolating walls."""

from typing import NamedTuple


class CubicBSpline(NamedTuple):
    """Four nodes along one axis of `cells` cells between two walls.

    Inside: Steffen, Kirby and Berzins (2008), section 3.3, on even knots. Beyond a wall there are no nodes: the value
    of the missing one is extrapolated linearly, v_ghost = 2 v_wall - v_second. On the wall the spline weighs ghost,
    wall and second node by 1/6, 4/6 and 1/6, which is then v_wall: the wall's own value is met exactly. In the first
    cell the ghost's weight (1 - s)^3 / 6 goes twice to the wall and is taken once from the second node:

        1 - s + s^3 / 6,   s - s^3 / 3,   s^3 / 6,

    never negative, with second derivatives that vanish on the wall and go on into the spline of the second cell.
    """

    FEWEST_CELLS = 3
    OWN_SHARE = 0.2  # of the grid in what strains the points: without, noise drives thin soil on fine cells

    inverse_cell: float  # [1/m]
    cells: int

    def weights(self, x):
        """First node, four weights and slopes."""
        s, k = x * self.inverse_cell, self.inverse_cell
        if s < 1.0:
            cube, square = s * s * s / 6.0, 0.5 * s * s
            return (
                0,
                (1.0 - s + cube, s - 2.0 * cube, cube, 0.0),
                (k * (square - 1.0), k * (1.0 - 2.0 * square), k * square, 0.0),
            )
        if s >= self.cells - 1.0:
            t = self.cells - s
            cube, square = t * t * t / 6.0, 0.5 * t * t
            return (
                self.cells - 3,
                (0.0, cube, t - 2.0 * cube, 1.0 - t + cube),
                (0.0, -k * square, k * (2.0 * square - 1.0), k * (1.0 - square)),
            )
        i = int(s)
        f = s - i
        g = 1.0 - f
        return (
            i - 1,
            (
                g * g * g / 6.0,
                (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0,
                (4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0,
                f * f * f / 6.0,
            ),
            (-0.5 * g * g * k, (1.5 * f * f - 2.0 * f) * k, (2.0 * g - 1.5 * g * g) * k, 0.5 * f * f * k),
        )
