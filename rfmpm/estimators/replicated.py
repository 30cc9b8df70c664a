"""Latin hypercube and Sobol designs: whole replicates, each randomised on its own, whose scatter gives the interval."""

import math

import numpy as np

from rfmpm.estimators.contributions import Contributions, Counts
from rfmpm.estimators.question import Functions, Question
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.staged import LEAST_GROWTH, Staged

FEWEST_REPLICATES = 8  # Student's factor is then 2.36; with 4 it is 3.18


class Replicated(Staged):
    """Realisations of a design with replicates: index = replicate * replicate_size + point.

    Replicates are independent and identically distributed, points of one are not: the interval is Student's t over the
    replicates' means. Probabilities that few points exceed, or all but few, have it widened by what Wilson's interval
    of as many independent points has over Wald's, which is on the safe side for a design that beats independent points.
    """

    method = "design with replicates; Student t over their means"

    def __init__(self, question: Question, replicate_size: int, realisations: int | None = None):
        """Ask a question.

        Args:
            question: what is wanted.
            replicate_size: points of a replicate [-].
            realisations: number at least, rounded up to whole replicates and to FEWEST_REPLICATES of them [-]; None
                where the question wants a half width.

        Raises:
            ValueError: if a number is less than 1, or neither a number nor a half width is given.
        """
        super().__init__(question, realisations)
        if replicate_size < 1:
            raise ValueError(f"replicate_size = {replicate_size}: at least 1 is needed")
        self.replicate_size = replicate_size

    def first_numbers(self) -> list[int]:
        """Return the fixed number in whole replicates, or FEWEST_REPLICATES of them."""
        return [self.replicate_size * max(FEWEST_REPLICATES, math.ceil((self.realisations or 0) / self.replicate_size))]

    def next_numbers(self, rows: Rows, numbers: list[int]) -> list[int] | None:
        """Return the number with further whole replicates; None when the question is answered or the most are done."""
        n, size = numbers[0], self.replicate_size
        if n + size > self.most or not (wanted := self.growth(rows, n)):
            return None
        replicates = math.ceil(max(wanted, LEAST_GROWTH * n) / size)
        return [size * int(min(replicates, self.most // size))]

    def used(self, rows: Rows) -> Rows:
        """Return the rows of complete replicates without a gap before them."""
        n = rows.numbers(1)[0]
        if self.realisations is not None:
            n = min(n, self.first_numbers()[0])
        return rows.first([n // self.replicate_size * self.replicate_size])

    def contributions(self, outcome: np.ndarray, rows: Rows, functions: Functions) -> Contributions:
        """Return the mean over the completed points of each replicate, over the number of replicates."""
        outcome = outcome[: len(outcome) // self.replicate_size * self.replicate_size]
        present = ~np.isnan(outcome[:, 0])
        shape = (-1, self.replicate_size)
        completed = present.reshape(shape).sum(axis=1)
        total = np.where(present[:, None], outcome, 0.0).reshape(*shape, outcome.shape[1]).sum(axis=1)
        means = total[completed > 0] / completed[completed > 0][:, None]
        counts = ()
        if functions.is_probability and present.any():
            plus = total.sum(axis=0)
            counts = (Counts(np.ones(plus.shape), plus, None, int(present.sum())),)
        stratum = np.zeros(len(means), int)
        return Contributions(means / max(len(means), 1), stratum, np.zeros(outcome.shape[1]), counts)
