"""An estimator carried out again and again on rows drawn from those at hand."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rfmpm.estimators.levels import FOLDS
from rfmpm.estimators.protocol import Estimator
from rfmpm.estimators.rows import Rows

LONGEST, LEAST_DRAWN = 8, 16_000  # draws over the rows of a bank; draws

Features = Callable[[range], np.ndarray]
Make = Callable[[Features], Estimator]  # of the features of the realisations in the order in which they are drawn


@dataclass(frozen=True)
class Bank:
    """Rows to draw from: the same realisations on one or several cell sizes.

    Attributes:
        value: per level, shape (n,); NaN where a realisation failed.
        work: per level, time steps times points of each, shape (n,).
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
        """Draw realisations with replacement, LONGEST times as many as there are, at least LEAST_DRAWN.

        The rows are the population then, and their mean or share is the truth. Copies of one realisation share a fold
        of the estimators, which would otherwise learn from the very rows that they predict.
        """
        blocks = generator.permutation(len(self.value[0]) // self.block)
        drawn = max(LONGEST * blocks.size, LEAST_DRAWN // self.block)
        if self.block > 1:
            blocks = generator.choice(blocks, drawn)
        else:
            parts = [blocks[fold::FOLDS] for fold in range(FOLDS)]
            blocks = np.stack([generator.choice(part, drawn // FOLDS) for part in parts], axis=1).ravel()
        return (blocks[:, None] * self.block + np.arange(self.block)).ravel()


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
        order: of the realisations, shape (m,): index i of the campaign is the realisation order[i].

    Returns:
        Outcome.

    Raises:
        IndexError: if it plans more than were drawn.
    """
    estimator = make(lambda indices: bank.features[order[indices.start : indices.stop]])
    done = [np.zeros(0, int) for _ in bank.value]
    rows = _rows(bank, order, done)
    while planned := estimator.plan(rows):
        for level, indices in planned:
            done[level] = np.union1d(done[level], indices)
        rows = _rows(bank, order, done)
    found = estimator.estimate(rows)
    cost = sum(len(indices) * cost for indices, cost in zip(done, bank.cost, strict=True))
    return Outcome(found.value, found.lower, found.upper, cost)


def _rows(bank: Bank, order: np.ndarray, done: Sequence[np.ndarray]) -> Rows:
    level = np.repeat(np.arange(len(done)), [len(indices) for indices in done])
    value, work = (
        np.concatenate([column[k][order[indices]] for k, indices in enumerate(done)])
        for column in (bank.value, bank.work)
    )
    return Rows(level, np.concatenate(done), value, np.zeros(level.size, bool), work)


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
