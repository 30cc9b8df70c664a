"""Plain Monte Carlo: equally weighted, independent realisations turned into a mean, a probability or a quantile.

In every function `values` holds one number per realisation, in the order of the indices; NaN marks a realisation that
failed. A failed one has an unknown value and therefore enters a probability as bounds, never as silence. `censored`
marks values known only as "at least this" (the front met the far wall); they count as exceeding every limit.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from rfmpm.estimators.intervals import clopper_pearson, quantile_ranks, student_t, wilson

PROBABILITY_INTERVALS = {"clopper_pearson": clopper_pearson, "wilson": wilson}


@dataclass(frozen=True)
class Estimate:
    """A number with its confidence interval, how it was found and what must be known to read it."""

    value: float
    lower: float
    upper: float
    confidence: float
    n: int  # realisations it rests on, failed ones included where they enter as bounds
    method: str
    note: str = ""
    standard_error: float = float("nan")  # of the value; NaN where the interval does not rest on one


def as_rows(values, censored) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bring rows into one form.

    Args:
        values: one number per realisation, shape (n,); NaN where it failed.
        censored: True where the value is only a lower bound, shape (n,), or None.

    Returns:
        The values, failed and censored (never both), each of shape (n,).

    Raises:
        ValueError: if the two lengths differ.
    """
    values = np.asarray(values, float).ravel()
    failed = np.isnan(values)
    censored = np.zeros(values.shape, bool) if censored is None else np.asarray(censored).astype(bool).ravel()
    if censored.shape != values.shape:
        raise ValueError(f"censored has {censored.size} entries, values {values.size}")
    return values, failed, censored & ~failed


def _note(failed: np.ndarray, censored: np.ndarray, failed_are: str, censored_are: str) -> list[str]:
    parts = []
    if failed.any():
        parts.append(f"{failed.sum()} failed of {failed.size} {failed_are}")
    if censored.any():
        parts.append(f"{censored.sum()} censored {censored_are}")
    return parts


def mean(values, confidence: float = 0.95, censored=None) -> Estimate:
    """Estimate a mean with Student's t interval, which assumes that the sample mean is normally distributed.

    The assumption is exact for normal values and good for some tens of moderately skewed ones.

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed (left out, and said so).
        confidence: level of the interval [-].
        censored: True where the value is only a lower bound, shape (n,), or None.

    Returns:
        Estimate in the unit of the values; with fewer than two completed values its interval is infinite.
    """
    values, failed, censored = as_rows(values, censored)
    completed = values[~failed]
    n = completed.size
    value = float(completed.mean()) if n else float("nan")
    deviation = float(completed.std(ddof=1)) if n > 1 else 0.0
    lower, upper = student_t(value, deviation, n, confidence)
    parts = _note(failed, censored, "left out", "taken at their value, so the mean is a lower bound")
    if n < 2:
        parts.append("fewer than two values: no interval")
    elif np.ptp(completed) == 0.0:
        parts.append("all values are equal: the interval has no width and is not evidence of precision")
    method = "Student t; assumes a normally distributed sample mean"
    return Estimate(value, float(lower), float(upper), confidence, n, method, "; ".join(parts))


def exceedance(
    values, limit: float, censored=None, confidence: float = 0.95, method: str = "clopper_pearson"
) -> Estimate:
    """Estimate the probability that a quantity exceeds a limit.

    The value is the share among the completed realisations. The interval runs from the lower bound with every failed
    realisation counted as not exceeding to the upper bound with every one counted as exceeding.

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed.
        limit: in the unit of the values; a value equal to it does not exceed it.
        censored: True where the value is only a lower bound, shape (n,), or None; such members count as exceeding.
        confidence: level of the interval [-].
        method: "clopper_pearson" (covers at least the level) or "wilson" (covers it on average).

    Returns:
        Estimate [-]; its value is NaN where no realisation completed.

    Raises:
        ValueError: for an unknown method.

    Source: Clopper and Pearson (1934); Wilson (1927).
    """
    if method not in PROBABILITY_INTERVALS:
        raise ValueError(f"method = {method!r}: allowed are {', '.join(PROBABILITY_INTERVALS)}")
    values, failed, censored = as_rows(values, censored)
    n, n_failed = values.size, int(failed.sum())
    count = int(((values > limit) | censored).sum())
    interval = PROBABILITY_INTERVALS[method]
    lower, _ = interval(count, n, confidence)
    _, upper = interval(count + n_failed, n, confidence)
    value = count / (n - n_failed) if n > n_failed else float("nan")
    parts = _note(failed, censored, "counted both ways, which widens the interval", "counted as exceeding")
    return Estimate(value, float(lower), float(upper), confidence, n, method, "; ".join(parts))


def quantile(values, probability: float, censored=None, confidence: float = 0.95) -> Estimate:
    """Estimate a quantile with an interval between two order statistics, which assumes no distribution.

    Args:
        values: one number per realisation, shape (n,); NaN where the realisation failed (as low as can be for the lower
            bound, as high as can be for the upper one).
        probability: of the quantile, e.g. 0.95 [-].
        censored: True where the value is only a lower bound, shape (n,), or None.
        confidence: level of the interval [-].

    Returns:
        Estimate in the unit of the values; a bound that so few values cannot give is infinite.

    Raises:
        ValueError: if the probability is not between 0 and 1.

    Source: David and Nagaraja (2003), Order Statistics, section 7.1.
    """
    if not 0.0 < probability < 1.0:
        raise ValueError(f"probability = {probability}: allowed are values between 0 and 1")
    values, failed, censored = as_rows(values, censored)
    n = values.size
    value = float("nan")
    if not failed.all():
        value = float(np.quantile(values[~failed], probability, method="inverted_cdf"))
    low = np.sort(np.where(failed, -np.inf, values))
    high = np.sort(np.where(failed | censored, np.inf, values))
    lower_rank, upper_rank = quantile_ranks(n, probability, confidence)
    lower = float(low[lower_rank - 1]) if lower_rank > 0 else float("-inf")
    upper = float(high[upper_rank - 1]) if upper_rank <= n else float("inf")
    parts = _note(failed, censored, "counted both ways", "unbounded above")
    return Estimate(value, lower, upper, confidence, n, "order statistics", "; ".join(parts))


def contiguous_prefix(indices: Collection[int]) -> int:
    """Count the indices 0, 1, 2, ... without a gap.

    An estimate may rest on these alone: what is finished beyond a gap was finished because it was quick, and quick
    realisations are not a fair sample.

    Args:
        indices: of the realisations at hand, in any order.

    Returns:
        Length of the unbroken run that starts at 0 [-].
    """
    present = np.unique(np.asarray(indices if isinstance(indices, np.ndarray) else list(indices), int))
    return int(np.sum(present == np.arange(present.size)))


def missing(done: Collection[int], realisations: int) -> list[range]:
    """Name the realisations that are still to be run.

    Args:
        done: indices that have a row already, in any order.
        realisations: number wanted [-].

    Returns:
        The missing indices of 0 to realisations - 1, in ascending order, as ranges.
    """
    present = np.unique(np.asarray(done if isinstance(done, np.ndarray) else list(done), int))
    present = present[(present >= 0) & (present < realisations)]
    edges = np.concatenate([[-1], present, [realisations]])
    before = np.flatnonzero(np.diff(edges) > 1)
    return [range(int(edges[i]) + 1, int(edges[i + 1])) for i in before]
