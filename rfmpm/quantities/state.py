"""What quantities are read from."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rfmpm.ground import height_at


@dataclass(frozen=True)
class FinalState:
    """Points at the end of a run and what is needed to judge how far they went; arrays have shape (n,)."""

    x: np.ndarray  # [m]
    y: np.ndarray  # [m]
    x_initial: np.ndarray  # [m]
    y_initial: np.ndarray  # [m]
    volume: np.ndarray  # [m3 per m]
    volume_initial: np.ndarray  # [m3 per m]
    plastic_strain: np.ndarray  # [-]
    cell: float  # [m]
    spacing: float  # of the points in a full cell [m]
    toe: float  # x of the toe at the start [m]
    crest_edge: float  # x of the crest's edge at the start [m]
    crest_height: float  # [m]
    length: float  # of the domain [m]
    displacement_threshold: float  # [m]
    front_quantile: float  # [-]
    block_plastic_strain: float  # [-]
    block_minimum_area: float  # [m2]
    surface_bin: float | None  # [m]
    ground: np.ndarray | None = None  # corners of the ground surface at the start, shape (k, 2) [m]; None: level crest

    @cached_property
    def failed(self) -> np.ndarray:
        """Which points moved further than the threshold; shape (n,)."""
        return np.hypot(self.x - self.x_initial, self.y - self.y_initial) > self.displacement_threshold

    @cached_property
    def top_row(self) -> np.ndarray:
        """Which points lie right under the crest at the start; shape (n,)."""
        top = self.crest_height if self.ground is None else height_at(self.ground, self.x_initial)
        return (self.y_initial > top - self.spacing) & (self.x_initial < self.crest_edge)


def label_cells(x: np.ndarray, y: np.ndarray, cell: float, diagonal: bool) -> np.ndarray:
    """Number the connected groups of points: those whose cells touch.

    Args:
        x, y: positions, shape (n,) [m].
        cell: side of the cells [m].
        diagonal: whether cells that share a corner only touch too.

    Returns:
        Group of each point, shape (n,), from 0.
    """
    from scipy.ndimage import label

    if len(x) == 0:
        return np.zeros(0, dtype=int)
    column, row = np.floor(x / cell).astype(int), np.floor(y / cell).astype(int)
    column, row = column - column.min(), row - row.min()
    occupied = np.zeros((row.max() + 1, column.max() + 1), dtype=bool)
    occupied[row, column] = True
    groups, _ = label(occupied, structure=np.ones((3, 3)) if diagonal else None)
    return groups[row, column] - 1
