"""Designs for Sobol indices: base points in pairs, and pairs with one group of variables exchanged.

Base point j is two independent vectors A and B. Its blocks are A, B and, for each group i of variables, A with that
group taken from B. The groups are the uncertain numbers one by one and, where fields vary, all that they take together.
Realisations are ordered base point by base point, so that any number of whole base points can be used.

Saltelli, Annoni, Azzini, Campolongo, Ratto and Tarantola (2010), Computer Physics Communications 181, 259-270.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from rfmpm import seeds

AT_ONCE = 256  # points of the sequence that are made together
INSIDE = 1e-10  # keeps points of the unit cube off its faces


class Place(NamedTuple):
    """What a realisation of the design is: its base point, and its block: 0 is A, 1 is B, 2 + i exchanges group i."""

    base: int
    block: int


@dataclass(frozen=True)
class Saltelli:
    """The vectors of a design for Sobol indices; a sampler.

    Attributes:
        seed: of the study.
        n_uncertain: uncertain numbers, the first entries of a vector, k [-].
        n_variables: length of a vector [-].
    """

    seed: int
    n_uncertain: int
    n_variables: int

    @property
    def groups(self) -> int:
        """Number of groups: k, and one for the fields where they take variables."""
        return self.n_uncertain + (self.n_variables > self.n_uncertain)

    @property
    def blocks(self) -> int:
        """Realisations of one base point."""
        return self.groups + 2

    def place(self, index: int) -> Place:
        """Say which base point and which block a realisation is."""
        return Place(*divmod(index, self.blocks))

    def xi(self, index: int, rows=None) -> np.ndarray:
        """Make the vector of a realisation; it depends on no other one.

        Uncertain numbers come from a scrambled Sobol sequence over A and B, fields from the streams of (seed, 0,
        2 base) for A and (seed, 0, 2 base + 1) for B.

        Args:
            index: of the realisation.
            rows: ignored, as no vector depends on results.

        Returns:
            `xi`, shape (n_variables,) [-].
        """
        base, block = self.place(index)
        k, group = self.n_uncertain, block - 2
        own = 1 if block == 1 else 0
        number = _pairs(self.seed, k, base // AT_ONCE)[base % AT_ONCE].reshape(2, k)
        scalars = number[own].copy()
        if 0 <= group < k:
            scalars[group] = number[1, group]
        stream = 2 * base + (1 if group == k else own)
        return np.concatenate([scalars, seeds.standard_normal(self.seed, 0, stream, self.n_variables - k)])


@lru_cache(maxsize=4)
def _pairs(seed: int, count: int, part: int) -> np.ndarray:
    """Standard-normal A and B of uncertain numbers for one part of the base points, shape (AT_ONCE, 2 count) [-]."""
    from scipy.special import ndtri
    from scipy.stats import qmc

    if count == 0:
        return np.empty((AT_ONCE, 0))
    sequence = qmc.Sobol(2 * count, scramble=True, seed=np.random.default_rng([seed, 0x5A17]))
    if part:  # it cannot stay where it is
        sequence.fast_forward(part * AT_ONCE)
    return ndtri(0.5 + (1.0 - INSIDE) * (sequence.random(AT_ONCE) - 0.5))
