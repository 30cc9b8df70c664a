"""Latin hypercube and scrambled Sobol points in the directions of `xi` that matter most, in independent replicates.

index = replicate * replicate_size + point. Every replicate is a randomisation of its own, from its own stream: each of
its points is standard-normal, together they are spread more evenly than independent ones, and the scatter between
replicates gives an honest interval.

McKay, Beckman and Conover (1979), Technometrics 21, 239-245, doi:10.1080/00401706.1979.10489755; Sobol points scrambled
after Owen (1998), Journal of Complexity 14, 466-489, doi:10.1006/jcom.1998.0487, by Matousek's (1998) linear scramble
with a digital shift, doi:10.1006/jcom.1998.0489.
"""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators.rows import Rows
from rfmpm.sampling.directions import Directions

STREAM = 1 << 31  # in place of a level in the key of a stream, where no level ever is
MOST_SOBOL_DIMENSIONS = 21201
MOST_SOBOL_POINTS = 1 << 30


class _Design(ABC):
    """Points of one replicate at a time, mapped to standard-normal numbers."""

    kind = 0

    def __init__(self, directions: Directions, replicate_size: int):
        """Make the sampler.

        Args:
            directions: that the design sets; the rest of each vector is random.
            replicate_size: points of a replicate, at least 2 [-].

        Raises:
            ValueError: a size or a number of directions that the design does not have.
        """
        if replicate_size < 2:
            raise ValueError(f"estimator.replicate_size = {replicate_size}: at least 2")
        self.directions = directions
        self.replicate_size = replicate_size
        self._replicate: int | None = None
        self._points = np.empty((0, 0))

    @property
    def n_variables(self) -> int:
        """Length of `xi`."""
        return self.directions.n_variables

    def xi(self, index: int, rows: Rows | None = None) -> np.ndarray:
        """Return the vector of a realisation, shape (n_variables,) [-]; see `Sampler.xi`. Rows are not looked at."""
        replicate, point = divmod(index, self.replicate_size)
        if replicate != self._replicate:
            self._replicate, self._points = replicate, self._normal(replicate)
        return self.directions.compose(index, self._points[point])

    def _normal(self, replicate: int) -> np.ndarray:
        key = (STREAM, self.kind, replicate)
        generator = np.random.Generator(np.random.PCG64(np.random.SeedSequence(self.directions.seed, spawn_key=key)))
        uniform = self._uniform(generator)
        tiny = np.finfo(float).eps
        return ndtri(np.clip(uniform, tiny, 1.0 - tiny))  # a point at 0 or 1 would be infinitely far out

    @abstractmethod
    def _uniform(self, generator: np.random.Generator) -> np.ndarray:
        """Draw the points of a replicate, each coordinate between 0 and 1, shape (replicate_size, dimension)."""


class LatinHypercube(_Design):
    """In each direction one point in each of `replicate_size` equally probable intervals, paired at random."""

    kind = 1

    def _uniform(self, generator: np.random.Generator) -> np.ndarray:
        return _qmc().LatinHypercube(self.directions.dimension, seed=generator).random(self.replicate_size)


class Sobol(_Design):
    """The first 2^m points of a scrambled Sobol sequence, the first directions covered best."""

    kind = 2

    def __init__(self, directions: Directions, replicate_size: int):
        """Make the sampler; see `LatinHypercube`. The replicate size is a power of two."""
        super().__init__(directions, replicate_size)
        if replicate_size & (replicate_size - 1) or replicate_size > MOST_SOBOL_POINTS:
            below = 1 << (replicate_size.bit_length() - 1)
            raise ValueError(
                f'estimator.replicate_size = {replicate_size}: must be a power of two for sampling = "sobol", such as '
                f"{below} or {2 * below}"
            )
        if directions.dimension > MOST_SOBOL_DIMENSIONS:
            raise ValueError(
                f"{directions.dimension} directions: Sobol points have at most {MOST_SOBOL_DIMENSIONS}; lower "
                "estimator.principal_components"
            )

    def _uniform(self, generator: np.random.Generator) -> np.ndarray:
        return _qmc().Sobol(self.directions.dimension, scramble=True, seed=generator).random(self.replicate_size)


def _qmc() -> Any:
    from scipy.stats import qmc  # late: scipy.stats takes half a second

    return qmc
