"""Which levels pay, and how many indices each of them should have, from measured variances and work."""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from rfmpm.estimators.levels import terms

LARGEST_RATIO = 256.0  # of the numbers of a coarser level and level 0
GAIN_TO_ADD = 0.95  # cost that a further level has to save, as a share: a pilot is noisy


class Allocation(NamedTuple):
    """Levels to be used and how they share the work.

    Attributes:
        levels: 0 and those coarser ones that pay, ascending.
        ratio: number of indices of each over that of level 0 [-].
        variance: what each level adds to the variance of the estimate, times its number of indices.
    """

    levels: tuple[int, ...]
    ratio: np.ndarray
    variance: np.ndarray

    def variance_with(self, numbers: Sequence[float]) -> float:
        """Return the variance of the estimate with these numbers of indices on the levels used."""
        return float(np.sum(self.variance / np.asarray(numbers, float)))


def allocate(
    outcomes: Sequence[np.ndarray],
    work: Sequence[float],
    levels: Sequence[int],
    features: np.ndarray | None,
    is_probability: bool,
    is_fitted: bool,
) -> Allocation:
    """Share the work between given levels so that the variance is least.

    Args:
        outcomes: per level of the study, shape (n_level, 1), the indices from 0 on; NaN where it failed.
        work: per level of the study, what one simulation costs, any unit.
        levels: to be used, ascending from 0.
        features: known-mean features of the fields, as many lines as the longest of the outcomes; None for none.
        is_probability: whether the outcomes are indicators.
        is_fitted: whether coefficients are fitted.

    Returns:
        Allocation; numbers never fall towards the coarser levels.

    Source: Giles (2015), Acta Numerica 24, section 3.1, with the levels' covariances, since indices are common to them.
    """
    chosen = [outcomes[level] for level in levels]
    lines = None if features is None else features[: len(chosen[-1])]
    found = terms(chosen, lines, is_probability, is_fitted)
    common = min(len(y) for y in chosen)
    present = np.flatnonzero(~np.isnan(chosen[0][:common, 0]))
    cumulated = np.cumsum([bracket[present, 0] for bracket in found.bracket], axis=0)
    total = cumulated.var(axis=1, ddof=1) if present.size > 1 else np.zeros(len(chosen))
    variance = np.diff(total, prepend=0.0)
    cost = np.array([work[level] for level in levels], float)
    share = np.sqrt(np.maximum(variance, 1e-6 * max(total[-1], 1e-300)) / cost)
    ratio = np.maximum.accumulate(np.minimum(share / share[0], LARGEST_RATIO))
    return Allocation(tuple(levels), ratio, np.maximum(variance, 0.0))


def choose_levels(
    outcomes: Sequence[np.ndarray],
    work: Sequence[float],
    features: np.ndarray | None,
    is_probability: bool,
    is_fitted: bool,
) -> Allocation:
    """Find the levels with which a given variance costs least; arguments as of `allocate`.

    Returns:
        Allocation; level 0 alone where no coarser one saves work.
    """
    best, least = None, np.inf
    for number in range(len(outcomes)):
        for coarser in combinations(range(1, len(outcomes)), number):
            levels = (0, *coarser)
            found = allocate(outcomes, work, levels, features, is_probability, is_fitted)
            cost = np.sum(found.variance / found.ratio) * np.sum(found.ratio * [work[level] for level in levels])
            if best is None or cost < GAIN_TO_ADD * least:
                best, least = found, cost
    return best
