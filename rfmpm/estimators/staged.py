"""Plans in stages: run up to some numbers, look at what came of it, decide how many more."""

import math
from abc import abstractmethod

import numpy as np

from rfmpm.estimators.linear import LinearEstimator
from rfmpm.estimators.monte_carlo import missing
from rfmpm.estimators.protocol import Runs
from rfmpm.estimators.question import Question
from rfmpm.estimators.rows import Rows

MARGIN = 1.05  # more than predicted, since a stage that falls just short costs another one
MOST_GROWTH = 2.0  # of the realisations in one stage: a variance from few rows can be far too large
LEAST_GROWTH = 1.1
EQUAL_ENOUGH = 1024  # equal values that pass for a mean: another one has then a probability below 0.3 % (3 / n)


class Staged(LinearEstimator):
    """An estimator that decides at the end of each stage, on the rows of that stage and those before it alone.

    Stages depend on the rows, not on when they came in, and each ends before the next is planned: no run counts because
    it was quick, and a campaign that is continued passes through the same stages again.

    Numbers that follow from a measured variance bias the estimate a little towards values whose variance is small. With
    independent units of variance s2 and third central moment m3 the bias is about -m3 / (s2 n), whatever the stages:
    for a probability p it is -(1 - 2 p) / n, a seventh of its standard error at p = 0.15 and n = 230.

    Source of the bias: Whitehead (1986), Biometrika 73, 573-581.
    """

    def __init__(self, question: Question, realisations: int | None = None):
        """Ask a question of a fixed number of realisations, or of as many as the wanted half width needs.

        Args:
            question: what is wanted.
            realisations: fixed number on the study's own cells, at least 1 [-]; None where the question says how well
                the answer is to be known.

        Raises:
            ValueError: if the number is less than 1, or neither or both are given.
        """
        if realisations is None and not question.is_open_ended:
            raise ValueError("how many realisations? Give their number, or the half width that the question wants")
        if realisations is not None and question.is_open_ended:
            raise ValueError("give the number of realisations or the half width that the question wants, not both")
        if realisations is not None and realisations < 1:
            raise ValueError(f"realisations = {realisations}: at least 1 is needed")
        self.question = question
        self.realisations = realisations

    @abstractmethod
    def first_numbers(self) -> list[int]:
        """Return how many indices of each level the first stage runs."""

    @abstractmethod
    def next_numbers(self, rows: Rows, numbers: list[int]) -> list[int] | None:
        """Return the numbers of the stage after the one that gave these rows; None if there is none."""

    @property
    def most(self) -> float:
        """Realisations on the study's own cells at which the campaign ends."""
        ends = self.realisations if self.realisations is not None else self.question.at_most
        return math.inf if ends is None else ends

    def plan(self, rows: Rows) -> list[Runs]:
        """Name the simulations of the present stage that have no row yet; empty when the question is answered.

        Args:
            rows: all that is finished.

        Returns:
            Runs, sorted by level and index.
        """
        numbers = self.first_numbers()
        while numbers is not None:
            todo = [
                Runs(level, part)
                for level, number in enumerate(numbers)
                for part in missing(rows.index[rows.level == level], number)
            ]
            if todo:
                return todo
            numbers = self.next_numbers(rows.first(numbers), numbers)
        return []

    def growth(self, rows: Rows, n: int) -> float:
        """Return the number of realisations that the question needs, at most MOST_GROWTH times those at hand.

        Args:
            rows: of the stages so far.
            n: realisations so far [-].

        Returns:
            Number; 0 if the question is answered.
        """
        found = self.estimate(rows)
        excess = self.question.excess(found)
        if self.question.kind == "mean" and found.lower == found.upper and n < EQUAL_ENOUGH:
            return n * MOST_GROWTH
        if excess <= 1.0:
            return 0.0
        return n * min(MOST_GROWTH, MARGIN * excess**2) if np.isfinite(excess) else n * MOST_GROWTH
