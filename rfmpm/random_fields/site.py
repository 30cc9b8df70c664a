"""Where random fields are needed: the material points of a body, and their squares."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Site(NamedTuple):
    """Where fields are needed."""

    points: np.ndarray  # material points, shape (n, 2) [m]
    cell: float  # side of a cell [m]
    square: float  # side of the square that a material point stands for [m]
    crest: float  # height of the crest, from which depths are measured [m]
    extent: tuple[float, float]  # length and height from the origin that squares of any cell size may touch [m]
    counts: tuple[int, ...] = ()  # points of each material, in the order of the study; empty: of one

    @property
    def middles(self) -> np.ndarray:
        """Middles of the points' squares, shape (n, 2) [m]; where the surface cuts a square, its point is elsewhere."""
        return (np.floor(self.points / self.square + 1e-9) + 0.5) * self.square

    def of_materials(self, numbers: Sequence[int]) -> "Site":
        """Where a field of some of the materials is needed."""
        if len(self.counts) < 2:
            return self
        counts = tuple(self.counts[number] for number in numbers)
        return self._replace(points=self.points[places_of(self.counts, numbers)], counts=counts)


def places_of(counts: tuple[int, ...], numbers: Sequence[int]) -> slice | np.ndarray:
    """The points of some materials, one material after the other, among those of all.

    Args:
        counts: points of each material, in the order of the study.
        numbers: positions of the materials.
    """
    ends = np.cumsum((0, *counts))
    if len(numbers) == 1:
        return slice(int(ends[numbers[0]]), int(ends[numbers[0] + 1]))
    return np.concatenate([np.arange(ends[number], ends[number + 1]) for number in numbers])
