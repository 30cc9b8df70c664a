"""Local averages of a field over boxes, such as the volumes of material points.

The average over a box a x b of a field of variance sigma^2 has the variance sigma^2 gamma, and two such averages whose
middles are a lag (x, y) apart have the covariance

    sigma^2 integral of rho(x + u, y + v) (1 - |u| / a) (1 - |v| / b) / (a b) du dv  over |u| < a, |v| < b,

of which gamma is the value at no lag (Vanmarcke 1983, Random Fields: Analysis and Synthesis, sections 5.1 and 6.2). The
integrals are taken by Gauss rules between the kinks of the weights and, close by, over ever smaller intervals towards
lag zero, where the correlation of a rough field has a cusp. They are good to 1e-8; where a kink runs obliquely through
the boxes, on the axes of a rotated separable correlation or at the end of the spherical one, to 2e-4.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, inf, sin
from typing import ClassVar, NamedTuple

import numpy as np

from rfmpm.random_fields.correlation.protocol import Correlation

GAUSS = np.polynomial.legendre.leggauss(6)
# Ends of the intervals on either side of a cusp, over the scale of fluctuation.
GRADES = np.array([0.0, 1e-3, 1e-2, 0.05, 0.2, 0.6, 1.5, 4.0, 12.0])
NEAR = 3.0  # lags, over the side of the box, up to which intervals are graded
MOST_PARTS = 8  # of half a box: where it is longer than four scales, far boxes are no longer correlated
EVALUATIONS_AT_ONCE = 2_000_000
TOLD_APART = 1e-10  # of the box: lags that differ by less are one


class Side(NamedTuple):
    """One direction of the boxes: their length and a scale of fluctuation along it [m]."""

    length: float
    scale: float


@dataclass(frozen=True)
class VolumeAveraged:
    """Correlation between averages over boxes whose sides are along x and y.

    Attributes:
        point: correlation between points, in the space in which values are averaged.
        width: of the boxes, along x [m].
        height: of the boxes, along y [m].
    """

    point: Correlation
    width: float
    height: float
    separable: ClassVar[bool] = False

    def __post_init__(self) -> None:
        for name in ("width", "height"):
            if not 0.0 < getattr(self, name) < inf:
                raise ValueError(f"{name} = {getattr(self, name)}: must be positive and finite")

    @property
    def theta_h(self) -> float:
        return self.point.theta_h

    @property
    def theta_v(self) -> float:
        return self.point.theta_v

    @property
    def rotation(self) -> float:
        return self.point.rotation

    @cached_property
    def variance_factor(self) -> float:
        """Variance of an average over that of a point, gamma [-]."""
        return float(self.covariance(np.zeros(1), np.zeros(1))[0])

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation between averages over boxes with a lag between their middles; see `Anisotropy.rho`."""
        return self.covariance(lag_x, lag_y) / self.variance_factor

    def covariance(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Covariance between averages over the variance of a point.

        Args:
            lag_x: x component of the lags between the middles, any shape [m].
            lag_y: y component of the lags, same shape [m].

        Returns:
            same shape [-]; equal, bit for bit, for a lag and its opposite.
        """
        lag_x, lag_y = np.broadcast_arrays(np.asarray(lag_x, dtype=float), np.asarray(lag_y, dtype=float))
        places = _whole(lag_x, self.width) + 1j * _whole(lag_y, self.height)
        opposite = (places.imag < 0.0) | ((places.imag == 0.0) & (places.real < 0.0))
        distinct, inverse = np.unique(np.where(opposite, -places, places), return_inverse=True)
        x, y = distinct.real * TOLD_APART * self.width, distinct.imag * TOLD_APART * self.height
        found = np.empty(len(distinct))
        near_x, near_y = np.abs(x) <= NEAR * self.width, np.abs(y) <= NEAR * self.height
        for group_x, graded_x in ((near_x, True), (~near_x, False)):
            for group_y, graded_y in ((near_y, True), (~near_y, False)):
                (members,) = np.nonzero(group_x & group_y)
                found[members] = self._integrals(x[members], y[members], graded_x, graded_y)
        return found[inverse].reshape(lag_x.shape)

    def _integrals(self, x: np.ndarray, y: np.ndarray, graded_x: bool, graded_y: bool) -> np.ndarray:
        side_x, side_y = self._sides
        found = np.empty(len(x))
        start, count = 0, 1
        while start < len(x):
            some = slice(start, start + count)
            lag_x, weight_x = _rule(x[some], side_x, graded_x)
            lag_y, weight_y = _rule(y[some], side_y, graded_y)
            rho = self.point.rho(lag_x[:, :, None], lag_y[:, None, :])
            found[some] = np.einsum("li,lij,lj->l", weight_x, rho, weight_y, optimize=True)
            start += count
            count = max(1, EVALUATIONS_AT_ONCE // (lag_x.shape[1] * lag_y.shape[1]))
        return found

    @property
    def _sides(self) -> tuple[Side, Side]:
        cosine, sine = cos(self.rotation), sin(self.rotation)
        along_x = np.hypot(cosine / self.theta_h, sine / self.theta_v)
        along_y = np.hypot(sine / self.theta_h, cosine / self.theta_v)
        return Side(self.width, 1.0 / along_x), Side(self.height, 1.0 / along_y)


def _whole(lag: np.ndarray, length: float) -> np.ndarray:
    # Adding zero makes a negative zero positive.
    return np.round(lag / (TOLD_APART * length)) + 0.0


def _rule(lag: np.ndarray, side: Side, graded: bool) -> tuple[np.ndarray, np.ndarray]:
    """Lags between points of two boxes, and their weights, for lags of shape (l,): both of shape (l or 1, nodes)."""
    ends = _graded_ends(lag, side) if graded else _even_ends(side)
    node, weight = GAUSS
    middle, half = 0.5 * (ends[:, 1:] + ends[:, :-1]), 0.5 * np.diff(ends)
    u = (middle[:, :, None] + half[:, :, None] * node).reshape(len(ends), -1)
    share = (half[:, :, None] * weight).reshape(len(ends), -1) * (1.0 - np.abs(u) / side.length) / side.length
    return lag[:, None] + u, np.broadcast_to(share, (len(lag), u.shape[1]))


def _even_ends(side: Side) -> np.ndarray:
    parts = min(MOST_PARTS, ceil(2.0 * side.length / side.scale))
    return np.linspace(-side.length, side.length, 2 * parts + 1)[None, :]


def _graded_ends(lag: np.ndarray, side: Side) -> np.ndarray:
    grades = side.scale * np.concatenate([-GRADES[:0:-1], GRADES])
    cusp = np.clip(grades - lag[:, None], -side.length, side.length)
    kinks = np.broadcast_to([-side.length, 0.0, side.length], (len(lag), 3))
    return np.sort(np.concatenate([cusp, kinks], axis=1), axis=1)
