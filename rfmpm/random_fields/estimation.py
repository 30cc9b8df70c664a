"""Trend, variation and vertical scale of fluctuation of a sounding by maximum likelihood.

The logarithm of the variable is a trend plus a normal field with a correlation of the vertical lag. Trend and variance
have closed forms for a given theta (generalised least squares), so that the likelihood is a function of theta alone. It
is the restricted one, of what the trend leaves (Patterson and Thompson 1971; Cressie 1993, section 2.6): the plain one
takes the trend's wandering for its own and finds theta too short. Trends are compared by the plain one (BIC).

An interval holds all theta whose log-likelihood is within `HALF_CHI_SQUARED` of the largest (95 %, profile likelihood).
It is open upwards if the sounding is too short to exclude a long theta; the variance is then open too.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import expm1, inf, log, pi, sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.sounding import Sounding

HALF_CHI_SQUARED = 1.9207294103470618  # half the 95 % quantile of chi squared with one degree of freedom
TRENDS = {"constant": 1, "linear": 2}  # number of coefficients
THETAS, NEAR = 32, 12  # where the likelihood is evaluated, over all theta and around the best; splines between
FINE = 4001
LONGEST = 20.0  # theta looked for, in lengths of the sounding
NUGGET = 1e-9  # of the diagonal: what a smooth correlation needs at close spacing, and no sounding can show


class Interval(NamedTuple):
    """Estimate and the ends of its 95 % interval; an end that the data do not give is 0 or inf."""

    value: float
    low: float
    high: float


class Likelihood(NamedTuple):
    """Profile of the likelihood over theta, for one correlation and one trend.

    Attributes:
        theta: shape (m,) [m].
        plain: logarithm of the largest likelihood for each theta, shape (m,).
        restricted: the same of the restricted likelihood, shape (m,).
        variance: of the logarithm, from the restricted likelihood, shape (m,) [-].
        logdet: what the restricted likelihood owes to theta alone, shape (m,).
        freedom: values less coefficients of the trend.
    """

    theta: np.ndarray
    plain: np.ndarray
    restricted: np.ndarray
    variance: np.ndarray
    logdet: np.ndarray
    freedom: int


@dataclass(frozen=True)
class Estimate:
    """What a sounding says of a variable.

    Attributes:
        correlation: name in `CORRELATIONS`.
        trend: name in `TRENDS`.
        mean: of the variable, in the middle of the sounding [its unit].
        gain: of the mean per metre of depth there [its unit per m].
        coefficient_of_variation: about the trend, with its 95 % interval [-].
        theta: vertical scale of fluctuation, with its 95 % interval [m].
        log_likelihood: the largest restricted one.
        coefficients: of the trend of the logarithm: value in the middle, and gain per metre of depth.
        profile: the likelihood over theta.
    """

    correlation: str
    trend: str
    mean: float
    gain: float
    coefficient_of_variation: Interval
    theta: Interval
    log_likelihood: float
    coefficients: np.ndarray
    profile: Likelihood


def _spread(variance: float) -> float:
    # Coefficient of variation of a lognormal variable.
    return inf if variance > 700.0 else sqrt(expm1(variance))


def choose_trend(sounding: Sounding, correlation: str) -> tuple[str, dict[str, float]]:
    """The trend of lowest BIC under a correlation, and the BIC of each; theta, variance and trend are counted."""
    found = {}
    for trend, coefficients in TRENDS.items():
        best = likelihood(sounding, correlation, trend).plain.max()
        found[trend] = -2.0 * float(best) + (coefficients + 2) * log(len(sounding.value))
    return min(found, key=found.__getitem__), found


def estimate(sounding: Sounding, correlation: str, trend: str) -> Estimate:
    """Estimate by restricted maximum likelihood.

    Args:
        sounding: the sounding.
        correlation: name in `CORRELATIONS`.
        trend: name in `TRENDS`.

    Returns:
        the estimate, with profile likelihood intervals.
    """
    profile = likelihood(sounding, correlation, trend)
    theta = profile_interval(profile.theta, profile.restricted)
    coefficients = _fit(sounding, correlation, trend, theta.value)[0]
    variance = _variance_interval(profile)
    if theta.high == inf:
        variance = variance._replace(high=inf)
    spread = Interval(*(_spread(value) for value in variance))
    mean = float(np.exp(coefficients[0] + 0.5 * variance.value))
    gain = float(mean * coefficients[1]) if trend == "linear" else 0.0
    return Estimate(
        correlation, trend, mean, gain, spread, theta, float(profile.restricted.max()), coefficients, profile
    )


def distinct_correlations() -> list[str]:
    """Names in `CORRELATIONS`, one of those that are the same along a vertical line."""
    lags = np.linspace(0.0, 3.0, 13)
    seen: list[np.ndarray] = []
    names = []
    for name in CORRELATIONS:
        rho = vertical_correlation(name, 1.0, lags)
        if not any(np.allclose(rho, other, atol=1e-12) for other in seen):
            seen.append(rho)
            names.append(name)
    return names


def vertical_correlation(name: str, theta: float, lag: np.ndarray) -> np.ndarray:
    """Correlation at vertical lags, any shape [m]; same shape [-]."""
    lag = np.asarray(lag, dtype=float)
    return CORRELATIONS[name](theta_h=theta, theta_v=theta).rho(np.zeros_like(lag), lag)


def likelihood(sounding: Sounding, correlation: str, trend: str) -> Likelihood:
    """Profile of the likelihood of a sounding over theta, from half a spacing to `LONGEST` lengths."""
    from scipy.interpolate import CubicSpline

    depth = sounding.depth
    length, spacing = float(np.ptp(depth)), float(np.median(np.diff(depth)))
    n, p = len(depth), TRENDS[trend]
    tried = np.geomspace(0.5 * spacing, LONGEST * length, THETAS)
    step = tried[1] / tried[0]
    parts = np.array([_fit(sounding, correlation, trend, theta)[1:] for theta in tried])  # log Q, log dets
    best = tried[np.argmin((n - p) * parts[:, 0] + parts[:, 1] + parts[:, 2])]
    near = best * step ** (3.0 * (np.arange(NEAR) + 0.5) / NEAR - 1.5)  # none of them tried before
    parts = np.vstack([parts, [_fit(sounding, correlation, trend, theta)[1:] for theta in near]])
    tried = np.append(tried, near)
    order = np.argsort(tried)
    theta = np.geomspace(tried.min(), tried.max(), FINE)
    log_squares, logdet, trend_logdet = CubicSpline(np.log(tried[order]), parts[order])(np.log(theta)).T
    plain = -0.5 * (n * (log_squares - log(n) + 1.0 + log(2.0 * pi)) + logdet)
    free = n - p
    owed = logdet + trend_logdet
    restricted = -0.5 * (free * (log_squares - log(free) + 1.0 + log(2.0 * pi)) + owed)
    return Likelihood(theta, plain, restricted, np.exp(log_squares) / free, owed, free)


def profile_interval(parameter: np.ndarray, log_likelihood: np.ndarray) -> Interval:
    """Parameter of largest likelihood and its 95 % interval, from the values at increasing parameters."""
    best = int(np.argmax(log_likelihood))
    inside = np.flatnonzero(log_likelihood >= log_likelihood[best] - HALF_CHI_SQUARED)
    low = 0.0 if inside[0] == 0 else float(parameter[inside[0]])
    high = inf if inside[-1] == len(parameter) - 1 else float(parameter[inside[-1]])
    return Interval(float(parameter[best]), low, high)


def _variance_interval(profile: Likelihood) -> Interval:
    # For a given variance the best theta: sums of squares are known for all theta; every tenth is fine enough.
    squares, logdet = profile.variance[::10] * profile.freedom, profile.logdet[::10]
    best = float(profile.variance[np.argmax(profile.restricted)])
    trial = best * np.geomspace(1e-2, 1e2, 801)
    by_variance = [np.max(-0.5 * (profile.freedom * log(v) + squares / v + logdet)) for v in trial]
    return Interval(best, *profile_interval(trial, np.array(by_variance))[1:])


def _fit(sounding: Sounding, correlation: str, trend: str, theta: float) -> tuple[np.ndarray, float, float, float]:
    # Generalised least squares: coefficients, log sum of squares, log determinants of covariance and of the trend's.
    from scipy.linalg import LinAlgError, cholesky, solve_triangular, toeplitz

    depth = sounding.depth
    shape = np.vander(depth - 0.5 * (depth[0] + depth[-1]), TRENDS[trend], increasing=True)
    n = len(depth)
    steps = np.diff(depth)
    if np.ptp(steps) < 1e-9 * steps[0]:
        matrix = toeplitz(vertical_correlation(correlation, theta, depth - depth[0]))
    else:
        matrix = vertical_correlation(correlation, theta, depth[:, None] - depth[None, :])
    for nugget in (NUGGET, 100.0 * NUGGET):
        matrix[np.diag_indices(n)] += nugget
        try:
            with single_blas_thread():
                lower = cholesky(matrix, lower=True, check_finite=False)
                white = solve_triangular(lower, np.column_stack([shape, np.log(sounding.value)]), lower=True)
        except LinAlgError:
            continue
        q, r = np.linalg.qr(white[:, :-1])
        projected = q.T @ white[:, -1]
        left = white[:, -1] - q @ projected
        squares = max(float(left @ left), 1e-300)
        logdet = 2.0 * float(np.log(np.diag(lower)).sum())
        return np.linalg.solve(r, projected), log(squares), logdet, 2.0 * float(np.log(np.abs(np.diag(r))).sum())
    raise ValueError(f"{correlation} with theta = {theta:g} m is not positive definite on these depths")


def rank_correlations(sounding: Sounding, trend: str, names: Sequence[str]) -> list[Estimate]:
    """Estimates under several correlations, the most likely first; all have the same number of parameters."""
    found = [estimate(sounding, name, trend) for name in names]
    return sorted(found, key=lambda entry: -entry.log_likelihood)
