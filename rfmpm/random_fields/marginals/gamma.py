"""Gamma distribution: shape 1 / V^2, scale V^2 times the mean, with V the coefficient of variation.

Johnson, Kotz and Balakrishnan (1994), Continuous Univariate Distributions 1, chapter 17.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from rfmpm.random_fields.marginals.protocol import Distribution, check_moments
from rfmpm.random_fields.marginals.table import tabulate


@dataclass(frozen=True)
class Gamma(Distribution):
    """Gamma distribution with a shape [-] and a scale [unit of the field]."""

    shape: float
    scale: float

    @classmethod
    def from_moments(cls, mean: float, coefficient_of_variation: float) -> Self:
        """Match the mean (> 0) and the coefficient of variation (> 0); ValueError otherwise."""
        check_moments(mean, coefficient_of_variation)
        return cls(coefficient_of_variation**-2, mean * coefficient_of_variation**2)

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Gamma values, same shape as the standard-normal `z`, to a relative 1e-10 in both tails."""
        return self.scale * np.exp(self._log_quantile(np.asarray(z, dtype=float)))

    @cached_property
    def _log_quantile(self) -> Callable[[np.ndarray], np.ndarray]:
        from scipy.special import gammainccinv, gammaincinv, ndtr

        def exact(z: np.ndarray) -> np.ndarray:
            tail = ndtr(-np.abs(z))  # the smaller of the two probabilities
            return np.log(np.where(z < 0.0, gammaincinv(self.shape, tail), gammainccinv(self.shape, tail)))

        return tabulate(exact)
