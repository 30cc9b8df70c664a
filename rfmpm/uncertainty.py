"""Uncertain numbers of a study: from the first entries of `xi` to their values, one each for a whole realisation.

The vector `xi` of a realisation starts with the standard normals of the uncertain numbers, in the order of the study;
what the random fields take follows. Fields of other settings may take another number of values: of too many the first
ones count; those that are missing come from a stream that the given ones seed, so that one `xi` has one field.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rfmpm.random_fields.marginals import MARGINALS, Marginal


@dataclass(frozen=True)
class Uniform:
    """Uniform distribution between two values."""

    low: float
    high: float

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Value with the same probability of non-exceedance as the standard-normal `z`, same shape."""
        from scipy.special import ndtr

        return self.low + (self.high - self.low) * ndtr(z)


def marginals(study: Any) -> tuple[Marginal, ...]:
    """Make the distributions of the uncertain numbers of a study, in its order; empty where nothing is uncertain."""
    return tuple(_marginal(entry) for entry in study.uncertain or ())


def _marginal(entry: Any) -> Marginal:
    if entry.distribution == "uniform":
        return Uniform(*entry.limits)
    return MARGINALS[entry.distribution].from_moments(entry.mean, entry.coefficient_of_variation)


def values(distributions: Sequence[Marginal], xi: np.ndarray) -> np.ndarray:
    """Values of uncertain numbers.

    Args:
        distributions: of the k numbers.
        xi: standard-normal vector of a realisation, shape (at least k,) [-].

    Returns:
        the values, shape (k,) [unit of each key].
    """
    return np.array([float(one.transform(np.array(z))) for one, z in zip(distributions, xi, strict=False)])


def fitted(xi: np.ndarray, count: int) -> np.ndarray:
    """The vector of the fields, cut or continued to the length that they take.

    Args:
        xi: standard-normal vector of the fields, shape (m,) [-].
        count: length that the fields of this realisation take.

    Returns:
        shape (count,) [-]: the first values of `xi`, then, where it is shorter, the stream seeded by the SHA-256 of its
        bytes (little-endian float64).
    """
    xi = np.ascontiguousarray(xi, dtype="<f8")
    if count <= len(xi):
        return xi[:count]
    seed = int.from_bytes(hashlib.sha256(xi.tobytes()).digest(), "little")
    more = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed))).standard_normal(count - len(xi))
    return np.concatenate([xi, more])
