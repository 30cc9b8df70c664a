"""Discretisation error of an expectation or a quantile from realisations run on several cell sizes.

Where the coarser runs decided which realisations were repeated on the study's own cells, these are no fair sample: each
stratum then counts by its share of the coarser runs.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.phases import Parts, stratified
from rfmpm.estimators.question import Functions, Value
from rfmpm.estimators.rows import Rows

ASSUMED_ORDER = 1.0
RESAMPLES = 200  # of the pairs, for the scatter of a quantile
ORDERS = (0.5, 3.0)  # an observed order outside says that the cells are not yet in the range where one holds


@dataclass(frozen=True)
class Discretisation:
    """What the cell size does to an expectation.

    Attributes:
        error: estimated error of level 0, its value less the one of vanishing cells, unit of the quantity (or [-]).
        standard_error: sampling error of that.
        lower: of the error's confidence interval.
        upper: of the error's confidence interval.
        order: with which the error falls with the cell size [-].
        is_observed: whether the order comes from three levels; otherwise it is assumed.
        cells: cell sizes the error rests on, finest first [m].
        n: common realisations it rests on.
        note: what must be known to read it.
    """

    error: float
    standard_error: float
    lower: float
    upper: float
    order: float
    is_observed: bool
    cells: tuple[float, ...]
    n: int
    note: str


@dataclass(frozen=True)
class Pairs:
    """Realisations that completed on levels 0, 1, ...

    Attributes:
        outcome: a function of the quantity on each level, shape (n, levels).
        stratum: of each, shape (n,) [-].
        held: realisations from whose coarser runs those of each stratum were chosen, shape (strata,) [-]; None where
            they are a fair sample, of one stratum.
    """

    outcome: np.ndarray
    stratum: np.ndarray
    held: np.ndarray | None

    @property
    def taken(self) -> np.ndarray:
        """Realisations of each stratum, shape (strata,) [-]."""
        return np.bincount(self.stratum)

    @property
    def shares(self) -> np.ndarray:
        """Share of each stratum in all realisations, shape (strata,) [-]."""
        return np.ones(1) if self.held is None else self.held / self.held.sum()

    def mean(self, values: np.ndarray) -> Contributions:
        """Contributions to the mean of values of the realisations, shape (n, 1)."""
        if self.held is None:
            n = len(values)
            return Contributions(values / n, np.zeros(n, int), np.zeros(1))
        first = np.cumsum(self.held) - self.held  # the realisations stratum by stratum, those with values first
        places = np.concatenate([start + np.arange(n) for start, n in zip(first, self.taken, strict=True)])
        rest, chosen = np.zeros((int(self.held.sum()), 1)), np.zeros(int(self.held.sum()), bool)
        rest[places], chosen[places] = values[np.argsort(self.stratum, kind="stable")], True
        return stratified(Parts(rest, np.zeros(rest.shape)), chosen, np.repeat(np.arange(self.held.size), self.held))

    def resampled(self, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray | None]:
        """Realisations drawn again within their strata, and the weight of each; shape (RESAMPLES, n) both."""
        n = len(self.outcome)
        if self.held is None:
            return generator.integers(n, size=(RESAMPLES, n)), None
        drawn = np.empty((RESAMPLES, n), int)
        for stratum, count in enumerate(self.taken):
            here = np.flatnonzero(self.stratum == stratum)
            drawn[:, here] = here[generator.integers(count, size=(RESAMPLES, count))]
        sizes = generator.multinomial(self.held.sum(), self.shares, size=RESAMPLES)
        return drawn, (sizes / self.taken)[:, self.stratum]


def discretisation(
    rows: Rows,
    functions: Functions,
    cells_m: Sequence[float],
    confidence: float = 0.95,
    stratum: np.ndarray | None = None,
) -> Discretisation | None:
    """Estimate the discretisation error of one expectation from realisations that were simulated on several levels.

    The difference of neighbouring levels, extrapolated to vanishing cells: error = difference / (ratio ** order - 1),
    difference = coarser less finer, with opposite sign. Only realisations completed on all levels count.

    Args:
        rows: of the campaign.
        functions: one function: Value(), or Exceedances of one limit.
        cells_m: cell size of each level, finest first [m].
        confidence: level of the interval [-].
        stratum: of every realisation on level 1, shape (n,) [-], where level 0 has the first ones of each stratum; None
            where what is on all levels is a fair sample.

    Returns:
        Discretisation; None with fewer than two levels that have two completed realisations in common.

    Source: Roache (1998), Verification and Validation in Computational Science and Engineering, section 5; Cochran
    (1977), Sampling Techniques, section 12.2.
    """
    pairs = _pairs(rows, functions, len(cells_m), stratum)
    if pairs.outcome.shape[1] < 2:
        return None
    cells = tuple(float(h) for h in cells_m[: pairs.outcome.shape[1]])
    steps = np.diff(pairs.outcome, axis=1)  # coarser less finer
    order, is_observed, note = _order(steps, cells)
    factor = 1.0 / ((cells[1] / cells[0]) ** order - 1.0)
    found = pairs.mean(factor * steps[:, :1]).expectation(confidence, is_probability=False)
    value, error, lower, upper = (float(column[0]) for column in found)
    if functions.is_probability:  # as if one more indicator differed: that none of n does leaves room for some
        unseen = factor * float(np.max(pairs.shares / (pairs.taken + 2.0)))
        half = math.hypot(upper - value, float(ndtri(0.5 + confidence / 2.0)) * unseen)
        error, lower, upper = math.hypot(error, unseen), value - half, value + half
    return Discretisation(value, error, lower, upper, order, is_observed, cells, len(steps), note)


def discretisation_of_quantile(
    rows: Rows,
    probability: float,
    cells_m: Sequence[float],
    confidence: float = 0.95,
    stratum: np.ndarray | None = None,
) -> Discretisation | None:
    """The same of the quantile of a probability, from the two finest levels, resampled; first order is assumed.

    Args:
        rows: of the campaign.
        probability: of the quantile [-].
        cells_m: as for `discretisation`.
        confidence: as for `discretisation`.
        stratum: as for `discretisation`.

    Returns:
        Discretisation; None with fewer than two realisations in common.
    """
    pairs = _pairs(rows, Value(), 2, stratum)
    if pairs.outcome.shape[1] < 2:
        return None
    values, ratio = pairs.outcome.T, cells_m[1] / cells_m[0]
    drawn, weights = pairs.resampled(np.random.default_rng(0))
    own = None if weights is None else (pairs.shares / pairs.taken)[pairs.stratum]
    error = float(np.diff(_quantile(values, probability, own))[0]) / (ratio - 1.0)
    scatter = float(np.diff(_quantile(values[:, drawn], probability, weights), axis=0).std(ddof=1)) / (ratio - 1.0)
    half = float(ndtri(0.5 + confidence / 2.0)) * scatter
    note = f"order {ASSUMED_ORDER:g} assumed; scatter by resampling"
    cells = tuple(float(h) for h in cells_m[:2])
    return Discretisation(error, scatter, error - half, error + half, ASSUMED_ORDER, False, cells, len(drawn[0]), note)


def _quantile(values: np.ndarray, probability: float, weights: np.ndarray | None) -> np.ndarray:
    """Quantile along the last axis."""
    if weights is None:
        return np.quantile(values, probability, axis=-1)
    weights = np.broadcast_to(weights, values.shape)
    return np.quantile(values, probability, axis=-1, weights=weights, method="inverted_cdf")


def _pairs(rows: Rows, functions: Functions, levels: int, stratum: np.ndarray | None) -> Pairs:
    """The realisations that completed on level 0, 1, ..., as many levels as have two of them in common."""
    per_level = [rows.where((rows.level == level) & ~rows.is_failed) for level in range(levels)]
    common, kept = per_level[0].index, 1
    for other in per_level[1:]:
        both = np.intersect1d(common, other.index)
        if both.size < 2:
            break
        common, kept = both, kept + 1
    chosen = [level.where(np.isin(level.index, common)) for level in per_level[:kept]]
    outcome = np.hstack([functions(level) for level in chosen])
    if stratum is None or kept < 2:
        return Pairs(outcome, np.zeros(len(outcome), int), None)
    there, of = np.unique(stratum[common], return_inverse=True)  # a stratum without pairs is left out
    return Pairs(outcome, of, np.bincount(stratum)[there])


def _order(steps: np.ndarray, cells: Sequence[float]) -> tuple[float, bool, str]:
    """Order, whether it is observed, and why not."""
    assumed = f"order {ASSUMED_ORDER:g} assumed"
    if len(cells) < 3:
        return ASSUMED_ORDER, False, f"{assumed}: two cell sizes show a difference, three would show an order"
    means = steps.mean(axis=0)
    errors = steps.std(axis=0, ddof=1) / math.sqrt(len(steps))
    if np.any(np.abs(means[:2]) < 2.0 * errors[:2]) or means[0] * means[1] <= 0.0:
        return ASSUMED_ORDER, False, f"{assumed}: the differences of the cell sizes do not stand out of the scatter"
    order = _solve_order(means[1] / means[0], cells)
    if order is None:
        return (
            ASSUMED_ORDER,
            False,
            f"{assumed}: the differences of the cell sizes do not fall as an order would have it",
        )
    return order, True, "order observed on three cell sizes"


def _solve_order(ratio: float, cells: Sequence[float]) -> float | None:
    """Order p with (h2^p - h1^p) / (h1^p - h0^p) = ratio; None if there is none within ORDERS."""
    from scipy.optimize import brentq

    def miss(order: float) -> float:
        fine, middle, coarse = (h**order for h in cells[:3])
        return (coarse - middle) / (middle - fine) - ratio

    return float(brentq(miss, *ORDERS)) if miss(ORDERS[0]) * miss(ORDERS[1]) <= 0.0 else None
