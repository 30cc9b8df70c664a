"""Discretisation error of an expectation from realisations run on several cell sizes, and the error budget."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.monte_carlo import Estimate
from rfmpm.estimators.question import Functions
from rfmpm.estimators.rows import Rows

ASSUMED_ORDER = 1.0
ORDERS = (0.5, 3.0)  # an observed order outside says that the cells are not yet in the range where one holds
BALANCE = 0.5  # of the smaller over the larger error: within it both are worth spending on
COST_EXPONENT = 3.0  # of time with 1 / cell size: points times steps in two dimensions


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


def discretisation(
    rows: Rows, functions: Functions, cells_m: Sequence[float], confidence: float = 0.95
) -> Discretisation | None:
    """Estimate the discretisation error of one expectation from realisations that were simulated on several levels.

    The difference of neighbouring levels, extrapolated to vanishing cells: error = difference / (ratio ** order - 1),
    difference = coarser less finer, with opposite sign. Only realisations completed on all levels count.

    Args:
        rows: of the campaign.
        functions: one function: Value(), or Exceedances of one limit.
        cells_m: cell size of each level, finest first [m].
        confidence: level of the interval [-].

    Returns:
        Discretisation; None with fewer than two levels that have two completed realisations in common.

    Source: Roache (1998), Verification and Validation in Computational Science and Engineering, section 5.
    """
    outcome = _common(rows, functions, len(cells_m))
    if outcome.shape[1] < 2:
        return None
    n = len(outcome)
    cells = tuple(float(h) for h in cells_m[: outcome.shape[1]])
    steps = np.diff(outcome, axis=1)  # coarser less finer
    order, is_observed, note = _order(steps, cells)
    factor = 1.0 / ((cells[1] / cells[0]) ** order - 1.0)
    unit = factor * steps[:, :1] / n
    found = Contributions(unit, np.zeros(n, int), np.zeros(1)).expectation(confidence, is_probability=False)
    value, error, lower, upper = (float(column[0]) for column in found)
    if functions.is_probability:  # as if one more indicator differed: that none of n does leaves room for some
        unseen = factor / (n + 2.0)
        half = math.hypot(upper - value, float(ndtri(0.5 + confidence / 2.0)) * unseen)
        error, lower, upper = math.hypot(error, unseen), value - half, value + half
    return Discretisation(value, error, lower, upper, order, is_observed, cells, n, note)


def _common(rows: Rows, functions: Functions, levels: int) -> np.ndarray:
    """Outcomes of the realisations that completed on level 0, 1, ..., as many levels as have two of them in common."""
    per_level = [rows.where((rows.level == level) & ~rows.is_failed) for level in range(levels)]
    common, kept = per_level[0].index, 1
    for other in per_level[1:]:
        both = np.intersect1d(common, other.index)
        if both.size < 2:
            break
        common, kept = both, kept + 1
    chosen = [level.where(np.isin(level.index, common)) for level in per_level[:kept]]
    return np.hstack([functions(level) for level in chosen])


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


@dataclass(frozen=True)
class Budget:
    """Where the error of an estimate comes from, and what to spend on next.

    Attributes:
        sampling: half width of the estimate's interval, unit of the estimate.
        discretisation: magnitude the discretisation error may have, the larger end of its interval; NaN if unknown.
        spend_on: "realisations", "cells", "both" or "levels" (nothing is known of the discretisation error).
        realisations_factor: number of realisations over the present one at which both errors are equal [-].
        cell_m: cell size at which both errors are equal [m]; NaN if unknown.
        advice: in a sentence.
    """

    sampling: float
    discretisation: float
    spend_on: str
    realisations_factor: float
    cell_m: float
    advice: str


def error_budget(estimate: Estimate, found: Discretisation | None) -> Budget:
    """Say which of the sampling and the discretisation error to reduce next.

    Args:
        estimate: the answer with its interval.
        found: its discretisation error; None where nothing is known.

    Returns:
        Budget.
    """
    sampling = 0.5 * (estimate.upper - estimate.lower)
    if found is None or not math.isfinite(found.upper - found.lower):
        advice = "Nothing is known of the discretisation error: run a few realisations on coarser cells as well."
        return Budget(sampling, math.nan, "levels", math.nan, math.nan, advice)
    bias = max(abs(found.lower), abs(found.upper))
    known = abs(found.error)
    if not math.isfinite(sampling):
        advice = "Sampling error without bound: run more realisations."
        return Budget(sampling, bias, "realisations", math.inf, found.cells[0], advice)
    if bias == 0.0 and sampling == 0.0:
        return Budget(0.0, 0.0, "both", 1.0, found.cells[0], "Neither error is seen.")
    if bias > known + 2.0 * abs(known) and bias > sampling:
        advice = f"The discretisation error is not known well: more than the {found.n} realisations on coarser cells."
        return Budget(sampling, bias, "levels", 1.0, found.cells[0], advice)
    factor = max(1.0, (sampling / bias) ** 2) if bias > 0.0 else math.inf
    cell = found.cells[0] * min(1.0, (sampling / bias) ** (1.0 / found.order)) if bias > 0.0 else found.cells[0]
    if BALANCE * sampling <= bias <= sampling / BALANCE:
        advice = "Sampling and discretisation error are of one size: halving the whole error needs more of both."
        return Budget(sampling, bias, "both", factor, cell, advice)
    if sampling > bias:
        more = f"about {factor:.2g} times as many" if math.isfinite(factor) else "more"
        return Budget(sampling, bias, "realisations", factor, cell, f"Sampling error prevails: {more} realisations.")
    cost = (found.cells[0] / cell) ** COST_EXPONENT
    advice = f"Discretisation error prevails: cells of about {cell:.2g} m, each run about {cost:.2g} times the cost."
    return Budget(sampling, bias, "cells", factor, cell, advice)
