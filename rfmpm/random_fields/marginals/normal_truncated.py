"""Normal distribution truncated at zero.

Johnson, Kotz and Balakrishnan (1994), Continuous Univariate Distributions 1, section 13.10.1.
"""

from dataclasses import dataclass
from math import log, pi, sqrt
from typing import Self

import numpy as np

from rfmpm.random_fields.marginals.protocol import Distribution, check_moments

# A normal truncated at zero tends to the exponential distribution, whose coefficient of variation is 1, as its parent
# moves to minus infinity. Near that limit the parameters lose their digits; short of it all is accurate.
HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION = 0.99


@dataclass(frozen=True)
class NormalTruncated(Distribution):
    """Normal kept where it is positive: the mean and standard deviation asked for are those after the truncation.

    Attributes:
        scale: standard deviation of the parent normal.
        bound: the truncation, zero, in parent standard deviations from the parent mean [-].
    """

    scale: float
    bound: float

    @classmethod
    def from_moments(cls, mean: float, coefficient_of_variation: float) -> Self:
        """Match the mean (> 0) and the coefficient of variation (> 0, < 0.99); ValueError otherwise."""
        from scipy.optimize import brentq  # late: scipy only where a study asks for this distribution

        check_moments(mean, coefficient_of_variation, HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION)

        def excess(bound: float) -> float:
            first, second = _truncated_moments(bound)
            return second / first - coefficient_of_variation

        # Truncation lowers the parent's coefficient of variation, -1 / bound; at a bound of 12 it has reached 0.993.
        bound = brentq(excess, -1.0 / coefficient_of_variation - 1.0, 12.0, xtol=1e-15)
        return cls(mean / _truncated_moments(bound)[0], bound)

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Truncated normal values, same shape as the standard-normal `z`, accurate in both tails."""
        from scipy.special import log_ndtr, ndtri_exp

        z = np.asarray(z, dtype=float)
        bound = self.bound
        log_kept = log_ndtr(-bound)
        above_bound = -ndtri_exp(log_kept + log_ndtr(-z)) - bound
        # Close to the bound that difference cancels: there the series of the inverse in the probability per density.
        log_density = -0.5 * bound * bound - 0.5 * log(2.0 * pi)
        small = np.exp(np.minimum(log_ndtr(z) + log_kept - log_density, 0.0))
        series = small * (1.0 + small * (0.5 * bound + small * (2.0 * bound * bound + 1.0) / 6.0))
        return self.scale * np.where(small * (1.0 + abs(bound)) < 1e-4, series, above_bound)


def _truncated_moments(bound: float) -> tuple[float, float]:
    # Mean above the bound and standard deviation, per parent standard deviation; `hazard` is density over probability.
    from scipy.special import erfcx

    hazard = sqrt(2.0 / pi) / float(erfcx(bound / sqrt(2.0)))
    first = hazard - bound
    return first, sqrt(1.0 - hazard * first)
