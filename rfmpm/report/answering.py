"""Answers from the rows of a campaign, by the estimator that planned it."""

from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from rfmpm import estimators, planning
from rfmpm.estimators.curves import Band
from rfmpm.estimators.rows import Rows
from rfmpm.report.members import CENSORED_BY, first_index, flagged

FEWEST_PAIRS = 10  # realisations on two levels; with fewer the error of the cells is not estimated
RESAMPLES = 200
STEPS = 12  # at which an answer is followed as rows are added


@dataclass(frozen=True)
class Discretisation:
    """What realisations simulated on two sizes of cells tell of the error of the cells."""

    cell: float  # of the study [m]
    coarser: float  # [m]
    pairs: int
    difference: float  # of the answer, the study's cells less the coarser ones
    standard_error: float  # of it
    error: float  # to either side, of the answer on the study's cells, at the level of the interval


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

    def rows_of(self, quantity: str) -> Rows:
        """What estimators see of a quantity; a part of a study counts from its own first realisation."""
        data = self.dataset
        value = data[quantity].values.astype(float)
        censored = flagged(data, *CENSORED_BY[quantity]) & ~np.isnan(value)
        index = data["realisation"].values - first_index(data)
        return planning.as_rows(data["level"].values, index, value, censored, data["step_count"].values, self.points)

    def estimate(self, rows: Rows, **changes) -> estimators.Estimate:
        """Answer the question, or that one with some of its parts changed, from some rows."""
        return self._asking(**changes).estimate(rows)

    def _asking(self, **changes):
        estimator = copy(planning.estimator_of(self.study))
        estimator.question = replace(self.question, **changes)
        return estimator

    def curve(self, limits: np.ndarray) -> Band:
        """Estimate the exceedance curve of the quantity in question."""
        return self._asking().exceedance_curve(self.rows, limits)

    def without_failures(self) -> estimators.Estimate:
        """The answer had the failed and censored simulations come to an ordinary end."""
        rows = self.rows
        value = np.where(rows.is_failed & (rows.level == 0), 0.0, rows.value)
        return self.estimate(replace(rows, value=value, is_censored=np.zeros(value.shape, bool)))

    def settling(self) -> Band:
        """Follow the answer as rows are added on all levels alike, over the number on the study's own cells."""
        numbers = np.array(self.rows.numbers(int(self.rows.level.max(initial=0)) + 1))
        shares = np.linspace(1.0 / STEPS, 1.0, STEPS)
        found = [self.estimate(self.rows.first(np.ceil(share * numbers).astype(int))) for share in shares]
        at = np.ceil(shares * numbers[0])
        return Band(
            at, *(np.array([getattr(e, k) for e in found]) for k in ("value", "lower", "upper")), self.confidence
        )

    def discretisation(self) -> Discretisation | None:
        """Estimate the error of the cells from the realisations on the study's cells and on the next coarser ones.

        The error is taken to be proportional to the side of the cells, so that of the finer ones is the difference
        divided by the ratio of the sides less 1; to its size the half width of its normal interval is added.

        Returns:
            Discretisation; None with fewer than FEWEST_PAIRS such realisations.

        Source: Richardson (1911), Phil. Trans. R. Soc. A 210, 307-357.
        """
        coarser = self.study.estimator and self.study.estimator.coarser_cells_m
        for level, cell in enumerate(coarser or (), 1):
            fine, coarse = self._pairs(level)
            if fine[0].size >= FEWEST_PAIRS:
                from scipy.special import ndtri

                difference, error = self._difference(fine, coarse)
                ratio = cell / self.study.discretisation.cell_m
                size = (abs(difference) + ndtri(0.5 + self.confidence / 2.0) * error) / (ratio - 1.0)
                own = self.study.discretisation.cell_m
                return Discretisation(own, cell, fine[0].size, difference, error, float(size))
        return None

    def _pairs(self, level: int):
        """Values and censored marks of the realisations that completed on both levels."""
        own, other = (self.rows.on_level(k).where(~self.rows.on_level(k).is_failed) for k in (0, level))
        _, mine, theirs = np.intersect1d(own.index, other.index, return_indices=True)
        return (own.value[mine], own.is_censored[mine]), (other.value[theirs], other.is_censored[theirs])

    def _difference(self, fine, coarse) -> tuple[float, float]:
        """Difference of the answer between paired values, and its standard error."""
        asked = self.question
        if asked.kind == "quantile":
            return _difference_of_quantiles(fine[0], coarse[0], asked.probability)
        outcomes = [v if asked.kind == "mean" else ((v > asked.limit) | c).astype(float) for v, c in (fine, coarse)]
        gap = outcomes[0] - outcomes[1]
        return float(gap.mean()), float(gap.std(ddof=1) / np.sqrt(gap.size))


def _difference_of_quantiles(fine: np.ndarray, coarse: np.ndarray, probability: float) -> tuple[float, float]:
    """Difference of a quantile between paired values, and its standard error by resampling pairs."""
    generator = np.random.default_rng(0)
    drawn = generator.integers(fine.size, size=(RESAMPLES, fine.size))
    resampled = np.quantile(fine[drawn], probability, axis=1) - np.quantile(coarse[drawn], probability, axis=1)
    return float(np.quantile(fine, probability) - np.quantile(coarse, probability)), float(resampled.std(ddof=1))
