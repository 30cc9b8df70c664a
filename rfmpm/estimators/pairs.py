"""Two ensembles with the same random numbers, compared realisation by realisation.

What both have of chance falls out of the difference; how much that is depends on how alike the pairs are.
"""

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators.monte_carlo import Estimate, as_rows, mean

PSEUDO_PAIRS = 2.0  # that Agresti and Min add, half of one to each kind of pair


def mean_difference(one, other, confidence: float = 0.95) -> Estimate:
    """Estimate by how much the mean of one ensemble exceeds that of another.

    Args:
        one: one number per realisation, shape (n,); NaN where it failed (its pair is left out).
        other: of the same realisations with other parameters, shape (n,).
        confidence: level of the interval [-].

    Returns:
        Estimate in the unit of the values, with Student's t interval of the paired differences.
    """
    return mean(np.asarray(one, float) - np.asarray(other, float), confidence)


def exceedance_difference(
    one, other, limit: float, one_censored=None, other_censored=None, confidence: float = 0.95
) -> Estimate:
    """Estimate by how much P(X > limit) of one ensemble exceeds that of another.

    Args:
        one: one number per realisation, shape (n,); NaN where it failed (its pair is left out, and said so).
        other: of the same realisations with other parameters, shape (n,).
        limit: in the unit of the values.
        one_censored: True where a value is only a lower bound, shape (n,), or None; such members count as exceeding.
        other_censored: the same of the other.
        confidence: level of the interval [-].

    Returns:
        Estimate [-], with the interval of Agresti and Min; its value is NaN where no pair completed.

    Source: Agresti and Min (2005), Statistics in Medicine 24, 729-740, doi:10.1002/sim.1781.
    """
    one, one_failed, one_censored = as_rows(one, one_censored)
    other, other_failed, other_censored = as_rows(other, other_censored)
    is_whole = ~(one_failed | other_failed)
    here, there = ((one > limit) | one_censored)[is_whole], ((other > limit) | other_censored)[is_whole]
    gained, lost, n = int(np.sum(here & ~there)), int(np.sum(there & ~here)), int(is_whole.sum())
    total = n + PSEUDO_PAIRS
    centre = (gained - lost) / total
    variance = (gained + lost + 0.5 * PSEUDO_PAIRS) / total - centre**2
    half = float(ndtri(0.5 + confidence / 2.0)) * np.sqrt(variance / total)
    lower, upper = (float(np.clip(bound, -1.0, 1.0)) for bound in (centre - half, centre + half)) if n else (-1.0, 1.0)
    failed = is_whole.size - n
    note = f"{failed} pairs of {is_whole.size} with a failed realisation left out" if failed else ""
    return Estimate((gained - lost) / n if n else float("nan"), lower, upper, confidence, n, "Agresti and Min", note)
