"""Plain Monte Carlo behind the common protocol: a fixed number of realisations, or blocks until it is known enough."""

import math
from dataclasses import replace

import numpy as np

from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.curves import Band, exceedance_curve
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.estimators.levels import Nested, contributions
from rfmpm.estimators.monte_carlo import Estimate, exceedance, mean, quantile
from rfmpm.estimators.protocol import Expectation
from rfmpm.estimators.question import Functions, Question
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.staged import LEAST_GROWTH, Staged

FIRST_BLOCK = 64


class MonteCarlo(Staged):
    """Independent, equally weighted realisations on the study's own cells.

    Towards a wanted half width the realisations come in blocks, each ending at a number that the variance so far
    predicts, and the interval is looked at there alone, on all indices from 0 on: the bias of stopping is then small
    (measured in the contract tests).
    """

    method = "plain Monte Carlo"

    def __init__(self, question: Question, realisations: int | None = None, first_block: int = FIRST_BLOCK):
        """Ask a question.

        Args:
            question: what is wanted.
            realisations: fixed number, at least 1 [-]; None where the question wants a half width.
            first_block: realisations before the interval is looked at for the first time [-].

        Raises:
            ValueError: if the number is less than 1, or neither a number nor a half width is given.
        """
        super().__init__(question, realisations)
        self.first_block = first_block

    def first_numbers(self) -> list[int]:
        """Return the fixed number, or the first block."""
        return [self.realisations or int(min(self.first_block, self.most))]

    def next_numbers(self, rows: Rows, numbers: list[int]) -> list[int] | None:
        """Return the end of the next block; None when the question is answered or the most are done."""
        n = numbers[0]
        if n >= self.most:
            return None
        wanted = self.growth(rows, n)
        return [int(min(math.ceil(max(wanted, LEAST_GROWTH * n)), self.most))] if wanted else None

    def used(self, rows: Rows) -> Rows:
        """Return the rows on level 0 without a gap before them, at most the fixed number."""
        n = rows.numbers(1)[0]
        return rows.first([n if self.realisations is None else min(n, self.realisations)])

    def contributions(self, outcome: np.ndarray, rows: Rows, functions: Functions) -> Contributions:
        """Return y / n of every realisation."""
        return contributions(Nested([outcome], [rows.value], functions.is_probability))

    def expectation(self, rows: Rows, functions: Functions) -> Expectation:
        """Estimate the means of k functions of the quantity: Student's t, or Clopper-Pearson's interval."""
        found = super().expectation(rows, functions)
        if not functions.is_probability:
            return found
        outcome = functions(rows)[rows.level == 0][: self.used(rows).value.size]
        count, failed = np.nansum(outcome, axis=0), np.isnan(outcome).sum(axis=0)
        lower, _ = clopper_pearson(count, len(outcome), self.question.confidence)
        _, upper = clopper_pearson(count + failed, len(outcome), self.question.confidence)
        return found._replace(lower=lower, upper=upper)

    def estimate(self, rows: Rows) -> Estimate:
        """Answer the question: by Student's t, Clopper and Pearson's interval or order statistics."""
        asked, own = self.question, self.used(rows)
        if asked.kind == "mean":
            found = mean(own.value, asked.confidence, own.is_censored)
        elif asked.kind == "exceedance":
            found = exceedance(own.value, asked.limit, own.is_censored, asked.confidence)
        else:
            return quantile(own.value, asked.probability, own.is_censored, asked.confidence)
        completed = own.value[~own.is_failed]
        if asked.kind == "exceedance":
            completed = (completed > asked.limit) | own.is_censored[~own.is_failed]
        error = np.std(completed, ddof=1) / np.sqrt(completed.size) if completed.size > 1 else math.inf
        return replace(found, standard_error=float(error))

    def quantile(self, rows: Rows, probability: float) -> Estimate:
        """Estimate a quantile between two order statistics."""
        own = self.used(rows)
        return quantile(own.value, probability, own.is_censored, self.question.confidence)

    def exceedance_curve(self, rows: Rows, limits: np.ndarray | None = None) -> Band:
        """Estimate the whole curve with Clopper-Pearson's band and the simultaneous one of Dvoretzky and others."""
        own = self.used(rows)
        return exceedance_curve(own.value, limits, own.is_censored, self.question.confidence)
