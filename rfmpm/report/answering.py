"""Answers from the rows of a campaign, by the estimator that planned it."""

from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from rfmpm import estimators, planning
from rfmpm.estimators.curves import Band
from rfmpm.estimators.discretisation import Discretisation, discretisation, discretisation_of_quantile
from rfmpm.estimators.question import Exceedances, Value
from rfmpm.estimators.rows import Rows
from rfmpm.planning.records import BOUNDED_BY
from rfmpm.report.members import first_index, flagged

FEWEST_PAIRS = 10  # realisations on two levels; with fewer the error of the cells is not estimated
STEPS = 12  # at which an answer is followed as rows are added


class Answers:
    """Asks the estimator of a campaign."""

    def __init__(self, dataset, study, confidence: float):
        """Read the campaign.

        Args:
            dataset: the ensemble with the rows of all levels.
            study: its Study.
            confidence: level of all intervals [-].
        """
        self.dataset, self.study, self.confidence = dataset, study, confidence
        self.question = replace(planning.question_of(study), confidence=confidence)
        self.points = planning.point_counts(study)
        self.rows = self.rows_of(self.question.quantity)

    @property
    def is_plain(self) -> bool:
        """Whether every row on the study's own cells is an independent, equally weighted sample."""
        design = self.study.estimator
        return design is None or (design.method == "monte_carlo" and design.sampling == "random")

    @property
    def approaches_limit(self) -> bool:
        """Whether realisations follow from others, nearer to the limit: the first ones alone are a fair sample."""
        return planning.approaches_limit(self.study)

    @property
    def fair_size(self) -> int | None:
        """First realisations that are a fair sample, where later ones are chosen by what came before; None: all are."""
        return self.study.estimator.fair_size if self.study.estimator else None

    def rows_of(self, quantity: str) -> Rows:
        """What estimators see of a quantity; a part of a study counts from its own first realisation."""
        data = self.dataset
        value = data[quantity].values.astype(float)
        censored = flagged(data, *BOUNDED_BY[quantity]) & ~np.isnan(value)
        index = data["realisation"].values - first_index(data)
        return planning.as_rows(data["level"].values, index, value, censored, data["step_count"].values, self.points)

    def estimate(self, rows: Rows, **changes) -> estimators.Estimate:
        """Answer the question, or that one with some of its parts changed, from some rows."""
        return self._asking(**changes).estimate(rows)

    @cached_property
    def _estimator(self):
        """Of the campaign; what it knows of the fields takes seconds to find."""
        return planning.estimator_of(self.study)

    def _asking(self, **changes):
        if changes and self.fair_size is not None:  # what was chosen answers the study's own question alone
            plain = replace(self.question, half_width=None, relative_half_width=None, **changes)
            return estimators.MonteCarlo(plain, self.fair_size)
        estimator = copy(self._estimator)
        estimator.question = replace(self.question, **changes)
        return estimator

    def curve(self, limits: np.ndarray) -> Band:
        """Estimate the exceedance curve of the quantity in question."""
        return self._asking().exceedance_curve(self.rows, limits)

    def without_failures(self) -> estimators.Estimate:
        """The answer had the failed and censored simulations come to an ordinary end.

        Failed ones count as not exceeding; a mean or quantile leaves them out, but for a quantile of a design or of
        several levels, whose interval counts them both ways here too.
        """
        rows = self.rows
        if self.approaches_limit:  # what followed from a failed one would have been another
            return self.estimate(rows)
        failed = rows.is_failed & (rows.level == 0)
        rows = replace(rows, is_censored=rows.is_censored & (rows.level > 0))
        if self.question.kind == "exceedance":
            return self.estimate(replace(rows, value=np.where(failed, 0.0, rows.value)))
        if self.is_plain:  # any of them may be left out; the others move up
            rows = replace(rows, index=rows.index - np.cumsum(failed)).where(~failed)
        return self.estimate(rows)

    def settling(self) -> Band:
        """Follow the answer as rows are added on all levels alike, over the number on the study's own cells."""
        numbers = np.array(self.rows.numbers(int(self.rows.level.max(initial=0)) + 1))
        if self.fair_size is not None:  # not the first ones on the own cells, but some among all indices
            numbers[0] = numbers.max()
        parts = [
            self.rows.first(np.ceil(share * numbers).astype(int)) for share in np.linspace(0.0, 1.0, STEPS + 1)[1:]
        ]
        found = [self.estimate(part) for part in parts]
        at = np.array([np.sum(part.level == 0) for part in parts])
        return Band(
            at, *(np.array([getattr(e, k) for e in found]) for k in ("value", "lower", "upper")), self.confidence
        )

    def discretisation(self) -> Discretisation | None:
        """Estimate the error of the cells from the realisations on the study's cells and on the coarser ones.

        Returns:
            Discretisation of the answer; None with fewer than FEWEST_PAIRS such realisations.
        """
        coarser = self.study.estimator and self.study.estimator.coarser_cells_m
        if not coarser:
            return None
        asked, cells = self.question, (self.study.discretisation.cell_m, *coarser)
        rows, stratum = self.rows, None
        if self.fair_size is not None:
            rows = self._estimator.used(rows)
            stratum = self._estimator.strata(rows)
        if asked.kind == "quantile":
            found = discretisation_of_quantile(rows, asked.probability, cells, self.confidence, stratum)
        else:
            functions = Exceedances(np.array([asked.limit])) if asked.kind == "exceedance" else Value()
            found = discretisation(rows, functions, cells, self.confidence, stratum)
        return None if found is None or found.n < FEWEST_PAIRS else found
