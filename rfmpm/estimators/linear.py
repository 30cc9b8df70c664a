"""What every linear estimator answers once it can say what its units contribute: estimates, curves, quantiles."""

from abc import ABC, abstractmethod
from dataclasses import replace

import numpy as np

from rfmpm.estimators.bands import simultaneous_factor
from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.curves import Band
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.estimators.inversion import invert
from rfmpm.estimators.monte_carlo import Estimate
from rfmpm.estimators.protocol import Expectation
from rfmpm.estimators.question import Exceedances, Functions, Question, Value
from rfmpm.estimators.rows import Rows

FEW = 10  # events on level 0, below which an interval may not be narrower than the exact one


class LinearEstimator(ABC):
    """Answers of an estimator that offers `used(rows)` and `contributions(outcome, rows, functions)`."""

    question: Question
    method: str

    @abstractmethod
    def used(self, rows: Rows) -> Rows:
        """Return the rows that an estimate may rest on: those without a gap before them."""

    @abstractmethod
    def contributions(self, outcome: np.ndarray, rows: Rows, functions: Functions) -> Contributions:
        """Return what the units of the used rows contribute.

        Args:
            outcome: of the functions, shape (n, k); NaN where the row failed.
            rows: as `used` gives them.
            functions: whose expectations are estimated.
        """

    def is_fair(self, used: Rows) -> np.ndarray:
        """Return which of the used rows are a fair sample on the study's own cells, shape (n,)."""
        return used.level == 0

    def expectation(self, rows: Rows, functions: Functions) -> Expectation:
        """Estimate the means of k functions of the quantity, each with its own interval.

        Failed simulations on the study's own cells are left out of the values; intervals of probabilities run from the
        bound with each of them counted as 0 to the bound with each counted as 1.

        Args:
            rows: of the campaign.
            functions: Value or Exceedances.

        Returns:
            Expectation, arrays of shape (k,).
        """
        used = self.used(rows)
        outcome = functions(rows)[_place(used, rows)]
        confidence = self.question.confidence
        failed = np.isnan(outcome[:, :1]) & (used.level == 0)[:, None]
        is_probability = functions.is_probability
        found = self.contributions(outcome, used, functions).expectation(confidence, is_probability)
        if is_probability:
            found = _wide_where_few(found, outcome[self.is_fair(used) & ~failed[:, 0]], confidence)
        if not is_probability or not failed.any():
            return found
        low, high = (
            self.contributions(np.where(failed, filled, outcome), used, functions).expectation(confidence, True)
            for filled in (0.0, 1.0)
        )
        lower, upper = np.minimum(low.lower, found.lower), np.maximum(high.upper, found.upper)
        return found._replace(lower=np.where(np.isnan(lower), 0.0, lower), upper=np.where(np.isnan(upper), 1.0, upper))

    def estimate(self, rows: Rows) -> Estimate:
        """Answer the question.

        Args:
            rows: of the campaign.

        Returns:
            Estimate; NaN with an infinite interval (0 to 1 for a probability) where nothing completed.
        """
        asked = self.question
        if asked.kind == "quantile":
            found = self.quantile(rows, asked.probability)
        else:
            functions = Value() if asked.kind == "mean" else Exceedances(np.array([asked.limit]))
            expected = self.expectation(rows, functions)
            value, error, lower, upper = (float(column[0]) for column in expected)
            n = int(np.sum(self.used(rows).level == 0))
            found = Estimate(value, lower, upper, asked.confidence, n, self.method, standard_error=error)
        return replace(found, note="; ".join(self.notes(rows, found)))

    def notes(self, rows: Rows, found: Estimate) -> list[str]:
        """Return what must be known to read an estimate."""
        used = self.used(rows)
        own = used.on_level(0)
        failed, censored = int(own.is_failed.sum()), int((own.is_censored & ~own.is_failed).sum())
        is_mean = self.question.kind == "mean"
        notes = []
        if failed:
            fate = "left out" if is_mean else "counted both ways, which widens the interval"
            notes.append(f"{failed} failed of {own.value.size} {fate}")
        coarse_failed = int((used.is_failed & (used.level > 0)).sum())
        if coarse_failed:
            fate = "average" if is_mean else "exceeding"
            notes.append(
                f"{coarse_failed} failed on coarser cells, counted there as {fate}: this does not bias the estimate"
            )
        if censored:
            fate = "taken at their value, so the mean is a lower bound" if is_mean else "counted as exceeding"
            notes.append(f"{censored} censored {fate}")
        if failed == own.value.size:
            notes.append("no completed realisation: nothing is known")
        elif own.value.size - failed < 2 and is_mean:
            notes.append("fewer than two values: no interval")
        elif is_mean and found.standard_error == 0.0:
            notes.append("all values are equal: the interval has no width and is not evidence of precision")
        return notes

    def exceedance_curve(self, rows: Rows, limits: np.ndarray | None = None) -> Band:
        """Estimate P(X > l) as a function of l with a band for each l and one for all l at once.

        Value and bands are clipped into 0 to 1 and made to fall with l; the value by averaging neighbours that do not
        (pool adjacent violators), a band by the least and the greatest value before it, which loses no coverage.

        Args:
            rows: of the campaign.
            limits: ascending, shape (k,), unit of the quantity; None takes those at hand, thinned.

        Returns:
            Band over the limits.
        """
        limits = self.limits(rows) if limits is None else np.asarray(limits, float)
        expected = self.expectation(rows, Exceedances(limits))
        if not np.isfinite(expected.value).all():
            nothing = np.zeros(limits.shape), np.ones(limits.shape)
            return Band(limits, expected.value, *nothing, self.question.confidence, *nothing)
        factor = self._widening(rows, limits)
        wide_lower = expected.value - factor * (expected.value - expected.lower)
        wide_upper = expected.value + factor * (expected.upper - expected.value)
        lower, upper, wide_lower, wide_upper = (
            falling(np.clip(edge, 0.0, 1.0), is_upper)
            for edge, is_upper in (
                (expected.lower, False),
                (expected.upper, True),
                (wide_lower, False),
                (wide_upper, True),
            )
        )
        value = np.clip(pooled(expected.value), lower, upper)
        return Band(limits, value, lower, upper, self.question.confidence, wide_lower, wide_upper)

    def _widening(self, rows: Rows, limits: np.ndarray) -> float:
        """Half width of the simultaneous band over that of the pointwise one."""
        used, functions = self.used(rows), Exceedances(limits)
        found = self.contributions(functions(used), used, functions)
        return simultaneous_factor(found, self.question.confidence)

    def limits(self, rows: Rows, number: int = 200) -> np.ndarray:
        """Return at most so many values that the quantity took, ascending: where its curve has its steps."""
        used = self.used(rows)
        values = np.unique(used.value[~used.is_failed])
        if values.size <= number:
            return values
        return values[np.linspace(0, values.size - 1, number).round().astype(int)]

    def quantile(self, rows: Rows, probability: float) -> Estimate:
        """Estimate a quantile by inverting the exceedance curve and its pointwise interval.

        Args:
            rows: of the campaign.
            probability: of the quantile [-].

        Returns:
            Estimate in the unit of the quantity; a bound that the rows cannot give is infinite.

        Source: Woodruff (1952), J. Am. Stat. Assoc. 47, 635-646.
        """
        used = self.used(rows)
        values = np.unique(used.value[~used.is_failed])
        found = invert(lambda limits: self.expectation(rows, Exceedances(limits)), values, 1.0 - probability)
        n = int(np.sum(used.level == 0))
        method = f"{self.method}; curve inverted"
        return Estimate(*found, self.question.confidence, n, method)


def _wide_where_few(found: Expectation, own: np.ndarray, confidence: float) -> Expectation:
    """Hold the exact interval of the study's own cells too where few of them exceed, or do not.

    Neither a variance nor coefficients can be had from a handful of events.

    Args:
        found: the estimates.
        own: indicators of the completed realisations on level 0, shape (n, k).
        confidence: level [-].
    """
    n, count = len(own), own.sum(axis=0)
    if n == 0:
        return found
    lower, upper = clopper_pearson(count, n, confidence)
    is_few = np.minimum(count, n - count) < FEW
    return found._replace(
        lower=np.where(is_few, np.minimum(found.lower, lower), found.lower),
        upper=np.where(is_few, np.maximum(found.upper, upper), found.upper),
    )


def _place(used: Rows, rows: Rows) -> np.ndarray:
    """Where the used rows stand among all rows, which are sorted by level and index."""
    key = used.level.astype(np.int64) << 40 | used.index
    return np.searchsorted(rows.level.astype(np.int64) << 40 | rows.index, key)


def falling(edge: np.ndarray, is_upper: bool) -> np.ndarray:
    """Tighten the edge of a band around a curve that falls along the last axis, without losing coverage."""
    if is_upper:
        return np.minimum.accumulate(edge, axis=-1)
    return np.maximum.accumulate(edge[..., ::-1], axis=-1)[..., ::-1]


def pooled(value: np.ndarray) -> np.ndarray:
    """The falling curve nearest to a curve in squares, shape (k,)."""
    from scipy.optimize import isotonic_regression

    return isotonic_regression(value, increasing=False).x
