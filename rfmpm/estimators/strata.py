"""Strata of coarse runs: where to cut them, and how many of each to repeat on the study's own cells."""

import numpy as np

STRATA = 3
LEAST_SHARE = 1.0 / 16.0  # of the values in a stratum


def natural_breaks(values: np.ndarray, strata: int = STRATA) -> np.ndarray:
    """Cut values into groups with the least sum of squares about the groups' means: at gaps, where there are some.

    Args:
        values: shape (n,); infinite ones are above every edge.
        strata: number of groups, fewer where too few values differ [-].

    Returns:
        Edges between the groups, ascending, shape (strata - 1,).

    Source: Fisher (1958), J. Am. Stat. Assoc. 53, 789-798.
    """
    x = np.sort(values[np.isfinite(values)])
    least = max(1, round(LEAST_SHARE * values.size))
    starts = np.concatenate([[0], np.flatnonzero(np.diff(x) > 0.0) + 1, [x.size]])
    total, squares = (np.concatenate([[0.0], np.cumsum((x - x[:1].sum()) ** p)])[starts] for p in (1, 2))
    n, sums, inside = (np.subtract.outer(of, of) for of in (starts, total, squares))  # from the second to the first
    inside = np.where(n >= least, inside - sums**2 / np.maximum(n, 1), np.inf)
    # cost of the best division of the first so many values into the groups so far; before: where their last one begins
    cost, before = np.where(starts == 0, 0.0, np.inf), []
    for _ in range(strata):
        divided = inside + cost
        if not np.isfinite(divided[-1].min()):
            break
        before.append(divided.argmin(axis=1))
        cost = divided.min(axis=1)
    edges, place = [], len(starts) - 1
    for origin in reversed(before):
        place = origin[place]
        edges.append(starts[place])
    return np.array([0.5 * (x[k - 1] + x[k]) for k in edges[::-1] if k > 0])


def quotas(taken: np.ndarray, held: np.ndarray, total: int) -> np.ndarray:
    """Divide a number among strata evenly, none below what it has or above what it holds.

    Args:
        taken: that each stratum has already, shape (strata,).
        held: that each holds.
        total: to be divided, at least the sum of `taken`.

    Returns:
        Numbers, shape (strata,), whose sum is the total, or all that is held.
    """
    found = taken.copy()
    while found.sum() < min(total, held.sum()):
        found[np.argmin(np.where(found < held, found, held.max() + 1))] += 1
    return found
