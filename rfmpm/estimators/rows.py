"""What an estimator sees of a campaign: which simulations are finished, what each gave and what it cost."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Rows:
    """Finished simulations of one campaign, sorted by level and index; every array has shape (n,).

    A realisation is one field, named by its index; level 0 simulates it on the cells of the study, level k on the k-th
    of its coarser cells. The same index has the same field on every level.

    Attributes:
        level: 0 for the study's own cells [-].
        index: of the realisation [-].
        value: the quantity in question; NaN where the simulation failed.
        is_censored: whether the value is only a lower bound.
        work: what it cost, time steps times material points [-]; the same on every machine, unlike time.
    """

    level: np.ndarray
    index: np.ndarray
    value: np.ndarray
    is_censored: np.ndarray
    work: np.ndarray

    @property
    def is_failed(self) -> np.ndarray:
        """Whether the simulation failed, shape (n,)."""
        return np.isnan(self.value)

    def on_level(self, level: int) -> "Rows":
        """The rows of one level, sorted by index."""
        return self.where(self.level == level)

    def where(self, chosen: np.ndarray) -> "Rows":
        """The rows that a mask of shape (n,) chooses, in the same order."""
        return Rows(*(column[chosen] for column in vars(self).values()))

    def numbers(self, levels: int) -> list[int]:
        """How many of the indices 0, 1, 2, ... each of so many levels holds without a gap."""
        found = []
        for level in range(levels):
            index = self.index[self.level == level]
            found.append(int(np.sum(index == np.arange(index.size))))
        return found

    def first(self, numbers: Sequence[int]) -> "Rows":
        """The rows of level k with an index below the k-th of these numbers; no row of further levels."""
        bound = np.zeros(max(int(self.level.max(initial=0)) + 1, len(numbers)), int)
        bound[: len(numbers)] = numbers
        return self.where(self.index < bound[self.level])
