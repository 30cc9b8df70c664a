"""An estimator carried out again and again on rows drawn from those at hand."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from rfmpm.estimators.protocol import Estimator, Runs
from rfmpm.estimators.rows import Rows

Features = Callable[[range], np.ndarray]
Make = Callable[[Features], Estimator]  # of the features of the realisations in the order in which they are drawn


@dataclass(frozen=True)
class Bank:
    """Rows to draw from: the same realisations on one or several cell sizes.

    Attributes:
        value: per level, shape (n_level,), n_level not decreasing; NaN where a realisation failed.
        work: per level, time steps times points of each, shape (n_level,).
        cost: per level, processor time of one realisation over that of one on level 0 [-].
        features: of all realisations, shape (n, d).
        block: realisations that stay together, the points of a replicate of a design; 1: independent ones.
    """

    value: Sequence[np.ndarray]
    work: Sequence[np.ndarray]
    cost: Sequence[float]
    features: np.ndarray
    block: int = 1

    def order(self, generator: np.random.Generator) -> np.ndarray:
        """Draw an order of all realisations in which those that level 0 holds come first, each part at random."""
        edges = [0, *sorted({len(y) for y in self.value})]
        pieces = [
            generator.permutation(np.arange(first, stop).reshape(-1, self.block)).ravel()
            for first, stop in pairwise(edges)
        ]
        return np.concatenate(pieces)


class Outcome(NamedTuple):
    """What one repeat came to."""

    value: float
    lower: float
    upper: float
    cost: float  # in realisations on level 0


def carry_out(make: Make, bank: Bank, order: np.ndarray) -> Outcome:
    """Do what an estimator plans until it plans nothing more.

    Args:
        make: of the estimator, given the features.
        bank: of the rows.
        order: of the realisations, shape (n,): index i of the campaign is the realisation order[i].

    Returns:
        Outcome.

    Raises:
        IndexError: if it plans more than the bank holds.
    """
    estimator = make(lambda indices: bank.features[order[indices.start : indices.stop]])
    numbers = [0] * len(bank.value)
    rows = _rows(bank, order, numbers)
    while planned := estimator.plan(rows):
        for runs in planned:
            numbers[runs.level] = _after(runs, numbers[runs.level], len(bank.value[runs.level]))
        rows = _rows(bank, order, numbers)
    found = estimator.estimate(rows)
    cost = sum(n * cost for n, cost in zip(numbers, bank.cost, strict=True))
    return Outcome(found.value, found.lower, found.upper, cost)


def _after(runs: Runs, number: int, held: int) -> int:
    if runs.indices.stop > held:
        raise IndexError(f"level {runs.level}: {runs.indices.stop} realisations planned, {held} at hand")
    return max(number, runs.indices.stop)


def _rows(bank: Bank, order: np.ndarray, numbers: Sequence[int]) -> Rows:
    level = np.repeat(np.arange(len(numbers)), numbers)
    index = np.concatenate([np.arange(n) for n in numbers])
    value, work = (
        np.concatenate([column[k][order[:n]] for k, n in enumerate(numbers)]) for column in (bank.value, bank.work)
    )
    return Rows(level, index, value, np.zeros(level.size, bool), work)


def repeats(make: Make, bank: Bank, number: int, seed: int) -> Iterator[Outcome]:
    """Carry an estimator out many times, each on realisations drawn anew."""
    generator = np.random.default_rng(seed)
    for _ in range(number):
        yield carry_out(make, bank, bank.order(generator))


class Judged(NamedTuple):
    """How an estimator did over many repeats."""

    bias: float
    bias_error: float  # standard error of the bias
    root_mean_square_error: float
    coverage: float  # share of intervals that hold the reference [-]
    cost: float  # mean, in realisations on level 0


def judge(outcomes: Sequence[Outcome], reference: float) -> Judged:
    """Compare repeats with a reference."""
    value, lower, upper, cost = np.array(outcomes).T
    error = value - reference
    return Judged(
        float(error.mean()),
        float(error.std(ddof=1) / np.sqrt(error.size)),
        float(np.sqrt(np.mean(error**2))),
        float(np.mean((lower <= reference) & (reference <= upper))),
        float(cost.mean()),
    )
