"""A correlation in the space of the physical variable and the one of the standard-normal field below it.

With X and Y standard-normal of correlation r, the values w(X) and w(Y) of a marginal w have the correlation

    R(r) = sum_k a_k^2 r^k / sum_k a_k^2,   a_k = E[w(Z) He_k(Z)] / sqrt(k!),   k = 1, 2, ...

(Grigoriu 1995, Applied Non-Gaussian Processes, chapter 3), which rises from R(-1) >= -1 to R(1) = 1. For the
lognormal it is (exp(s^2 r) - 1) / (exp(s^2) - 1) (Fenton and Griffiths 2008, chapter 3).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import expm1, pi, sqrt
from typing import ClassVar, Protocol

import numpy as np

from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.marginals import Lognormal, Marginal

NODES, STEP = np.linspace(-13.0, 13.0, 5201, retstep=True)
MOST_TERMS = 1500  # a smooth marginal takes 5 to 150; one through the values of a sample is left with 1e-4
NEGLIGIBLE = 1e-14  # of the variance
TABLE = np.sin(np.linspace(-0.5 * pi, 0.5 * pi, 2001))  # closer together towards -1 and 1


class SpaceMap(Protocol):
    """Turns correlations of one space into those of the other, element by element."""

    def to_physical(self, gaussian: np.ndarray) -> np.ndarray:
        """Correlation of the physical variable from that of the standard-normal one, -1 to 1 [-]."""

    def to_gaussian(self, physical: np.ndarray) -> np.ndarray:
        """Correlation of the standard-normal variable from that of the physical one, `to_physical(-1)` to 1 [-]."""


@dataclass(frozen=True)
class LognormalMap:
    """The map of a lognormal variable, by the variance of its logarithm [-]."""

    log_variance: float

    def to_physical(self, gaussian: np.ndarray) -> np.ndarray:
        return np.expm1(self.log_variance * gaussian) / expm1(self.log_variance)

    def to_gaussian(self, physical: np.ndarray) -> np.ndarray:
        return np.log1p(physical * expm1(self.log_variance)) / self.log_variance


@dataclass(frozen=True)
class MarginalMap:
    """The map of any marginal of finite variance: the sum above, on a table."""

    marginal: Marginal

    def to_physical(self, gaussian: np.ndarray) -> np.ndarray:
        return np.where(np.asarray(gaussian) == 1.0, 1.0, self._splines[0](gaussian))

    def to_gaussian(self, physical: np.ndarray) -> np.ndarray:
        return np.where(np.asarray(physical) >= 1.0, 1.0, self._splines[1](physical))

    @cached_property
    def _splines(self) -> tuple[Callable[[np.ndarray], np.ndarray], Callable[[np.ndarray], np.ndarray]]:
        from scipy.interpolate import CubicHermiteSpline

        correlation, slope = np.zeros_like(TABLE), np.zeros_like(TABLE)
        for degree, share in reversed(list(enumerate(hermite_shares(self.marginal), 1))):
            correlation = (correlation + share) * TABLE
            slope = slope * TABLE + degree * share
        return CubicHermiteSpline(TABLE, correlation, slope), CubicHermiteSpline(correlation, TABLE, 1.0 / slope)


def hermite_shares(marginal: Marginal) -> list[float]:
    """Shares of the Hermite polynomials of degree 1, 2, ... in the variance of a marginal's values [-].

    At most `MOST_TERMS`, fewer where what is left of the variance is negligible; the last share is what is left.
    """
    root = np.exp(-0.25 * NODES**2) / (2.0 * pi) ** 0.25  # of the normal density: carried by the polynomials
    value = marginal.transform(NODES)
    value = (value - np.sum(STEP * value * root * root)) * root
    variance = float(np.sum(STEP * value**2))
    shares, left = [], 1.0
    before, polynomial = np.zeros_like(NODES), root
    while left > NEGLIGIBLE and len(shares) < MOST_TERMS:
        degree = len(shares)
        before, polynomial = polynomial, (NODES * polynomial - sqrt(degree) * before) / sqrt(degree + 1)
        shares.append(float(np.sum(STEP * value * polynomial)) ** 2 / variance)
        left -= shares[-1]
    return [*shares, max(left, 0.0)]


def space_map(marginal: Marginal) -> SpaceMap:
    """The map between the correlations of a marginal's values and of the standard-normal ones below."""
    if isinstance(marginal, Lognormal):
        return LognormalMap(marginal.log_standard_deviation**2)
    return MarginalMap(marginal)


@dataclass(frozen=True)
class InGaussianSpace:
    """The correlation of the standard-normal field whose values in physical space have a given one.

    Attributes:
        physical: the correlation in physical space.
        map: between the two spaces.
        share: of the variance in physical space that is correlated; the rest differs from point to point. What this
            correlation describes is the correlated part of the standard-normal field, of variance `gaussian_share`.
    """

    physical: Correlation
    map: SpaceMap
    share: float = 1.0
    separable: ClassVar[bool] = False

    @property
    def theta_h(self) -> float:
        return self.physical.theta_h

    @property
    def theta_v(self) -> float:
        return self.physical.theta_v

    @property
    def rotation(self) -> float:
        return self.physical.rotation

    @property
    def gaussian_share(self) -> float:
        """Share of the variance of the standard-normal field that is correlated [-]."""
        return float(self.map.to_gaussian(np.array(self.share)))

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation at a lag; see `Anisotropy.rho`.

        Raises:
            ValueError: two such variables cannot be as negatively correlated as asked.
        """
        physical = self.share * self.physical.rho(lag_x, lag_y)
        lowest = float(self.map.to_physical(np.array(-1.0)))
        if np.min(physical) < lowest:
            raise ValueError(
                f"a correlation of {np.min(physical):.3g} in physical space cannot be had: the lowest of two such "
                f'variables is {lowest:.3g}; take correlation_space = "gaussian", or a lower coefficient_of_variation'
            )
        return self.map.to_gaussian(physical) / self.gaussian_share


@dataclass(frozen=True)
class InPhysicalSpace:
    """The correlation of the physical values whose standard-normal field has a given one."""

    gaussian: Correlation
    map: SpaceMap
    separable: ClassVar[bool] = False

    @property
    def theta_h(self) -> float:
        return self.gaussian.theta_h

    @property
    def theta_v(self) -> float:
        return self.gaussian.theta_v

    @property
    def rotation(self) -> float:
        return self.gaussian.rotation

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation at a lag; see `Anisotropy.rho`."""
        return self.map.to_physical(self.gaussian.rho(lag_x, lag_y))
