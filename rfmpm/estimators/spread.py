"""The standard deviation of independent realisations, with an interval that does not assume a normal distribution."""

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators.monte_carlo import Estimate, as_rows

FEWEST = 5  # values with which Bonett's trimmed mean exists


def standard_deviation(values, confidence: float = 0.95) -> Estimate:
    """Estimate a standard deviation with Bonett's interval, which takes the kurtosis from the values themselves.

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed (left out).
        confidence: level of the interval [-].

    Returns:
        Estimate in the unit of the values; with fewer than five completed values its interval runs from 0 to infinity.

    Source: Bonett (2006), Computational Statistics and Data Analysis 50, 775-782, doi:10.1016/j.csda.2004.10.003.
    """
    values, failed, _ = as_rows(values, None)
    completed = values[~failed]
    n = completed.size
    value = float(np.std(completed, ddof=1)) if n > 1 else float("nan")
    method, note = "Bonett", f"{failed.sum()} failed of {failed.size} left out" if failed.any() else ""
    if n < FEWEST:
        return Estimate(value, 0.0, float("inf"), confidence, n, method, note)
    if np.ptp(completed) == 0.0:
        return Estimate(0.0, 0.0, 0.0, confidence, n, method, note)
    z = float(ndtri(0.5 + confidence / 2.0))
    trimmed = _trimmed_mean(completed, 0.5 / np.sqrt(n - 4))
    kurtosis = n * np.sum((completed - trimmed) ** 4) / np.sum((completed - completed.mean()) ** 2) ** 2
    small_sample = n / (n - z)
    half = z * small_sample * np.sqrt((kurtosis - (n - 3) / n) / (n - 1))
    lower, upper = value * np.sqrt(small_sample * np.exp([-half, half]))
    return Estimate(value, float(lower), float(upper), confidence, n, method, note)


def _trimmed_mean(values: np.ndarray, share: float) -> float:
    """Mean without the share of the values at either end."""
    cut = int(share * values.size)
    return float(np.mean(np.sort(values)[cut : values.size - cut]))
