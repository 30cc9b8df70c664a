"""Vertical scale of fluctuation of a sounding by fitting the variance function: variance of averages over windows.

Vanmarcke (1977), J. Geotech. Eng. Div. 103(11): the variance of the average over a window falls with its length, the
faster the shorter theta. The fit is quick and shows on one curve whether the correlation suits; its value is lower than
theta for a sounding of few theta, because the trend takes the long waves. The interval corrects for that: it is the
basic parametric bootstrap of the logarithm (Davison and Hinkley 1997, section 5.2), of soundings made with the fitted
theta and treated alike.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.random_fields.estimation import NUGGET, TRENDS, Interval, vertical_correlation
from rfmpm.random_fields.sounding import Sounding

LARGEST_WINDOW = 0.25  # of the length; averages over longer ones are too few to have a variance
WINDOWS = 14
THETAS = 240
LONGEST = 2.0  # theta looked for, in lengths of the sounding
BOOTSTRAP = 400
UNEVEN = 0.01  # relative; spacings that differ by more are interpolated


class WindowFit(NamedTuple):
    """Variance function of a sounding.

    Attributes:
        theta: fitted scale of fluctuation, with its 95 % bootstrap interval [m].
        windows: lengths of the windows, shape (k,) [m].
        found: variance of averages over variance of values, shape (k,) [-].
        fitted: the same for the fitted theta, shape (k,) [-].
        lags: shape (m,) [m].
        autocorrelation: of what the trend leaves, at these lags, shape (m,) [-].
    """

    theta: Interval
    windows: np.ndarray
    found: np.ndarray
    fitted: np.ndarray
    lags: np.ndarray
    autocorrelation: np.ndarray


def fit_variance_function(sounding: Sounding, correlation: str, trend: str) -> WindowFit:
    """Fit theta to the variance function of a sounding by least squares.

    Args:
        sounding: the sounding; uneven spacing is interpolated to even spacing.
        correlation: name in `CORRELATIONS`.
        trend: name in `TRENDS`; fitted by ordinary least squares to the logarithm.

    Returns:
        the fit.
    """
    depth, values = evenly_spaced(sounding)
    n, spacing = len(depth), float(depth[1] - depth[0])
    counts = np.unique(np.geomspace(1, max(LARGEST_WINDOW * n, 4), WINDOWS).astype(int))
    thetas = np.geomspace(0.5 * spacing, LONGEST * n * spacing, THETAS)
    curves = np.array([_variance_of_averages(correlation, theta, spacing, counts) for theta in thetas])
    shape = np.vander(depth - depth.mean(), TRENDS[trend], increasing=True)
    remove = np.linalg.qr(shape)[0]
    left = values - remove @ (remove.T @ values)
    found = _found(left[:, None], counts)
    best = int(_nearest(curves, found)[0])
    matrix = vertical_correlation(correlation, thetas[best], depth[:, None] - depth[None, :])
    lower = np.linalg.cholesky(matrix + NUGGET * np.eye(n))
    again = lower @ np.random.default_rng(n).standard_normal((n, BOOTSTRAP))  # fixed: same sounding, same interval
    again -= remove @ (remove.T @ again)
    refitted = thetas[_nearest(curves, _found(again, counts))]
    theta = float(thetas[best])
    short, long = np.quantile(refitted, [0.025, 0.975])
    lags = np.arange(n // 2)
    autocorrelation = np.array([left[: n - k] @ left[k:] for k in lags]) / (left @ left)
    interval = Interval(theta, theta**2 / float(long), theta**2 / float(short))
    return WindowFit(interval, counts * spacing, found[:, 0], curves[best], lags * spacing, autocorrelation)


def evenly_spaced(sounding: Sounding) -> tuple[np.ndarray, np.ndarray]:
    """Depths [m] and logarithms of the values, both of shape (n,), interpolated if the spacing is uneven."""
    depth, values = sounding.depth, np.log(sounding.value)
    steps = np.diff(depth)
    if np.ptp(steps) <= UNEVEN * np.median(steps):
        return depth, values
    even = np.linspace(depth[0], depth[-1], round(np.ptp(depth) / float(np.median(steps))) + 1)
    return even, np.interp(even, depth, values)


def _variance_of_averages(correlation: str, theta: float, spacing: float, counts: np.ndarray) -> np.ndarray:
    # Of k values: (1 + 2 sum (1 - j / k) rho_j) / k.
    rho = vertical_correlation(correlation, theta, spacing * np.arange(counts[-1]))
    first, second = np.cumsum(rho), np.cumsum(np.arange(len(rho)) * rho)
    k = counts.astype(float)
    return (2.0 * (first[counts - 1] - second[counts - 1] / k) - 1.0) / k


def _found(left: np.ndarray, counts: np.ndarray) -> np.ndarray:
    # Variance function of columns, shape (number of windows, number of columns).
    sums = np.vstack([np.zeros((1, left.shape[1])), np.cumsum(left, axis=0)])
    variance = (left**2).mean(axis=0)
    return np.array([(((sums[k:] - sums[:-k]) / k) ** 2).mean(axis=0) / variance for k in counts])


def _nearest(curves: np.ndarray, found: np.ndarray) -> np.ndarray:
    # Index of the curve, of shape (number of thetas, number of windows), nearest to each column.
    distance = (curves**2).sum(axis=1)[:, None] - 2.0 * curves @ found
    return np.argmin(distance, axis=0)
