"""Beta distribution between two bounds.

Johnson, Kotz and Balakrishnan (1995), Continuous Univariate Distributions 2, chapter 25.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Self

import numpy as np

from rfmpm.random_fields.marginals.bounds import check_spread, relative_moments
from rfmpm.random_fields.marginals.protocol import Distribution
from rfmpm.random_fields.marginals.table import tabulate

LOWEST_PARAMETER = 0.2  # below, most of the mass sticks to the bounds


@dataclass(frozen=True)
class Beta(Distribution):
    """Beta distribution: alpha at the lower bound, beta at the upper one [-]; bounds in the unit of the field."""

    alpha: float
    beta: float
    lower: float
    upper: float
    needs: ClassVar[tuple[str, ...]] = ("lower_over_mean", "upper_over_mean")

    @classmethod
    def from_moments(
        cls, mean: float, coefficient_of_variation: float, *, lower_over_mean: float, upper_over_mean: float
    ) -> Self:
        """Match the mean and the coefficient of variation between the bounds, both divided by the mean.

        Raises:
            ValueError: moments or bounds out of range; a spread for which alpha or beta would be below 0.2.
        """
        place, share = relative_moments(mean, coefficient_of_variation, lower_over_mean, upper_over_mean)
        highest = 1.0 / (1.0 + LOWEST_PARAMETER / min(place, 1.0 - place))
        check_spread(share, highest, coefficient_of_variation)
        total = 1.0 / share - 1.0
        return cls(place * total, (1.0 - place) * total, mean * lower_over_mean, mean * upper_over_mean)

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Beta values, same shape as the standard-normal `z`; their distance from either bound to a relative 1e-10."""
        logit = self._logit_quantile(np.asarray(z, dtype=float))
        from_nearer = (self.upper - self.lower) / (1.0 + np.exp(np.abs(logit)))
        return np.where(logit < 0.0, self.lower + from_nearer, self.upper - from_nearer)

    @cached_property
    def _logit_quantile(self) -> Callable[[np.ndarray], np.ndarray]:
        from scipy.special import betaincinv, ndtr

        def exact(z: np.ndarray) -> np.ndarray:
            tail = ndtr(-np.abs(z))  # the smaller of the two probabilities
            share = np.where(z < 0.0, betaincinv(self.alpha, self.beta, tail), betaincinv(self.beta, self.alpha, tail))
            return np.where(z < 0.0, 1.0, -1.0) * (np.log(share) - np.log1p(-share))

        return tabulate(exact)
