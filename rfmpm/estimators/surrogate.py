"""Smooth stand-ins for indicators: how likely a limit is exceeded, given a prediction of the quantity.

The best control variate for 1{Y > l} from a prediction u is P(Y > l | u), a smooth step of u, not 1{u > l}: near the
limit the sharp one is wrong about half of the time.
"""

import numpy as np
from scipy.special import ndtr

WIDTHS = np.array([0.02, 0.25, 0.5, 1.0, 1.5])  # of the step, in standard deviations of the prediction's error


def steps(prediction: np.ndarray, limits: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return normal distribution functions of (prediction - limit) / width, shape (n, k)."""
    return ndtr((prediction[:, None] - limits) / width)


def steps_mean(mean: float, deviation: float, limits: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return the expectation of `steps` over a normally distributed prediction, shape (k,)."""
    return ndtr((mean - limits) / np.hypot(width, deviation))


def widths(outcome: np.ndarray, prediction: np.ndarray, limits: np.ndarray, error: float) -> np.ndarray:
    """Choose the width of the step for each limit by how closely the steps follow the outcomes.

    Args:
        outcome: indicators or steps to be explained, shape (n, k).
        prediction: of the quantity, shape (n,).
        limits: shape (k,), unit of the quantity.
        error: standard deviation of the prediction's error, unit of the quantity.

    Returns:
        Widths, shape (k,), unit of the quantity, greater than 0.
    """
    centred = outcome - outcome.mean(axis=0)
    least, chosen = np.full(limits.shape, np.inf), np.full(limits.shape, 1.0)
    for width in np.maximum(WIDTHS * error, 1e-9 * max(1.0, float(np.max(np.abs(limits))))):
        step = steps(prediction, limits, np.full(limits.shape, width))
        rest = np.sum((centred - step + step.mean(axis=0)) ** 2, axis=0)
        chosen = np.where(rest < least, width, chosen)
        least = np.minimum(rest, least)
    return chosen


def line(target: np.ndarray, regressor: np.ndarray) -> tuple[float, float, float]:
    """Fit target = constant + slope * regressor over the finite pairs.

    Returns:
        Constant, slope and the standard deviation of the rest; constant and slope 0 and 1 where nothing can be fitted.
    """
    finite = np.isfinite(target) & np.isfinite(regressor)
    if finite.sum() < 3 or np.ptp(regressor[finite]) == 0.0:
        return 0.0, 1.0, 1.0
    slope, constant = np.polyfit(regressor[finite], target[finite], 1)
    rest = target[finite] - constant - slope * regressor[finite]
    return float(constant), float(slope), float(np.sqrt(np.sum(rest**2) / (finite.sum() - 2)))
