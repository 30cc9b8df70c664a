"""Stratified sampling along the direction in which the random fields drive the quantity: for small probabilities.

Runs in the strata near the limit count for little each, and there are many of them: a small probability is known from
far fewer runs than plain Monte Carlo takes. Every round is unbiased given those before it, whatever its fit; rounds are
weighted by their runs, plain ones against the others by what the first fit promises.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import betaincinv

from rfmpm.estimators.curves import Band
from rfmpm.estimators.linear import FEW, falling, pooled
from rfmpm.estimators.monte_carlo import Estimate, missing
from rfmpm.estimators.protocol import Runs
from rfmpm.estimators.question import Question
from rfmpm.estimators.rounds import STRATA, Features, Round, rounds
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.staged import LEAST_GROWTH, MARGIN, MOST_GROWTH

MOST_POINTS = 200  # of an exceedance curve


@dataclass(frozen=True)
class Strata:
    """The strata of all rounds side by side; every array but `place` has shape (k,).

    Attributes:
        weight: with which the share of a stratum enters the estimate; their sum is 1 [-].
        chance: of the event, as the fit has it [-].
        place: which stratum each row is of, shape (n,); -1 for rows of a round that has not met all its strata yet.
    """

    weight: np.ndarray
    chance: np.ndarray
    place: np.ndarray

    def count(self, rows: np.ndarray) -> np.ndarray:
        """Count rows by stratum, given a mask of shape (n,)."""
        return np.bincount(self.place[rows & (self.place >= 0)], minlength=self.weight.size)


class Stratified:
    """Small probabilities of exceeding a limit; made with `sampling.StratifiedVectors`."""

    method = "stratified sampling along the fields' strongest direction"

    def __init__(self, question: Question, features: Features, pilot_size: int = 100, realisations: int | None = None):
        """Ask for a probability.

        Args:
            question: kind "exceedance"; with a wanted half width, runs are added until it is reached.
            features: independent standard-normal numbers of realisations were they plain, shape (n, d).
            pilot_size: plain runs before the first fit, at least 1 [-].
            realisations: runs at most; None: `question.at_most`.

        Raises:
            ValueError: another kind of question; a size or a number less than 1.
        """
        if question.kind != "exceedance":
            raise ValueError(
                'estimator.method = "stratified" finds probabilities of exceeding a limit only: give study.until an '
                "exceeds_m (exceeds_m3_per_m), or take another method"
            )
        most = realisations if realisations is not None else question.at_most
        for name, number in (("pilot_size", pilot_size), ("realisations", most)):
            if number is not None and number < 1:
                raise ValueError(f"{name} = {number}: at least 1 is needed")
        if most is None and not question.is_open_ended:
            raise ValueError("how many realisations? Give their number, or the half width that the question wants")
        self.question, self.features, self.pilot_size = question, features, pilot_size
        self.most = math.inf if most is None else most

    def rounds(self, rows: Rows) -> list[Round]:
        """Return the rounds that the rows have led to; the last one is not finished."""
        return list(rounds(rows, self.features, self.question.limit, self.pilot_size))

    def plan(self, rows: Rows) -> list[Runs]:
        """Name the rest of the present round, or of a part of it that may answer; empty when the question is answered.

        Args:
            rows: all that is finished.
        """
        number: int | None = int(min(self.pilot_size, self.most))
        while number:
            if todo := missing(rows.index[rows.level == 0], number):
                return [Runs(0, part) for part in todo]
            number = self._next(rows.first([number]), number)
        return []

    def _next(self, rows: Rows, n: int) -> int | None:
        """Number of runs after n, where the interval is looked at again; None to end."""
        if n >= self.most:
            return None
        end = self.pilot_size
        while end <= n:
            end *= 2  # see `rounds`
        if self.question.is_open_ended:
            excess = self.question.excess(self.estimate(rows))
            if excess <= 1.0:
                return None
            growth = max(LEAST_GROWTH, min(MOST_GROWTH, MARGIN * excess**2))
            end = min(end, max(math.ceil(growth * n), n + 2 * STRATA))
        return int(min(end, self.most))

    def estimate(self, rows: Rows) -> Estimate:
        """Estimate the probability of exceeding the limit.

        Args:
            rows: all that is finished.

        Returns:
            Estimate [-]; failed runs are counted both ways in the interval, censored ones count as exceeding.
        """
        own = rows.first([rows.numbers(1)[0]])
        return self._estimate(own, self._strata(own), self.question.limit)

    def exceedance_curve(self, rows: Rows, limits: np.ndarray | None = None) -> Band:
        """Estimate P(X > l) as a function of l with a band for each l; closest at the limit in question.

        Args:
            rows: all that is finished.
            limits: ascending, shape (k,), unit of the quantity; None takes up to MOST_POINTS of the values by rank.

        Returns:
            Band over the limits, without a simultaneous one.
        """
        own = rows.first([rows.numbers(1)[0]])
        if limits is None:
            values = np.unique(own.value[~own.is_failed])
            limits = values[np.unique(np.linspace(0, max(values.size - 1, 0), MOST_POINTS).astype(int))[: values.size]]
        limits, strata = np.asarray(limits, float), self._strata(own)
        found = [self._estimate(own, strata, float(limit)) for limit in limits]
        value, lower, upper = (np.array([getattr(one, name) for one in found]) for name in ("value", "lower", "upper"))
        if np.isfinite(value).all() and value.size:
            lower, upper = falling(lower, False), falling(upper, True)
            value = np.clip(pooled(value), lower, upper)
        return Band(limits, value, lower, upper, self.question.confidence)

    def _strata(self, own: Rows) -> Strata:
        """Put the strata of all rounds together; a round that has a row in each of its strata counts."""
        n, found = own.value.size, self.rounds(own)
        fitted = next((one for one in found if one.direction is not None), found[0])
        weight, chance, place, first = [np.zeros(0)], [np.zeros(0)], np.full(n, -1), 0
        for one in found:
            index = np.arange(one.start, min(one.stop, n))
            if index.size < one.chance.size:
                continue
            is_plain = one.direction is None
            place[index] = first + one.stratum(index)
            weight.append(index.size * (1.0 if is_plain else fitted.gain) * one.probability)
            chance.append(np.array([fitted.probability @ fitted.chance]) if is_plain else one.chance)
            first += one.chance.size
        weights = np.concatenate(weight)
        return Strata(weights / max(weights.sum(), 1e-300), np.concatenate(chance), place)

    def _estimate(self, own: Rows, strata: Strata, limit: float) -> Estimate:
        exceeds = ((own.value > limit) | own.is_censored) & ~own.is_failed
        count, failed, n = (strata.count(mask) for mask in (exceeds, own.is_failed, np.ones(own.value.size, bool)))
        done, weight = n - failed, strata.weight
        value, error = math.nan, math.inf
        if np.any(done):
            known = weight[done > 0] / weight[done > 0].sum()
            share = count[done > 0] / done[done > 0]
            value = float(min(known @ share, 1.0))
            variance = np.sum(known**2 * share * (1.0 - share) / done[done > 0])
            error = math.sqrt(variance) if 0.0 < value < 1.0 else math.inf
        confidence = self.question.confidence
        lower, _ = weighted_shares(weight, count, n, strata.chance, confidence)
        _, upper = weighted_shares(weight, count + failed, n, strata.chance, confidence)
        notes, used, seen = _notes(own), int(n.sum()), int(count.sum())
        if np.unique(strata.chance).size > 1 and seen < FEW:  # else no fit was made
            notes.append(f"{seen} of {used} exceed: the upper bound rests on the fit that set the strata")
        return Estimate(value, lower, upper, confidence, used, self.method, "; ".join(notes), error)


def weighted_shares(
    weight: np.ndarray, count: np.ndarray, n: np.ndarray, chance: np.ndarray, confidence: float
) -> tuple[float, float]:
    """Return an interval for a weighted mean of binomial probabilities.

    The upper bound is a quantile of the weighted mean of Beta variables as Clopper and Pearson have them: with one
    success more than were seen, split among the counts as the fit splits the probability. That success then counts as
    much as those that make up the probability, not as much as the heaviest one that could come. The lower bound is the
    same for the opposite event. The weighted mean is taken to be Beta distributed itself, by its mean and variance. Of
    a single count it is Clopper and Pearson's interval; where nothing is seen it rests on the fit.

    Args:
        weight: of each probability, shape (k,); their sum is 1 [-].
        count: successes, shape (k,).
        n: trials, shape (k,), at least 1.
        chance: the probabilities as a fit has them, shape (k,); strictly between 0 and 1 [-].
        confidence: level [-].

    Returns:
        Lower and upper bound [-]; 0 and 1 without counts.

    Source: Fay and Feuer (1997), Statistics in Medicine 16, 791-801, for Poisson counts with the heaviest weight.
    """
    if not n.size:
        return 0.0, 1.0
    tail = 0.5 * (1.0 - confidence)
    return 1.0 - _upper(weight, n - count, n, 1.0 - chance, tail), _upper(weight, count, n, chance, tail)


def _upper(weight: np.ndarray, count: np.ndarray, n: np.ndarray, chance: np.ndarray, tail: float) -> float:
    more = weight * chance
    a, b = count + more / more.sum(), n - count
    total = a + b
    mean = float(weight @ (a / total))
    variance = float(np.sum(weight**2 * a * b / (total**2 * (total + 1.0))))
    if variance <= 0.0 or mean >= 1.0:
        return 1.0
    size = mean * (1.0 - mean) / variance - 1.0
    return float(betaincinv(mean * size, (1.0 - mean) * size, 1.0 - tail))


def _notes(own: Rows) -> list[str]:
    notes = []
    if failed := int(own.is_failed.sum()):
        notes.append(f"{failed} failed of {own.value.size} counted both ways, which widens the interval")
    if censored := int((own.is_censored & ~own.is_failed).sum()):
        notes.append(f"{censored} censored counted as exceeding")
    if failed == own.value.size:
        notes.append("no completed realisation: nothing is known")
    return notes
