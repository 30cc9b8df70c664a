"""Double sampling: coarse runs of many indices, runs on the study's own cells of some that are chosen by the former.

    estimate = sum over strata of W mean(y - z) + mean of (z - b eta)

W is the share of the coarse runs that fall into a stratum, z predicts an outcome from its coarse run: the mean of the
stratum and, within it, a line in the coarse outcome or a smooth step of the coarse quantity. Chosen are the first
indices of a stratum, a fair sample of it. Lines, steps and the weights b of the features of the field (expectation 0)
come from the other folds (index modulo FOLDS) alone, so that the estimate is unbiased. An index whose run on the own
cells failed counts as not chosen; a coarse run may be any function of the field, and a failed one exceeds every limit.

Source: Neyman (1938), J. Am. Stat. Assoc. 33, 101-116; Cochran (1977), Sampling Techniques, sections 12.2 and 12.6.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from rfmpm.estimators import surrogate
from rfmpm.estimators.contributions import Contributions, Counts
from rfmpm.estimators.levels import FEWEST_TO_FIT, FOLDS, LARGEST_SLOPE, field_features
from rfmpm.estimators.regression import fit


@dataclass(frozen=True)
class Phases:
    """What coarse runs of n indices gave, and runs on the own cells of those that were chosen.

    Attributes:
        outcome: functions of the quantity on the own cells, shape (n, k); NaN where not simulated or failed.
        coarse_outcome: the same of the coarse runs, shape (n, k); NaN where failed.
        quantity: on the own cells, shape (n,); NaN where not simulated or failed, infinite where censored.
        coarse_quantity: of the coarse runs, shape (n,); infinite where failed or censored.
        stratum: from 0 on, shape (n,).
        is_probability: whether the outcomes are indicators.
        limits: shape (k,), where the outcomes say whether the quantity exceeds them; None for other outcomes.
        normals: independent standard normals of the fields, shape (n, d); None for none.
    """

    outcome: np.ndarray
    coarse_outcome: np.ndarray
    quantity: np.ndarray
    coarse_quantity: np.ndarray
    stratum: np.ndarray
    is_probability: bool
    limits: np.ndarray | None
    normals: np.ndarray | None

    @property
    def chosen(self) -> np.ndarray:
        """Whether an index completed on the own cells, shape (n,)."""
        return ~np.isnan(self.outcome[:, 0])

    def counts(self) -> tuple[np.ndarray, np.ndarray]:
        """How many indices each stratum has, and how many of them completed on the own cells; shape (strata,) each."""
        strata = int(self.stratum.max()) + 1
        return tuple(np.bincount(part, minlength=strata) for part in (self.stratum, self.stratum[self.chosen]))


class Parts(NamedTuple):
    """What the estimate is made of.

    Attributes:
        rest: y - z of the indices that completed on the own cells, shape (n, k); 0 elsewhere.
        predicted: z - b eta of every index, shape (n, k).
    """

    rest: np.ndarray
    predicted: np.ndarray


def parts(phases: Phases) -> Parts:
    """Evaluate what every index adds, with lines, steps and weights from the other folds."""
    chosen, outcome = phases.chosen, np.nan_to_num(phases.outcome)
    fold = np.arange(len(outcome)) % FOLDS
    features = None if phases.normals is None else field_features(phases.normals)
    found = Parts(np.zeros(outcome.shape), np.zeros(outcome.shape))
    for f in np.unique(fold):
        mine, others = fold == f, fold != f
        z = _predictions(phases, outcome, others & chosen, others)
        found.rest[mine] = np.where(chosen[mine, None], outcome[mine] - z[mine], 0.0)
        found.predicted[mine] = z[mine]
        if features is not None and others.sum() >= FEWEST_TO_FIT:
            found.predicted[mine] -= features[mine] @ fit(z[others], None, features[others]).weights
    return found


def _predictions(phases: Phases, outcome: np.ndarray, known: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Outcomes of all indices as their coarse runs predict them, learnt from those that are `known`, shape (n, k)."""
    if not known.any():
        return np.zeros(outcome.shape)
    of_known, everyone = phases.stratum[known], np.ones(len(outcome), bool)
    sizes, taken = (np.bincount(phases.stratum[part], minlength=phases.stratum.max() + 1) for part in (others, known))
    overall = outcome[known].mean(axis=0)
    centre = _means(outcome[known], of_known, taken, overall)
    if known.sum() < FEWEST_TO_FIT:
        return centre[phases.stratum]
    regressor = _regressor(phases, outcome, known, others)
    middle = _means(regressor[known], of_known, taken, regressor[everyone].mean(axis=0))
    # the variance of a stratified mean: squares weigh with the square of the weight that a row has in the estimate
    weight = ((sizes / np.maximum(taken, 1)) ** 2)[of_known, None]
    x, y = regressor[known] - middle[of_known], outcome[known] - centre[of_known]
    square = np.sum(weight * x * x, axis=0)
    slope = np.where(square > 1e-12 * len(x), np.sum(weight * x * y, axis=0) / np.where(square > 0.0, square, 1.0), 0.0)
    if phases.is_probability:
        slope = np.clip(slope, 0.0, LARGEST_SLOPE)
    return centre[phases.stratum] + slope * (regressor - middle[phases.stratum])


def _regressor(phases: Phases, outcome: np.ndarray, known: np.ndarray, others: np.ndarray) -> np.ndarray:
    """What a prediction is linear in within a stratum, of all indices, shape (n, k)."""
    if phases.limits is None:
        missing = 1.0 if phases.is_probability else np.nan
        filled = np.where(np.isnan(phases.coarse_outcome), missing, phases.coarse_outcome)
        completed = others & ~np.isnan(filled[:, 0])
        return np.where(np.isnan(filled), filled[completed].mean(axis=0) if completed.any() else 0.0, filled)
    raw = phases.coarse_quantity
    constant, slope, error = surrogate.line(phases.quantity[known], raw[known])
    prediction = np.where(np.isinf(raw), np.inf, constant + slope * raw)
    width = surrogate.widths(outcome[known], prediction[known], phases.limits, error)
    return surrogate.steps(prediction, phases.limits, width)


def _means(values: np.ndarray, stratum: np.ndarray, taken: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """Mean of each stratum, shape (strata, k); another value where a stratum has none."""
    total = np.zeros((taken.size, values.shape[1]))
    np.add.at(total, stratum, values)
    return np.where(taken[:, None] > 0, total / np.maximum(taken, 1)[:, None], otherwise)


def contributions(phases: Phases) -> Contributions:
    """Return what every index adds to the estimated expectations; without a completed one of none.

    A stratum of which nothing completed on the own cells counts with its predictions.
    """
    if not phases.chosen.any():
        k = phases.coarse_outcome.shape[1]
        return Contributions(np.zeros((0, k)), np.zeros(0, int), np.zeros(k))
    found = stratified(parts(phases), phases.chosen, phases.stratum)
    return replace(found, counts=_counts(phases)) if phases.is_probability else found


def stratified(found: Parts, chosen: np.ndarray, stratum: np.ndarray) -> Contributions:
    """Return what every index adds to sums over strata of W mean(rest), plus the mean of what is predicted.

    Args:
        found: rest and prediction of n indices, k functions.
        chosen: whether the rest of an index is known, shape (n,).
        stratum: of each index, from 0 on, shape (n,).

    Returns:
        Contributions: their scatter is that of the rest within the strata and that of the shares W.
    """
    n, k = found.rest.shape
    strata = int(stratum.max()) + 1
    sizes, taken = (np.bincount(part, minlength=strata) for part in (stratum, stratum[chosen]))
    centre = _means(found.rest[chosen], stratum[chosen], taken, np.zeros(k))
    # Sums over a stratum of deviations from its mean are 0: their factors matter to the variance alone.
    factor = (sizes / np.maximum(taken, 1) * np.sqrt(taken / np.maximum(taken - 1.0, 1.0)))[stratum, None]
    deviation = np.where(chosen[:, None], factor * (found.rest - centre[stratum]), 0.0)
    unit = (found.predicted + centre[stratum] + deviation) / n
    square = np.zeros((taken.size, k))
    np.add.at(square, stratum, (deviation / n) ** 2)
    return Contributions(unit, np.zeros(n, int), np.zeros(k), freedom=_freedom(unit, square, taken))


def _freedom(unit: np.ndarray, square: np.ndarray, taken: np.ndarray) -> np.ndarray:
    """Welch's degrees of freedom of the strata's parts of the variance and of the rest of it, shape (k,)."""
    n = len(unit)
    rest = np.maximum(np.sum((unit - unit.mean(axis=0)) ** 2, axis=0) - square.sum(axis=0), 0.0)
    share = np.vstack([square, rest]) / np.where((total := square.sum(axis=0) + rest) > 0.0, total, 1.0)
    freedom = np.maximum(np.append(taken, n) - 1.0, 1.0)
    return np.where(total > 0.0, 1.0 / np.maximum(np.sum(share**2 / freedom[:, None], axis=0), 1e-12), freedom.sum())


def _counts(phases: Phases) -> tuple[Counts, Counts]:
    """What the coarse cells say of all indices, and where the own cells say something else, all strata together."""
    coarse = np.isnan(phases.coarse_outcome) | (phases.coarse_outcome > 0.5)
    difference = (phases.outcome - coarse)[phases.chosen]
    one = np.ones(coarse.shape[1])
    changes = Counts(one, (difference > 0.0).sum(axis=0), (difference < 0.0).sum(axis=0), len(difference))
    return Counts(one, coarse.sum(axis=0), None, len(coarse)), changes


def variances(phases: Phases) -> tuple[float, float]:
    """Return what the coarse runs and those on the own cells, the latter shared evenly among the strata, add.

    Args:
        phases: one function.

    Returns:
        Variance of either part of the estimate times its number of runs.
    """
    found, (sizes, taken) = parts(phases), phases.counts()
    rest, chosen, of = found.rest[:, 0], phases.chosen, phases.stratum
    coarse = float(np.var(found.predicted[:, 0]))
    square = np.zeros(taken.size)
    for stratum in np.flatnonzero(taken > 1):
        square[stratum] = np.var(rest[chosen & (of == stratum)], ddof=1)
    own = float(taken.size * np.sum((sizes / sizes.sum()) ** 2 * square))
    least = 1.0 / (taken.sum() + 2.0) if phases.is_probability else 0.0  # none that differs among n is no proof
    return coarse, max(own, least)
