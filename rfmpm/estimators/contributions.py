"""A linear estimate as the sum of what independent units contribute, and the interval that follows from it.

Every estimator here but those of small probabilities is linear: plain Monte Carlo (a unit is a realisation that adds
y / n), designs with replicates (a unit is a replicate), several levels (a unit is an index with all its simulations).
Units of one stratum are identically distributed: on several levels the indices that were simulated on the same levels.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.special import ndtri, stdtrit

from rfmpm.estimators.intervals import wilson
from rfmpm.estimators.protocol import Expectation


@dataclass(frozen=True)
class Counts:
    """How often a difference of indicators was +1 and -1: what a normal interval needs to be told where both are few.

    Attributes:
        scale: factor with which the mean difference enters the estimate, shape (k,) [-].
        plus: number of differences +1, shape (k,).
        minus: number of differences -1, shape (k,); None where there is nothing to subtract and so no difference -1.
        n: number of differences.
    """

    scale: np.ndarray
    plus: np.ndarray
    minus: np.ndarray | None
    n: int


@dataclass(frozen=True)
class Contributions:
    """What n units add to the estimates of k expectations.

    Attributes:
        unit: shape (n, k); the estimate is `base` plus their sum.
        stratum: of each unit, shape (n,).
        base: constant part of the estimate, shape (k,).
        counts: for probabilities, the differences of indicators behind the estimate; empty for means.
        freedom: degrees of freedom of the standard errors, shape (k,) [-]; None where the strata tell them.
    """

    unit: np.ndarray
    stratum: np.ndarray
    base: np.ndarray
    counts: tuple[Counts, ...] = field(default=())
    freedom: np.ndarray | None = None

    @property
    def value(self) -> np.ndarray:
        """The estimates, shape (k,); NaN without units."""
        if not len(self.unit):
            return np.full(self.base.shape, np.nan)
        return self.base + self.unit.sum(axis=0)

    def deviations(self) -> np.ndarray:
        """Return the units less their stratum's mean, scaled so that their squares add up to the variance, (n, k)."""
        deviation = np.empty_like(self.unit)
        for stratum in np.unique(self.stratum):
            here = self.stratum == stratum
            n = int(here.sum())
            scale = np.sqrt(n / (n - 1.0)) if n > 1 else np.inf
            spread = self.unit[here] - self.unit[here].mean(axis=0)
            deviation[here] = scale * spread if n > 1 else np.inf
        return deviation

    def standard_error(self) -> np.ndarray:
        """Return the standard error of the estimates, shape (k,); infinite where a stratum has a single unit."""
        if not len(self.unit):
            return np.full(self.base.shape, np.inf)
        return np.sqrt(np.sum(self.deviations() ** 2, axis=0))

    def degrees_of_freedom(self) -> np.ndarray:
        """Return the degrees of freedom of the standard error, shape (k,) [-].

        Source: Welch (1947), Biometrika 34, 28-35; Satterthwaite (1946), Biometrics Bulletin 2, 110-114.
        """
        if self.freedom is not None:
            return self.freedom
        squares = self.deviations() ** 2
        strata = np.unique(self.stratum)
        parts = np.array([squares[self.stratum == s].sum(axis=0) for s in strata])
        freedom = np.array([max(np.sum(self.stratum == s) - 1, 1) for s in strata], float)
        total = parts.sum(axis=0)
        share = parts / np.where(total > 0.0, total, 1.0)
        return np.where(
            total > 0.0, 1.0 / np.maximum(np.sum(share**2 / freedom[:, None], axis=0), 1e-12), freedom.sum()
        )

    def expectation(self, confidence: float, is_probability: bool) -> Expectation:
        """Return the estimates with their intervals.

        A mean has Student's t interval with Welch's degrees of freedom. So has a probability; its two half widths are
        then corrected by what better intervals of the underlying counts have over Wald's, which matters where few
        counts make the normal approximation and the estimated variance worthless, and clipped into 0 to 1: Wilson's
        score interval of a share; of a difference of paired indicators one that counts a single difference where
        there is none. (Agresti and Min's, which counts one more always, covered 0.98 with 128 pairs of the short
        slope.)

        Args:
            confidence: level [-].
            is_probability: whether the expectations are probabilities.

        Returns:
            Expectation, arrays of shape (k,).

        Source: Zou and Donner (2008), Statistics in Medicine 27, 1693-1702, doi:10.1002/sim.3095, for intervals of a
        sum recovered from the intervals of its parts; Agresti and Min (2005), Statistics in Medicine 24, 729-740.
        """
        value, error = self.value, self.standard_error()
        if not len(self.unit):
            wide = np.full(value.shape, 0.0 if is_probability else -np.inf)
            return Expectation(value, error, wide, np.ones(value.shape) if is_probability else -wide)
        is_finite = np.isfinite(error)
        factor = stdtrit(self.degrees_of_freedom() if is_finite.any() else 1.0, 0.5 + confidence / 2.0)
        half = np.where(is_finite, factor * np.where(is_finite, error, 0.0), np.inf)
        if not is_probability:
            return Expectation(value, error, value - half, value + half)
        down, up = _corrected(half, self.counts, confidence)
        value = np.clip(value, 0.0, 1.0)
        return Expectation(value, error, np.clip(value - down, 0.0, 1.0), np.clip(value + up, 0.0, 1.0))


def _corrected(half: np.ndarray, counts: tuple[Counts, ...], confidence: float) -> tuple[np.ndarray, np.ndarray]:
    """Half widths downwards and upwards of a probability, shape (k,) each."""
    z = ndtri(0.5 + confidence / 2.0)
    wald, down, up = (np.zeros(half.shape) for _ in range(3))
    for count in counts:
        plus, minus, n = count.plus, 0.0 if count.minus is None else count.minus, count.n
        square = (count.scale * z) ** 2
        wald += square * (plus + minus - (plus - minus) ** 2 / n) / n**2
        if count.minus is None:
            lower, upper = wilson(plus, n, confidence)
            down += (count.scale * (plus / n - lower)) ** 2
            up += (count.scale * (upper - plus / n)) ** 2
        else:
            both = square * (np.maximum(plus + minus, 1.0) - (plus - minus) ** 2 / n) / n**2
            down, up = down + both, up + both
    return tuple(_replaced(half, wald, score) for score in (down, up))


def _replaced(half: np.ndarray, wald: np.ndarray, score: np.ndarray) -> np.ndarray:
    """Half width with Wald's part of its square replaced by the score interval's."""
    share = np.where(wald > 0.0, score / np.where(wald > 0.0, wald, 1.0), 1.0)
    return np.where(share >= 1.0, np.sqrt(half**2 + np.maximum(score - wald, 0.0)), half * np.sqrt(share))
