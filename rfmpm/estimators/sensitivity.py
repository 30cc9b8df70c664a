"""Shares of the variance of a quantity that groups of uncertain variables have: Sobol indices with their intervals.

From a design of whole base points: first-order indices by Saltelli et al. (2010, Computer Physics Communications 181,
table 2, b), total ones by Jansen (1999, Computer Physics Communications 117). From any independent realisations:
first-order indices of single numbers from the spread between classes of equal size (Plischke, Borgonovo and Smith 2013,
European Journal of Operational Research 226), less what chance gives.
"""

from dataclasses import dataclass

import numpy as np

from rfmpm.estimators.rows import Rows

RESAMPLES = 1000
SEED = 20101  # of resampling: the same rows give the same intervals
FEWEST_CLASSES, MOST_CLASSES, ROWS_OF_A_CLASS = 4, 30, 20
FEWEST = 20  # base points, or rows, from which intervals are given


@dataclass(frozen=True)
class Design:
    """Outcomes by base point and block.

    Attributes:
        values: shape (n, groups + 2): blocks A, B and A with one group from B.
        dropped: base points left out, as a simulation of theirs failed.
        unfinished: base points left out, as a simulation of theirs is missing.
    """

    values: np.ndarray
    dropped: int
    unfinished: int


@dataclass(frozen=True)
class SobolIndices:
    """Indices of each group, shape (groups,) each [-]; NaN where nothing varies, intervals too where there are too few.

    Attributes:
        first, total: first-order and total indices.
        first_interval, total_interval: shape (groups, 2).
        base_points: that they rest on.
        dropped: base points with failed simulations, left out.
    """

    first: np.ndarray
    total: np.ndarray
    first_interval: np.ndarray
    total_interval: np.ndarray
    base_points: int
    dropped: int


@dataclass(frozen=True)
class GivenData:
    """First-order indices from independent realisations, shape (k,) each [-].

    Attributes:
        first: first-order indices; what chance gives is taken off, so that they may be negative.
        interval: shape (k, 2).
        noise: what an index stays below in 95 % of cases where the quantity does not depend on the number.
        rows: completed ones that they rest on.
        dropped: failed rows, left out.
    """

    first: np.ndarray
    interval: np.ndarray
    noise: np.ndarray
    rows: int
    dropped: int


def arrange(rows: Rows, groups: int) -> Design:
    """Arrange the rows of a design by base point and block.

    Args:
        rows: of the design; level 0 is taken.
        groups: of variables.

    Returns:
        The whole base points in order.
    """
    own = rows.on_level(0)
    base, block = np.divmod(own.index, groups + 2)
    shape = int(base.max(initial=-1)) + 1, groups + 2
    values, is_finished = np.full(shape, np.nan), np.zeros(shape, bool)
    values[base, block], is_finished[base, block] = own.value, True
    is_whole = is_finished.all(axis=1)
    is_good = ~np.isnan(values).any(axis=1)
    return Design(values[is_good], int(np.sum(is_whole & ~is_good)), int(np.sum(~is_whole)))


def sobol_indices(design: Design, confidence: float = 0.95) -> SobolIndices:
    """Estimate first-order and total indices of every group.

    Args:
        design: outcomes by base point and block.
        confidence: of the intervals [-]; percentiles of resampled base points.

    Returns:
        The indices.
    """
    count, groups = len(design.values), design.values.shape[1] - 2
    centred = design.values - (design.values[:, :2].mean() if count else 0.0)
    a, b, exchanged = centred[:, :1], centred[:, 1:2], centred[:, 2:]
    terms = np.hstack([b * (exchanged - a), 0.5 * (a - exchanged) ** 2, 0.5 * (a + b), 0.5 * (a**2 + b**2)])
    nothing = np.full(2 * groups, np.nan)
    found = _ratios(terms.mean(axis=0), groups) if count else nothing
    interval = np.tile(nothing, (2, 1))
    if count >= FEWEST and not np.isnan(found).any():
        again = np.array([_ratios(mean, groups) for mean in _resampled_means(terms)])
        interval = np.nanquantile(again, [0.5 * (1.0 - confidence), 0.5 * (1.0 + confidence)], axis=0)
    return SobolIndices(
        found[:groups], found[groups:], interval[:, :groups].T, interval[:, groups:].T, count, design.dropped
    )


def _ratios(means: np.ndarray, groups: int) -> np.ndarray:
    variance = means[-1] - means[-2] ** 2
    return means[: 2 * groups] / variance if variance > 1e-14 * means[-1] else np.full(2 * groups, np.nan)


def _resampled_means(terms: np.ndarray) -> np.ndarray:
    """Means over base points drawn with replacement, shape (RESAMPLES, columns)."""
    count, rng = len(terms), np.random.default_rng(SEED)
    return np.array([terms[rng.integers(count, size=count)].mean(axis=0) for _ in range(RESAMPLES)])


def given_data_indices(numbers: np.ndarray, rows: Rows, confidence: float = 0.95) -> GivenData:
    """Estimate first-order indices of uncertain numbers from independent realisations.

    Args:
        numbers: values of the k numbers in each row, shape (n, k) [any unit].
        rows: n rows of independent realisations on one level.
        confidence: of the intervals [-].

    Returns:
        The indices.

    Raises:
        ValueError: if there are not as many lines of numbers as rows.
    """
    if len(numbers) != len(rows.value):
        raise ValueError(f"{len(numbers)} lines of uncertain numbers for {len(rows.value)} rows")
    y = rows.value
    is_good = ~np.isnan(y) & ~np.isnan(numbers).any(axis=1)
    x, y, dropped = numbers[is_good], y[is_good], int(np.sum(~is_good))
    count, width = x.shape
    if count < FEWEST or np.ptp(y) == 0.0:
        nothing = np.full(width, np.nan)
        return GivenData(nothing, np.tile(nothing, (2, 1)).T, nothing, count, dropped)
    classes = int(np.clip(count // ROWS_OF_A_CLASS, FEWEST_CLASSES, MOST_CLASSES))
    class_of = _ranks(x).astype(int) * classes // count
    rng = np.random.default_rng(SEED)
    drawn = rng.integers(count, size=(RESAMPLES, count))
    shuffled = rng.permuted(np.tile(y, (RESAMPLES, 1)), axis=1)
    first, interval, noise = [], [], []
    tail = 0.5 * (1.0 - confidence)
    for own in class_of.T:
        found = _between(own[None], y[None], classes)[0]
        again = _between(own[drawn], y[drawn], classes)
        # Resampling adds the spread between classes that chance gives once more: only the width of its spread counts.
        low, high = np.quantile(again - np.median(again), [tail, 1.0 - tail])
        first.append(found)
        interval.append((found + low, found + high))
        noise.append(np.quantile(_between(np.broadcast_to(own, shuffled.shape), shuffled, classes), 0.95))
    return GivenData(np.array(first), np.array(interval), np.array(noise), count, dropped)


def _between(class_of: np.ndarray, y: np.ndarray, classes: int) -> np.ndarray:
    """Share of the variance between classes less what chance gives (Kelley's epsilon squared), one for each line."""
    lines, count = y.shape
    flat = (class_of + classes * np.arange(lines)[:, None]).ravel()
    sizes = np.bincount(flat, minlength=lines * classes).reshape(lines, classes)
    sums = np.bincount(flat, y.ravel(), lines * classes).reshape(lines, classes)
    total = np.sum((y - y.mean(axis=1, keepdims=True)) ** 2, axis=1)
    between = np.sum(sums**2 / np.maximum(sizes, 1), axis=1) - sums.sum(axis=1) ** 2 / count
    within = (total - between) / (count - classes)
    with np.errstate(invalid="ignore", divide="ignore"):
        return (between - (classes - 1) * within) / total


def _ranks(x: np.ndarray) -> np.ndarray:
    """Places in ascending order along the first axis, from 0."""
    return np.argsort(np.argsort(x, axis=0, kind="stable"), axis=0, kind="stable").astype(float)
