"""Expectations given an event: a ratio of two estimates from the same units, with its interval."""

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.estimators.linear import LinearEstimator
from rfmpm.estimators.protocol import Expectation
from rfmpm.estimators.question import Functions
from rfmpm.estimators.rows import Rows

FEWEST = 10  # occurrences and non-occurrences among the event's rows for the interval of a ratio of probabilities


@dataclass(frozen=True)
class _Joint:
    """k functions times the indicator of an event, and the indicator itself as the last column."""

    functions: Functions
    event: Functions
    is_probability: bool = False  # their intervals are not asked for

    def __call__(self, rows: Rows) -> np.ndarray:
        occurs = self.event(rows)
        return np.hstack([self.functions(rows) * occurs, occurs])


def given(estimator: LinearEstimator, rows: Rows, functions: Functions, event: Functions) -> Expectation:
    """Estimate the means of k functions of the quantity among the realisations in which an event occurs.

    Failed realisations on the study's own cells are left out of the values; the bounds of probabilities count them as
    realisations of the event with each of both outcomes.

    Args:
        estimator: of the campaign.
        rows: of the campaign.
        functions: k functions.
        event: one function that is 1 where the event occurs and 0 where not, e.g. Exceedances of 0 for "any failure".

    Returns:
        Expectation, shape (k,); NaN and boundless (0 to 1 for probabilities) where the event never occurs.

    Source: Cochran (1977), Sampling Techniques, section 2.11. Where few rows have the event, or too few of them an
    outcome, a probability has Clopper-Pearson's interval of level 0's rows alone, which is exact for plain Monte Carlo
    and wider than need be for the others.
    """
    used = estimator.used(rows)
    joint = _Joint(functions, event)
    outcome = joint(used)
    found = estimator.contributions(outcome, used, joint)
    value, error, half = _ratio(found, estimator.question.confidence)
    lower, upper = value - half, value + half
    if not functions.is_probability:
        lower, upper = np.where(np.isnan(value), -np.inf, lower), np.where(np.isnan(value), np.inf, upper)
        return Expectation(value, error, lower, upper)
    own = outcome[used.level == 0]
    n_failed = int(np.isnan(own[:, -1]).sum())
    total, count = np.nansum(own[:, -1]), np.nansum(own[:, :-1], axis=0)
    low, _ = clopper_pearson(count, total + n_failed, estimator.question.confidence)
    _, high = clopper_pearson(count + n_failed, total + n_failed, estimator.question.confidence)
    is_plain = (np.minimum(count, total - count) >= FEWEST) & (n_failed == 0) & np.isfinite(value)
    value = np.clip(value, 0.0, 1.0)
    lower = np.where(is_plain, np.clip(lower, 0.0, 1.0), np.fmin(low, value))
    upper = np.where(is_plain, np.clip(upper, 0.0, 1.0), np.fmax(high, value))
    return Expectation(value, error, lower, upper)


def _ratio(found: Contributions, confidence: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ratios of the first columns to the last one, their standard errors and half widths, shape (k,) each."""
    total = found.value
    k = total.size - 1
    if not total[-1] > 0.0:
        return (np.full(k, np.nan), *np.full((2, k), np.inf))
    value = total[:-1] / total[-1]
    rest = (found.unit[:, :-1] - value * found.unit[:, -1:]) / total[-1]
    linear = Contributions(rest, found.stratum, np.zeros(k))
    error = linear.standard_error()
    return value, error, stdtrit(linear.degrees_of_freedom(), 0.5 + confidence / 2.0) * error
