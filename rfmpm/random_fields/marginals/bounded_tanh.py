"""Bounded distribution by a hyperbolic tangent: lower + (upper - lower) / 2 (1 + tanh((m + s z) / (2 pi))), z normal.

Fenton and Griffiths (2008), Risk Assessment in Geotechnical Engineering, chapter 1: for friction angles.
"""

from dataclasses import dataclass
from math import log, pi
from typing import ClassVar, Self

import numpy as np

from rfmpm.random_fields.marginals.bounds import check_spread, relative_moments
from rfmpm.random_fields.marginals.protocol import Distribution

HIGHEST_SHARE = 0.9  # of the largest variance between the bounds; there s is about 50 and most values are at a bound
NODES, STEP = np.linspace(-9.0, 9.0, 3601, retstep=True)  # resolves the tangent up to s = 100; beyond 9 lies 2e-19
WEIGHTS = STEP * np.exp(-0.5 * NODES**2) / (2.0 * pi) ** 0.5


@dataclass(frozen=True)
class BoundedTanh(Distribution):
    """Bounded distribution with a location m and a scale s [-] and bounds in the unit of the field."""

    location: float
    spread: float
    lower: float
    upper: float
    needs: ClassVar[tuple[str, ...]] = ("lower_over_mean", "upper_over_mean")

    @classmethod
    def from_moments(
        cls, mean: float, coefficient_of_variation: float, *, lower_over_mean: float, upper_over_mean: float
    ) -> Self:
        """Match the mean and the coefficient of variation between the bounds, both divided by the mean.

        Raises:
            ValueError: moments or bounds out of range; more than 0.9 of the largest variance between the bounds.
        """
        from scipy.optimize import brentq

        place, share = relative_moments(mean, coefficient_of_variation, lower_over_mean, upper_over_mean)
        check_spread(share, HIGHEST_SHARE, coefficient_of_variation)
        variance = share * place * (1.0 - place)

        def excess(log_spread: float) -> float:
            spread = np.exp(log_spread)
            value = _unit_value(_location(spread, place), spread, NODES)
            return float(np.sum(WEIGHTS * (value - place) ** 2)) / variance - 1.0

        spread = float(np.exp(brentq(excess, log(variance), log(200.0), xtol=1e-14)))
        return cls(_location(spread, place), spread, mean * lower_over_mean, mean * upper_over_mean)

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Values between the bounds, same shape as the standard-normal `z`."""
        width, z = self.upper - self.lower, np.asarray(z, dtype=float)
        from_lower = self.lower + width * _unit_value(self.location, self.spread, z)
        from_upper = self.upper - width * _unit_value(-self.location, self.spread, -z)
        return np.where(self.location + self.spread * z < 0.0, from_lower, from_upper)


def _unit_value(location: float, spread: float, z: np.ndarray) -> np.ndarray:
    # (1 + tanh(x / 2)) / 2 without a difference of ones in the lower tail.
    return 1.0 / (1.0 + np.exp(np.minimum(-(location + spread * z) / pi, 700.0)))


def _location(spread: float, place: float) -> float:
    # The location that gives the mean, between the bounds, of `place`.
    from scipy.optimize import brentq

    reach = 10.0 * spread + 40.0 * pi
    return brentq(lambda m: float(np.sum(WEIGHTS * _unit_value(m, spread, NODES))) - place, -reach, reach, xtol=1e-13)
