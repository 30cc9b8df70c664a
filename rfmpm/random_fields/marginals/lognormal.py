"""Lognormal distribution."""

from dataclasses import dataclass
from math import log, log1p, sqrt
from typing import Self

import numpy as np

from rfmpm.random_fields.marginals.protocol import Distribution, check_moments


@dataclass(frozen=True)
class Lognormal(Distribution):
    """Lognormal: the logarithm is normal with s^2 = ln(1 + V^2), m = ln(mean) - s^2 / 2."""

    log_mean: float
    log_standard_deviation: float

    @classmethod
    def from_moments(cls, mean: float, coefficient_of_variation: float) -> Self:
        """Match the mean (> 0) and the coefficient of variation (> 0); ValueError otherwise."""
        check_moments(mean, coefficient_of_variation)
        log_variance = log1p(coefficient_of_variation**2)
        return cls(log(mean) - 0.5 * log_variance, sqrt(log_variance))

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Lognormal values, same shape as the standard-normal `z`."""
        return np.exp(self.log_mean + self.log_standard_deviation * z)
