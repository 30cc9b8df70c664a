"""Which levels pay, and how many indices each of them should have, from measured variances and work."""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from rfmpm.estimators.levels import Nested, terms

LARGEST_RATIO = 256.0  # of the numbers of a coarser level and level 0
GAIN_TO_ADD = 0.9  # cost with a further level over that without it, at most: variances of a pilot are noisy


class Allocation(NamedTuple):
    """Levels to be used and how they share the work.

    Attributes:
        levels: 0 and those coarser ones that are used, ascending.
        ratio: number of indices of each over that of level 0 [-].
        variance: what each level adds to the variance of the estimate, times its number of indices.
    """

    levels: tuple[int, ...]
    ratio: np.ndarray
    variance: np.ndarray


def allocate(nested: Nested, work: Sequence[float], levels: Sequence[int]) -> Allocation:
    """Share the work between given levels so that the variance is least.

    Args:
        nested: the simulations at hand, all levels of the study; one function.
        work: per level of the study, what one simulation costs, any unit.
        levels: to be used, ascending from 0.

    Returns:
        Allocation; numbers never fall towards the coarser levels.

    Source: Giles (2015), Acta Numerica 24, section 3.1, with the levels' covariances, since indices are common to them.
    """
    chosen = nested.chosen(levels)
    found = terms(chosen)
    present = np.flatnonzero(chosen.present)
    cumulated = np.cumsum([bracket[present, 0] for bracket in found.bracket], axis=0)
    total = cumulated.var(axis=1, ddof=1) if present.size > 1 else np.zeros(len(levels))
    variance = np.diff(total, prepend=0.0)
    if nested.is_probability:  # no difference among n rows does not mean that there is none
        variance = np.maximum(variance, 1.0 / max(present.size, 1))
    cost = np.array([work[level] for level in levels], float)
    share = np.sqrt(np.maximum(variance, 1e-6 * max(total[-1], 1e-300)) / cost)
    # Whole powers of 2: numbers that followed the variances closely would be larger where the values so far are by
    # chance, and such a dilution of some outcomes only is a bias. The variance is a few per cent above the least.
    powers = np.round(np.log2(np.clip(share / share[0], 1.0, LARGEST_RATIO)))
    ratio = np.maximum.accumulate(2.0**powers)
    return Allocation(tuple(levels), ratio, np.maximum(variance, 0.0))


def choose_levels(nested: Nested, work: Sequence[float], candidates: Sequence[int]) -> Allocation:
    """Find the levels with which a given variance costs least.

    Args:
        nested: the simulations at hand, all levels of the study; one function.
        work: per level of the study, what one simulation costs, any unit.
        candidates: levels with at least as many indices as level 0, which is one of them.

    Returns:
        Allocation; level 0 alone where no coarser one saves work.
    """
    best, least = None, np.inf
    for number in range(len(candidates)):
        for coarser in combinations(candidates[1:], number):
            found = allocate(nested, work, (0, *coarser))
            cost = np.sum(found.variance / found.ratio) * np.sum(found.ratio * [work[k] for k in found.levels])
            if best is None or cost < GAIN_TO_ADD * least:
                best, least = found, cost
    return best
