"""Nested simulations on several levels, and known-mean features of the fields, as contributions of their indices.

    estimate = mean of [y0 - a1 (y1 - m1) - b0 eta] over the indices of level 0
             + a1 mean of [(y1 - m1) - a2 (y2 - m2) - b1 eta] over those of level 1 + ...

Every index of a level is also one of each coarser level, so an index is the independent unit. The coefficients a, b and
the centres m of an index come from the other folds (index modulo FOLDS) alone. Given these, each bracket has the
expectation of its finest term, less what the next mean gives back, whatever the coefficients: the estimate is unbiased.
A coarse simulation may be any function of the field, so a failed one is *defined*: its value is the centre m of its fold,
its indicators are 1. An index whose simulation on level 0 failed counts on the coarser levels only.

Source: Giles (2015), Acta Numerica 24, 259-328; Peherstorfer, Willcox and Gunzburger (2016), SIAM J. Sci. Comput. 38,
A3163-A3194; cross-fitting: Chernozhukov et al. (2018), Econometrics Journal 21, C1-C68.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rfmpm.estimators.contributions import Contributions, Counts
from rfmpm.estimators.regression import Fit, fit

FOLDS = 8
FEWEST_TO_FIT = 12  # completed indices on level 0; with fewer no coefficient is fitted and no coarser level is used


@dataclass(frozen=True)
class Terms:
    """The bracket of each level and index, times the coefficients before it.

    Attributes:
        bracket: per level, shape (n_level, k).
        weight: per level, share of the estimate that each index has, shape (n_level,); 0 where level 0 failed.
        scale: per level, coefficient with which the level's indicators enter the estimate, shape (k,).
    """

    bracket: list[np.ndarray]
    weight: list[np.ndarray]
    scale: list[np.ndarray]


def usable(outcomes: Sequence[np.ndarray]) -> list[int]:
    """Return the levels that an estimate can use: 0, and each that has at least two more indices than the one before.

    Args:
        outcomes: per level, shape (n_level, k); n_level indices from 0 on.
    """
    chain = [0]
    for level in range(1, len(outcomes)):
        if len(outcomes[level]) >= len(outcomes[chain[-1]]) + 2:
            chain.append(level)
    return chain


def terms(outcomes: Sequence[np.ndarray], features: np.ndarray | None, is_probability: bool, is_fitted: bool) -> Terms:
    """Evaluate the brackets of every index, with coefficients from the other folds.

    Args:
        outcomes: per level from the finest on, shape (n_level, k) with n_level not decreasing; NaN where it failed.
        features: of the coarsest level's indices, known mean 0, shape (n_coarsest, d); None for none.
        is_probability: whether the outcomes are indicators.
        is_fitted: whether the coefficients a are fitted; otherwise they are 1.

    Returns:
        Terms.
    """
    present = ~np.isnan(outcomes[0][:, 0])
    fold = np.arange(len(outcomes[-1])) % FOLDS
    can_fit = int(present.sum()) >= FEWEST_TO_FIT
    bracket = [np.zeros(y.shape) for y in outcomes]
    weight = [np.zeros(len(y)) for y in outcomes]
    scale = [np.zeros(outcomes[0].shape[1]) for _ in outcomes]
    for f in range(FOLDS):
        share = float(np.mean(fold[: len(present)][present] == f)) if present.any() else 0.0
        others = fold != f
        centred = _centred(outcomes, others, is_probability)
        factor = np.ones(outcomes[0].shape[1])
        for level, y in enumerate(centred):
            mine = ~others[: len(y)] & (present if level == 0 else True)
            known = others[: len(y)] & (present if level == 0 else True)
            coarser = centred[level + 1][: len(y)] if level + 1 < len(centred) else None
            found = _coefficients(y, coarser, features, known, is_fitted, can_fit)
            rest = y[mine] - features[: len(y)][mine] @ found.weights if features is not None else y[mine]
            if coarser is not None:
                rest = rest - found.slope * coarser[mine]
            bracket[level][mine] = factor * rest
            weight[level][mine] = share / max(int(mine.sum()), 1)
            scale[level] += share * factor
            factor = factor * found.slope
    return Terms(bracket, weight, scale)


def _centred(outcomes: Sequence[np.ndarray], others: np.ndarray, is_probability: bool) -> list[np.ndarray]:
    """Level 0 as it is, the others less their mean over the other folds, failed ones as defined."""
    centred = [outcomes[0]]
    for y in outcomes[1:]:
        if is_probability:
            y = np.where(np.isnan(y), 1.0, y)
        elsewhere = y[others[: len(y)]]
        completed = elsewhere[~np.isnan(elsewhere[:, 0])]
        centre = completed.mean(axis=0) if len(completed) else np.zeros(y.shape[1])
        centred.append(np.where(np.isnan(y), 0.0, y - centre))
    return centred


def _coefficients(y, coarser, features, known, is_fitted: bool, can_fit: bool) -> Fit:
    """Slope on the coarser level and weights of the features, from the rows that are `known`."""
    k, d = y.shape[1], 0 if features is None else features.shape[1]
    if not can_fit:
        return Fit(np.full(k, 0.0 if is_fitted else 1.0), np.zeros((d, k)))
    here = None if features is None else features[: len(y)][known]
    if is_fitted:
        return fit(y[known], None if coarser is None else coarser[known], here)
    found = fit(y[known] - (0.0 if coarser is None else coarser[known]), None, here)
    return Fit(np.ones(k), found.weights)


def contributions(
    outcomes: Sequence[np.ndarray], features: np.ndarray | None, is_probability: bool, is_fitted: bool
) -> Contributions:
    """Return what every index adds to the estimated expectations; arguments as of `terms`.

    Returns:
        Contributions of the indices of the coarsest level; without a completed one on level 0 of none.
    """
    present = ~np.isnan(outcomes[0][:, 0])
    k = outcomes[0].shape[1]
    if not present.any():
        return Contributions(np.zeros((0, k)), np.zeros(0, int), np.zeros(k))
    found = terms(outcomes, features, is_probability, is_fitted)
    unit = np.zeros((len(outcomes[-1]), k))
    stratum = np.full(len(unit), len(outcomes) - 1)
    for level in range(len(outcomes) - 1, -1, -1):
        n = len(outcomes[level])
        unit[:n] += found.weight[level][:, None] * found.bracket[level]
        stratum[:n][present if level == 0 else slice(None)] = level
    if len(outcomes) == 1:
        unit, stratum = unit[present], stratum[present]
    counts = _counts(outcomes, found.scale) if is_probability else ()
    return Contributions(unit, _merged(stratum), np.zeros(k), counts)


def _merged(stratum: np.ndarray) -> np.ndarray:
    """Strata with a single index joined to the next one, so that each has a variance."""
    stratum = stratum.copy()
    for one in np.unique(stratum)[:-1]:
        if np.sum(stratum == one) == 1:
            stratum[stratum == one] = np.min(stratum[stratum > one])
    if stratum.size > 1 and np.sum(stratum == stratum.max()) == 1:
        stratum[stratum == stratum.max()] = np.max(stratum[stratum < stratum.max()])
    return stratum


def _counts(outcomes: Sequence[np.ndarray], scale: Sequence[np.ndarray]) -> tuple[Counts, ...]:
    """Differences of neighbouring levels' indicators; of a level whose successor goes unused, the indicators."""
    found = []
    for level, y in enumerate(outcomes):
        is_known = ~np.isnan(y[:, 0]) if level == 0 else np.ones(len(y), bool)
        fine = np.where(np.isnan(y), 1.0, y)[is_known]
        coarse = np.zeros(fine.shape)
        if level + 1 < len(outcomes):
            next_one = outcomes[level + 1][: len(y)][is_known]
            coarse = np.where(np.isnan(next_one), 1.0, next_one)
        difference = fine - coarse
        found.append(Counts(scale[level], (difference > 0).sum(axis=0), (difference < 0).sum(axis=0), len(fine)))
    return tuple(found)
