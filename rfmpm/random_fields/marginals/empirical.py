"""Distribution of a sample of measured values: their quantiles, joined by a monotone curve, with stated tails.

The i-th of n values in ascending order stands at the probability (i - 1/2) / n (Hazen 1914). Between them the logarithm
is a monotone cubic of the standard-normal quantile (Fritsch and Carlson 1980); beyond the outermost values it goes on
in a straight line, as in a lognormal distribution, with the mean slope over the outermost tenth of the sample. The
moments asked for are reached by a power and a factor, which keep values positive and in order: a power of one where the
asked coefficient of variation is the sample's own.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import sqrt
from typing import ClassVar, Self

import numpy as np

from rfmpm.random_fields.marginals.protocol import Distribution, check_moments

SMALLEST_SAMPLE = 10
NODES, STEP = np.linspace(-14.0, 14.0, 28001, retstep=True)
WEIGHTS = STEP * np.exp(-0.5 * NODES**2) / sqrt(2.0 * np.pi)
STEEPEST = 4.0  # slope of the logarithm in a tail: the square of such values still has its mass below 14
FARTHEST_LOGARITHM = 300.0  # of a value over the median: numbers far from overflow


@dataclass(frozen=True)
class Empirical(Distribution):
    """Distribution of a sample; `log_sample` ascending, values are factor * exp(power * its interpolated quantile)."""

    log_sample: tuple[float, ...]
    power: float
    factor: float
    needs: ClassVar[tuple[str, ...]] = ("sample",)

    @classmethod
    def from_moments(cls, mean: float, coefficient_of_variation: float, *, sample: Sequence[float]) -> Self:
        """Match the mean and the coefficient of variation with the shape of a sample.

        Args:
            mean: greater than 0 [unit of the field].
            coefficient_of_variation: greater than 0 [-].
            sample: at least ten positive values in any order and any unit, not all equal.

        Raises:
            ValueError: moments or sample out of range; a spread too large for the tails of this sample.
        """
        from scipy.optimize import brentq

        check_moments(mean, coefficient_of_variation)
        values = np.sort(np.asarray(sample, dtype=float))
        if len(values) < SMALLEST_SAMPLE or not (0.0 < values[0] < values[-1] < np.inf):
            raise ValueError(f"sample: must be at least {SMALLEST_SAMPLE} positive values that are not all equal")
        log_sample = tuple(np.log(values / np.median(values)).tolist())
        quantile = log_quantile(log_sample)(NODES)

        def excess(power: float) -> float:
            return _spread(power * quantile)[1] - coefficient_of_variation

        highest = min(STEEPEST / max(_tail_slopes(log_sample)[1], 1e-3), FARTHEST_LOGARITHM / np.abs(quantile).max())
        if excess(highest) < 0.0:
            raise ValueError(
                f"coefficient_of_variation = {coefficient_of_variation:g}: too much for the shape of this sample, at "
                f"most {excess(highest) + coefficient_of_variation:.3g}; take a lognormal distribution"
            )
        power = brentq(excess, 0.0, highest, xtol=1e-15)
        return cls(log_sample, power, mean / _spread(power * quantile)[0])

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Values of the sample's distribution, same shape as the standard-normal `z`."""
        return self.factor * np.exp(self.power * self._log_quantile(np.asarray(z, dtype=float)))

    @cached_property
    def _log_quantile(self) -> Callable[[np.ndarray], np.ndarray]:
        return log_quantile(self.log_sample)


def _spread(logarithm: np.ndarray) -> tuple[float, float]:
    # Mean and coefficient of variation of the exponential of a function of the standard-normal `NODES`.
    value = np.exp(logarithm)
    mean = float(np.sum(WEIGHTS * value))
    return mean, sqrt(float(np.sum(WEIGHTS * (value / mean - 1.0) ** 2)))


def _positions(count: int) -> np.ndarray:
    from scipy.special import ndtri

    return ndtri((np.arange(count) + 0.5) / count)


def _tail_slopes(log_sample: Sequence[float]) -> tuple[float, float]:
    at, few = _positions(len(log_sample)), max(1, len(log_sample) // 10)
    lower = (log_sample[few] - log_sample[0]) / (at[few] - at[0])
    upper = (log_sample[-1] - log_sample[-1 - few]) / (at[-1] - at[-1 - few])
    return float(lower), float(upper)


def log_quantile(log_sample: Sequence[float]) -> Callable[[np.ndarray], np.ndarray]:
    """Logarithm of the quantile of a sample, its logarithms ascending, as a function of the standard-normal one."""
    from scipy.interpolate import PchipInterpolator

    at, slopes = _positions(len(log_sample)), _tail_slopes(log_sample)
    return partial(_look_up, PchipInterpolator(at, log_sample), (at[0], at[-1]), slopes)


def _look_up(spline: Callable, ends: tuple[float, float], slopes: tuple[float, float], z: np.ndarray) -> np.ndarray:
    beyond = slopes[0] * np.minimum(z - ends[0], 0.0) + slopes[1] * np.maximum(z - ends[1], 0.0)
    return spline(np.clip(z, *ends)) + beyond
