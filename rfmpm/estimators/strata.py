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
    n, least = x.size, max(1, round(LEAST_SHARE * values.size))
    total, squares = (np.concatenate([[0.0], np.cumsum((x - x.mean()) ** p if n else x)]) for p in (1, 2))
    starts = [0, *(k for k in range(1, n) if x[k - 1] < x[k]), n]
    # cost[j]: of the best division of the first starts[j] values into groups; before: where the last of these begins
    cost, before = np.where(np.array(starts) == 0, 0.0, np.inf), []
    for _ in range(strata):
        following, origin = np.full(cost.shape, np.inf), np.zeros(cost.size, int)
        for j, stop in enumerate(starts):
            for i, start in enumerate(starts[:j]):
                if stop - start < least:
                    break
                inside = squares[stop] - squares[start] - (total[stop] - total[start]) ** 2 / (stop - start)
                if cost[i] + inside < following[j]:
                    following[j], origin[j] = cost[i] + inside, i
        if not np.isfinite(following[-1]):
            break
        cost = following
        before.append(origin)
    edges, j = [], len(starts) - 1
    for origin in reversed(before):
        j = origin[j]
        edges.append(starts[j])
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
