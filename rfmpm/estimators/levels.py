"""Nested simulations on several levels, and known-mean features of the fields, as contributions of their indices.

    estimate = mean of [y0 - a1 z1 - b0 eta] over the indices of level 0
             + a1 mean of [z1 - a2 z2 - b1 eta] over those of level 1 + ...

z stands for the coarser simulation: its outcome less a constant, or a smooth step of its quantity (`surrogate`). Every
index of a level is also one of each coarser level, so an index is the independent unit. Coefficients, constants
and steps of an index come from the other folds (index modulo FOLDS) alone. Given these, the expectations of z cancel,
whatever they are, and those of the features are 0: the estimate is unbiased. A coarse simulation may be any function of
the field, so a failed one is *defined*: its outcome is the average one, its indicators are 1. An index whose simulation
on level 0 failed counts on the coarser levels only.

Source: Giles (2015), Acta Numerica 24, 259-328; Peherstorfer, Willcox and Gunzburger (2016), SIAM J. Sci. Comput. 38,
A3163-A3194; cross-fitting: Chernozhukov et al. (2018), Econometrics Journal 21, C1-C68.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rfmpm.estimators import surrogate
from rfmpm.estimators.contributions import Contributions, Counts
from rfmpm.estimators.regression import Fit, fit

FOLDS = 8
LARGEST_SLOPE = 1.5  # on a step, whose slope is near 1; more comes of a step that hardly varies among the known rows
MULTIPLIED = 8  # leading components whose products are features; measured: on the short slope more explain no more
FEWEST_TO_FIT = 12  # completed indices on level 0; with fewer no coefficient is fitted


@dataclass(frozen=True)
class Nested:
    """Simulations of the indices 0, 1, 2, ... on levels with ever more of them, and what is known of their fields.

    Attributes:
        outcome: per level, functions of the quantity, shape (n_level, k); NaN where the simulation failed.
        quantity: per level, shape (n_level,); NaN where it failed, infinite where it is censored.
        is_probability: whether the outcomes are indicators.
        limits: shape (k,), where the outcomes say whether the quantity exceeds them; None for other outcomes.
        normals: independent standard normals of the coarsest level's fields, shape (n_coarsest, d); None for none.
        is_fitted: whether coefficients are fitted; otherwise they are 1 and nothing stands for a coarser outcome.
    """

    outcome: Sequence[np.ndarray]
    quantity: Sequence[np.ndarray]
    is_probability: bool
    limits: np.ndarray | None = None
    normals: np.ndarray | None = None
    is_fitted: bool = False

    @property
    def present(self) -> np.ndarray:
        """Whether an index completed on level 0, shape (n_0,)."""
        return ~np.isnan(self.outcome[0][:, 0])

    def chosen(self, levels: Sequence[int], number: int | None = None) -> "Nested":
        """These levels alone, and of each at most so many indices."""
        outcome, quantity = ([per[level][:number] for level in levels] for per in (self.outcome, self.quantity))
        normals = None if self.normals is None else self.normals[: len(outcome[-1])]
        return replace(self, outcome=outcome, quantity=quantity, normals=normals)


@dataclass(frozen=True)
class Terms:
    """The bracket of each level and index, times the coefficients before it.

    Attributes:
        bracket: per level, shape (n_level, k).
        weight: per level, share of the estimate that each index has, shape (n_level,); 0 where level 0 failed.
        scale: per level, coefficient with which the level's outcomes enter the estimate, shape (k,).
        difference: per level, indicators less those of the stand-in for the coarser level, shape (n_level, k).
    """

    bracket: list[np.ndarray]
    weight: list[np.ndarray]
    scale: list[np.ndarray]
    difference: list[np.ndarray]


def terms(nested: Nested) -> Terms:
    """Evaluate the brackets of every index, with coefficients from the other folds."""
    present, k = nested.present, nested.outcome[0].shape[1]
    fold = np.arange(len(nested.outcome[-1])) % FOLDS
    found = Terms(*([np.zeros((len(y), *shape)) for y in nested.outcome] for shape in ((k,), (), (), (k,))))
    found = replace(found, scale=[np.zeros(k) for _ in nested.outcome])
    features = None if nested.normals is None else field_features(nested.normals)
    can_fit = int(present.sum()) >= FEWEST_TO_FIT
    for f in range(FOLDS):
        share = float(np.mean(fold[: len(present)][present] == f)) if present.any() else 0.0
        others = fold != f
        factor = np.ones(k)
        y, prediction = np.where(present[:, None], nested.outcome[0], 0.0), nested.quantity[0]
        exceeds = y > 0.5
        for level in range(len(nested.outcome)):
            complete = present if level == 0 else np.ones(len(y), bool)
            mine, known = ~others[: len(y)] & complete, others[: len(y)] & complete
            z, coarser, next_exceeds = _stand_in(nested, level, y, prediction, known, others, can_fit)
            here = z[: len(y)]
            coefficients = _coefficients(nested, y, here, features, known, can_fit)
            rest = y[mine] - coefficients.slope * here[mine]
            if features is not None:
                rest = rest - features[: len(y)][mine] @ coefficients.weights
            found.bracket[level][mine] = factor * rest
            found.weight[level][mine] = share / max(int(mine.sum()), 1)
            found.scale[level][:] += share * factor
            found.difference[level][mine] = exceeds[mine].astype(float) - next_exceeds[: len(y)][mine]
            factor, y, prediction, exceeds = factor * coefficients.slope, z, coarser, next_exceeds
    return found


def field_features(normals: np.ndarray) -> np.ndarray:
    """Functions of standard normals with mean 0 and variance 1: themselves, their squares, products of the first."""
    first, second = np.triu_indices(min(MULTIPLIED, normals.shape[1]), 1)
    return np.hstack([normals, (normals**2 - 1.0) / np.sqrt(2.0), normals[:, first] * normals[:, second]])


def _stand_in(nested: Nested, level: int, y, prediction, known, others, can_fit: bool):
    """What stands for the next level in the bracket of this one, what it predicts, and whether that exceeds the limits.

    All are of all indices of the next level; after the coarsest one it is a function of the field alone.
    """
    is_last = level + 1 == len(nested.outcome)
    is_stepped = nested.limits is not None and nested.is_fitted and can_fit
    if is_last:
        if is_stepped and nested.normals is not None:
            return _step_of_normals(nested, y, prediction, known), prediction, np.zeros(y.shape)
        return np.zeros(y.shape), prediction, np.zeros(y.shape)
    raw = nested.quantity[level + 1]
    if not is_stepped:
        next_one = nested.outcome[level + 1]
        exceeds = np.isnan(next_one) | (next_one > 0.5)
        return _centred(next_one, others, nested.is_probability), raw, exceeds
    constant, slope, error = surrogate.line(prediction[known], raw[: len(y)][known])
    coarser = constant + slope * raw
    coarser = np.where(np.isposinf(raw) | np.isnan(raw), np.inf, coarser)
    width = surrogate.widths(y[known], coarser[: len(y)][known], nested.limits, error)
    step = surrogate.steps(coarser, nested.limits, width)
    return step - step[others[: len(step)]].mean(axis=0), coarser, coarser[:, None] > nested.limits


def _step_of_normals(nested: Nested, y, prediction, known) -> np.ndarray:
    """Smooth step of a linear function of the normals, less its expectation."""
    normals = nested.normals[: len(y)]
    finite = known & np.isfinite(prediction)
    if finite.sum() < FEWEST_TO_FIT:
        return np.zeros(y.shape)
    weights = fit(prediction[finite][:, None], None, normals[finite]).weights[:, 0]
    explained = normals @ weights
    mean, deviation = float(prediction[finite].mean()), float(np.linalg.norm(weights))
    error = float(np.std(prediction[finite] - explained[finite]))
    width = surrogate.widths(y[known], mean + explained[known], nested.limits, error)
    expected = surrogate.steps_mean(mean, deviation, nested.limits, width)
    return surrogate.steps(mean + explained, nested.limits, width) - expected


def _centred(y: np.ndarray, others: np.ndarray, is_probability: bool) -> np.ndarray:
    """A coarser level's outcomes less their mean over the other folds, failed ones as defined."""
    if is_probability:
        y = np.where(np.isnan(y), 1.0, y)
    elsewhere = y[others[: len(y)]]
    completed = elsewhere[~np.isnan(elsewhere[:, 0])]
    centre = completed.mean(axis=0) if len(completed) else np.zeros(y.shape[1])
    return np.where(np.isnan(y), 0.0, y - centre)


def _coefficients(nested: Nested, y, z, features, known, can_fit: bool) -> Fit:
    """Slope on what stands for the coarser level and weights of the features, from the rows that are `known`."""
    if nested.is_fitted and can_fit:
        most = np.inf if nested.limits is None else LARGEST_SLOPE
        return fit(y[known], z[known], None if features is None else features[: len(y)][known], most)
    d = 0 if features is None else features.shape[1]
    return Fit(np.full(y.shape[1], 0.0 if nested.is_fitted else 1.0), np.zeros((d, y.shape[1])))


def contributions(nested: Nested) -> Contributions:
    """Return what every index adds to the estimated expectations.

    Returns:
        Contributions of the indices of the coarsest level; without a completed one on level 0 of none.
    """
    outcome, present = nested.outcome, nested.present
    k = outcome[0].shape[1]
    if not present.any():
        return Contributions(np.zeros((0, k)), np.zeros(0, int), np.zeros(k))
    found = terms(nested)
    unit = np.zeros((len(outcome[-1]), k))
    stratum = np.full(len(unit), len(outcome) - 1)
    for level in range(len(outcome) - 1, -1, -1):
        n = len(outcome[level])
        unit[:n] += found.weight[level][:, None] * found.bracket[level]
        stratum[:n][present if level == 0 else slice(None)] = level
    if len(outcome) == 1:
        unit, stratum = unit[present], stratum[present]
    counts = []
    for level, (difference, scale) in enumerate(zip(found.difference, found.scale, strict=True)):
        difference = difference[present] if level == 0 else difference
        minus = None if level + 1 == len(outcome) else (difference < 0.0).sum(axis=0)
        counts.append(Counts(scale, (difference > 0.0).sum(axis=0), minus, len(difference)))
    return Contributions(unit, _merged(stratum), np.zeros(k), tuple(counts) if nested.is_probability else ())


def _merged(stratum: np.ndarray) -> np.ndarray:
    """Strata with a single index joined to a neighbour, so that each has a variance."""
    stratum = stratum.copy()
    for one in np.unique(stratum):
        if np.sum(stratum == one) == 1 and stratum.size > 1:
            rest = np.unique(stratum[stratum != one])
            stratum[stratum == one] = rest[np.argmin(np.abs(rest - one))]
    return stratum
