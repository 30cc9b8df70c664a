"""What every correlation shares: two scales of fluctuation and the direction of the first."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import cos, inf, sin
from typing import ClassVar

import numpy as np


@dataclass(frozen=True)
class Anisotropy(ABC):
    """Scales of fluctuation of a correlation and the direction they refer to.

    A scale of fluctuation theta is the integral of the correlation over all lags, from minus to plus infinity, along
    its axis (Vanmarcke 1983). It is the only length used here: never a range, a correlation length or a half of theta.

    Attributes:
        theta_h: scale of fluctuation along the h axis [m].
        theta_v: scale of fluctuation across the h axis [m].
        rotation: angle of the h axis from the x axis, counter-clockwise [rad].
        separable: whether the correlation is the product of one along its h axis and one along its v axis.

    Raises:
        ValueError: a scale is not positive and finite, or the angle is not finite.
    """

    theta_h: float
    theta_v: float
    rotation: float = 0.0
    separable: ClassVar[bool] = False

    def __post_init__(self) -> None:
        for name in ("theta_h", "theta_v"):
            if not 0 < getattr(self, name) < inf:
                raise ValueError(f"{name} = {getattr(self, name)}: must be positive and finite")
        if not abs(self.rotation) < inf:
            raise ValueError(f"rotation = {self.rotation}: must be finite")

    @abstractmethod
    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation at a lag.

        Args:
            lag_x: x component of the lags, any shape [m].
            lag_y: y component of the lags, same shape [m].

        Returns:
            correlation, same shape [-].
        """

    def relative_lags(self, lag_x: np.ndarray, lag_y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lags along the h axis and across it, each divided by its scale of fluctuation [-]."""
        cosine, sine = cos(self.rotation), sin(self.rotation)
        return (cosine * lag_x + sine * lag_y) / self.theta_h, (cosine * lag_y - sine * lag_x) / self.theta_v


class Separable(Anisotropy):
    """The product of a correlation along the h axis and the same one, with its own scale, along the v axis.

    Both factors are correlations on a line, so the product is positive definite in the plane.
    """

    separable = True

    @abstractmethod
    def profile(self, lag: np.ndarray) -> np.ndarray:
        """Correlation on a line at lags divided by the scale of fluctuation, any shape [-]."""

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation at a lag; see `Anisotropy.rho`."""
        h, v = self.relative_lags(lag_x, lag_y)
        return self.profile(h) * self.profile(v)

    def rho_h(self, lag: np.ndarray) -> np.ndarray:
        """Correlation at lags along the h axis, any shape [m]."""
        return self.profile(np.asarray(lag) / self.theta_h)

    def rho_v(self, lag: np.ndarray) -> np.ndarray:
        """Correlation at lags along the v axis, any shape [m]."""
        return self.profile(np.asarray(lag) / self.theta_v)


class Ellipsoidal(Anisotropy):
    """The same at all lags on an ellipse whose axes are as the scales of fluctuation; isotropic for equal scales."""

    @abstractmethod
    def profile(self, lag: np.ndarray) -> np.ndarray:
        """Correlation at the length of lags divided by their scales of fluctuation, at least zero, any shape [-]."""

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation at a lag; see `Anisotropy.rho`."""
        h, v = self.relative_lags(lag_x, lag_y)
        return self.profile(np.sqrt(h * h + v * v))
