"""Curves with bands: the exceedance curve, and how a mean or a probability settles as realisations are added.

Values, failed and censored realisations are as in `monte_carlo`.
"""

from dataclasses import dataclass

import numpy as np

from rfmpm.estimators.intervals import clopper_pearson, dkw_half_width, student_t
from rfmpm.estimators.monte_carlo import as_rows


@dataclass(frozen=True)
class Band:
    """A curve with a pointwise band and, where it has one, a simultaneous band (all arrays of shape (k,))."""

    at: np.ndarray
    value: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    confidence: float
    simultaneous_lower: np.ndarray | None = None
    simultaneous_upper: np.ndarray | None = None


def exceedance_curve(values, limits=None, censored=None, confidence: float = 0.95) -> Band:
    """Estimate P(X > l) as a function of l, with a band for each l (Clopper-Pearson) and one for all l at once (DKW).

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed (counted both ways).
        limits: shape (k,), unit of the values; None takes every distinct value, where the curve has its steps.
        censored: True where the value is only a lower bound, shape (n,), or None.
        confidence: level of both bands [-].

    Returns:
        Band over the limits; a step function, constant from each limit up to the next.

    Source: Clopper and Pearson (1934); Massart (1990).
    """
    values, failed, censored = as_rows(values, censored)
    limits = np.unique(values[~failed]) if limits is None else np.asarray(limits, float)
    n, n_failed = values.size, int(failed.sum())
    known = np.sort(np.where(censored, np.inf, values)[~failed])
    count = known.size - np.searchsorted(known, limits, side="right")
    lower, _ = clopper_pearson(count, n, confidence)
    _, upper = clopper_pearson(count + n_failed, n, confidence)
    half = dkw_half_width(n, confidence)
    value = count / known.size if known.size else np.full(limits.shape, np.nan)
    trials = max(n, 1)
    return Band(
        at=limits,
        value=value,
        lower=lower,
        upper=upper,
        confidence=confidence,
        simultaneous_lower=np.clip(count / trials - half, 0.0, 1.0),
        simultaneous_upper=np.clip((count + n_failed) / trials + half, 0.0, 1.0),
    )


def running_mean(values, confidence: float = 0.95, at=None) -> Band:
    """Follow the mean and its Student t interval as realisations are added in the order of their indices.

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed (left out).
        confidence: level of the band [-].
        at: numbers of realisations for which the band is wanted, shape (k,), each 1 to n; None for all of them.

    Returns:
        Band over `at`; NaN before the first completed one.
    """
    values, failed, _ = as_rows(values, None)
    at = np.arange(1, values.size + 1) if at is None else np.asarray(at)
    n = np.cumsum(~failed)
    # Sums of deviations from the overall mean: sums of the squares themselves would cancel.
    shift = float(values[~failed].mean()) if n.size and n[-1] else 0.0
    deviation = np.where(failed, 0.0, values - shift)
    total, squares = np.cumsum(deviation)[at - 1], np.cumsum(deviation**2)[at - 1]
    n = n[at - 1]
    trials = np.maximum(n, 1)
    value = np.where(n > 0, shift + total / trials, np.nan)
    variance = np.maximum(squares - total**2 / trials, 0.0) / np.maximum(n - 1, 1)
    lower, upper = student_t(value, np.sqrt(variance), n, confidence)
    return Band(at, value, lower, upper, confidence)


def running_exceedance(values, limit: float, censored=None, confidence: float = 0.95, at=None) -> Band:
    """Follow P(X > limit) and its Clopper-Pearson interval as realisations are added in the order of their indices.

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed (counted both ways).
        limit: in the unit of the values.
        censored: True where the value is only a lower bound, shape (n,), or None.
        confidence: level of the band at each number of realisations, not of all at once [-].
        at: numbers of realisations for which the band is wanted, shape (k,), each 1 to n; None for all of them.

    Returns:
        Band over `at`; the value is NaN before the first completed one.
    """
    values, failed, censored = as_rows(values, censored)
    n = np.arange(1, values.size + 1) if at is None else np.asarray(at)
    count, n_failed = np.cumsum((values > limit) | censored)[n - 1], np.cumsum(failed)[n - 1]
    lower, _ = clopper_pearson(count, n, confidence)
    _, upper = clopper_pearson(count + n_failed, n, confidence)
    value = np.where(n > n_failed, count / np.maximum(n - n_failed, 1), np.nan)
    return Band(n, value, lower, upper, confidence)
