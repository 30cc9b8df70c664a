"""Linear hat functions."""

from typing import NamedTuple

import numpy as np


class Linear(NamedTuple):
    """Two nodes along one axis of `cells` cells between two walls."""

    FEWEST_CELLS = 1
    OWN_SHARE = 0.0  # of the grid in what strains the points: with any, an elastic block in the air blows up

    inverse_cell: float  # [1/m]
    cells: int

    def weights(self, x):
        """Hat functions; a point on the far wall belongs to the last cell."""
        s = x * self.inverse_cell
        first = np.int32(min(s, self.cells - 1.0))
        f = s - first
        return first, (1.0 - f, f), (-self.inverse_cell, self.inverse_cell)
