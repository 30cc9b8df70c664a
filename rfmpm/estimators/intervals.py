"""Confidence intervals of a count, a mean, a distribution function and a quantile; every function takes arrays."""

import numpy as np
from scipy.special import bdtr, betaincinv, ndtri, stdtrit


def clopper_pearson(count, n, confidence: float = 0.95) -> tuple[np.ndarray, np.ndarray]:
    """Return the exact interval of a binomial probability: it covers at least `confidence` for every probability.

    Args:
        count: number of successes, any shape [-].
        n: number of trials, broadcast against `count` [-]; with n = 0 the interval is 0 to 1.
        confidence: level, e.g. 0.95 [-].

    Returns:
        Lower and upper bound, broadcast shape [-].

    Source: Clopper and Pearson (1934), Biometrika 26, doi:10.1093/biomet/26.4.404.
    """
    count, n = np.broadcast_arrays(np.asarray(count, float), np.asarray(n, float))
    tail = (1.0 - confidence) / 2.0
    # Where count is 0 or n the bound is exact; the other arguments keep the beta function inside its domain.
    lower = np.where(count > 0, betaincinv(np.maximum(count, 1.0), n - count + 1.0, tail), 0.0)
    upper = np.where(count < n, betaincinv(count + 1.0, np.maximum(n - count, 1.0), 1.0 - tail), 1.0)
    return lower, upper


def wilson(count, n, confidence: float = 0.95) -> tuple[np.ndarray, np.ndarray]:
    """Return the score interval of a binomial probability: it covers `confidence` on average, not for each probability.

    Args:
        count: number of successes, any shape [-].
        n: number of trials, broadcast against `count` [-]; with n = 0 the interval is 0 to 1.
        confidence: level [-].

    Returns:
        Lower and upper bound, broadcast shape [-].

    Source: Wilson (1927), J. Am. Stat. Assoc. 22, doi:10.1080/01621459.1927.10502953.
    """
    count, n = np.broadcast_arrays(np.asarray(count, float), np.asarray(n, float))
    z = ndtri(0.5 + confidence / 2.0)
    trials = np.maximum(n, 1.0)
    share = count / trials
    centre = (share + z**2 / (2.0 * trials)) / (1.0 + z**2 / trials)
    half = z * np.sqrt(share * (1.0 - share) / trials + z**2 / (4.0 * trials**2)) / (1.0 + z**2 / trials)
    # At count 0 and n the bound is 0 and 1 exactly; rounding would leave it a hair inside or outside.
    lower = np.where(count > 0, centre - half, 0.0)
    upper = np.where(count < n, centre + half, 1.0)
    return lower, upper


def student_t(mean, standard_deviation, n, confidence: float = 0.95) -> tuple[np.ndarray, np.ndarray]:
    """Return the interval of a mean, assuming that the mean of n independent values is normally distributed.

    Args:
        mean: sample mean, any shape.
        standard_deviation: sample standard deviation (divisor n - 1), same shape and unit.
        n: number of values, same shape [-]; with fewer than two the interval is infinite.
        confidence: level [-].

    Returns:
        Lower and upper bound, same shape and unit as the mean.

    Source: Student (1908), Biometrika 6, doi:10.1093/biomet/6.1.1.
    """
    mean, deviation, n = np.broadcast_arrays(*(np.asarray(a, float) for a in (mean, standard_deviation, n)))
    enough = n > 1
    factor = stdtrit(np.where(enough, n - 1.0, 1.0), 0.5 + confidence / 2.0)
    half = np.where(enough, factor * np.where(enough, deviation, 0.0) / np.sqrt(np.maximum(n, 1.0)), np.inf)
    centre = np.where(enough, mean, 0.0)
    return centre - half, centre + half


def dkw_half_width(n: int, confidence: float = 0.95) -> float:
    """Return the half width of the band that holds a whole distribution function at once with the given confidence.

    Args:
        n: number of independent values [-]; with n = 0 the band is everything.
        confidence: level [-].

    Returns:
        Half width [-], at most 1.

    Source: Dvoretzky, Kiefer and Wolfowitz (1956); constant by Massart (1990), doi:10.1214/aop/1176990746.
    """
    return 1.0 if n == 0 else min(1.0, float(np.sqrt(np.log(2.0 / (1.0 - confidence)) / (2.0 * n))))


def quantile_ranks(n: int, probability: float, confidence: float = 0.95) -> tuple[int, int]:
    """Return the ranks of the two order statistics that enclose a quantile, whatever the distribution.

    Args:
        n: number of independent values [-].
        probability: of the quantile, between 0 and 1 [-].
        confidence: level [-].

    Returns:
        Ranks counted from 1; 0 means "no lower bound", n + 1 "no upper bound" (too few values for one).

    Source: David and Nagaraja (2003), Order Statistics, section 7.1.
    """
    tail = (1.0 - confidence) / 2.0
    cumulated = bdtr(np.arange(n + 1), n, probability)
    lower = int(np.searchsorted(cumulated, tail))
    upper = int(np.searchsorted(cumulated, 1.0 - tail)) + 1
    return lower, min(upper, n + 1)
