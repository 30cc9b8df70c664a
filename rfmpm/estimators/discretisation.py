"""Discretisation error of an expectation from realisations run on several cell sizes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.question import Functions
from rfmpm.estimators.rows import Rows

ASSUMED_ORDER = 1.0
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
