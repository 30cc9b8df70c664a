"""Weibull distribution with two parameters: exp(-(x / scale)^shape) is the probability of exceeding x.

Johnson, Kotz and Balakrishnan (1994), Continuous Univariate Distributions 1, chapter 21.
"""

from dataclasses import dataclass
from math import exp, expm1, lgamma, sqrt
from typing import Self

import numpy as np

from rfmpm.random_fields.marginals.protocol import Distribution, check_moments


@dataclass(frozen=True)
class Weibull(Distribution):
    """Weibull distribution with a shape [-] and a scale [unit of the field]."""

    shape: float
    scale: float

    @classmethod
    def from_moments(cls, mean: float, coefficient_of_variation: float) -> Self:
        """Match the mean (> 0) and the coefficient of variation (> 0); ValueError otherwise."""
        from scipy.optimize import brentq

        check_moments(mean, coefficient_of_variation)

        def excess(inverse_shape: float) -> float:
            squared = expm1(lgamma(1.0 + 2.0 * inverse_shape) - 2.0 * lgamma(1.0 + inverse_shape))
            return sqrt(max(squared, 0.0)) - coefficient_of_variation

        # The coefficient of variation is 1 at a shape of 1; it is steeper than linear above and at most linear below.
        inverse_shape = brentq(
            excess, 0.5 * coefficient_of_variation / (1.0 + coefficient_of_variation), 20.0, xtol=1e-15
        )
        return cls(1.0 / inverse_shape, mean * exp(-lgamma(1.0 + inverse_shape)))

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Weibull values, same shape as the standard-normal `z`."""
        from scipy.special import log_ndtr

        return self.scale * (-log_ndtr(-np.asarray(z, dtype=float))) ** (1.0 / self.shape)
