"""The whole error of the answer, part by part, and what to spend on next."""

from dataclasses import dataclass

import numpy as np

from rfmpm.estimators import Estimate
from rfmpm.estimators.discretisation import Discretisation
from rfmpm.report import words
from rfmpm.report.answering import FEWEST_PAIRS
from rfmpm.report.asked import Asked
from rfmpm.study.question_models import FIRST_OF_TWO_PHASES

FEW = 10  # members beyond the limit; with fewer a probability rests on a handful of simulations
EDGE_SHARE = 0.05  # of the simulations at an edge of the model from which the model is the first thing to enlarge


@dataclass(frozen=True)
class Budget:
    """Parts of the error of the answer, each in its unit."""

    sampling: float  # half width of the interval that the number of realisations alone would give
    failed: float  # what failed and censored realisations add to it
    discretisation: (
        float | None
    )  # how far the cells may have moved the answer, to the side they may more; None: unknown
    lower: float  # of the answer, all known parts together
    upper: float

    @property
    def is_whole(self) -> bool:
        """Whether the error of the cells is known and part of the bounds."""
        return self.discretisation is not None


def budget(answer: Estimate, ordinary: Estimate, cells: Discretisation | None, asked: Asked) -> Budget:
    """Put the parts together.

    Args:
        answer: the estimate with its interval, failed and censored realisations as bounds.
        ordinary: the estimate had the failed and censored realisations come to an ordinary end.
        cells: error of the cells, the answer less that of vanishing ones; None if it is unknown.
        asked: the question.

    Returns:
        Budget; its bounds add the error of the cells to the interval, which is never too narrow.
    """
    sampling = 0.5 * (ordinary.upper - ordinary.lower)
    half = 0.5 * (answer.upper - answer.lower)
    failed = half - sampling if np.isfinite(half - sampling) else (np.inf if np.isfinite(sampling) else 0.0)
    down, up = (max(cells.upper, 0.0), max(-cells.lower, 0.0)) if cells else (0.0, 0.0)
    lower, upper = answer.lower - down, answer.upper + up
    if np.isfinite(lower):
        lower = max(lower, 0.0)  # no quantity is negative
    if asked.is_probability:
        upper = min(upper, 1.0)
    return Budget(sampling, max(failed, 0.0), max(down, up) if cells else None, lower, upper)


@dataclass(frozen=True)
class Standing:
    """What the advice on the next step rests on."""

    asked: Asked
    answer: Estimate
    budget: Budget
    is_random: bool  # whether realisations differ
    used: int
    completed: int
    beyond: int  # completed members beyond the limit (0 unless a probability is asked)
    at_back: int  # slides that met the edge behind the crest
    at_front: int  # slides that met the far wall
    wanted: float  # half width that the question wants, in the unit of the answer; infinite if none


def next_steps(standing: Standing, study) -> list[str]:
    """Say what would improve the answer most, the most urgent first.

    Args:
        standing: of the answer.
        study: the Study.

    Returns:
        At most two sentences.
    """
    s = standing
    if not s.completed:
        return ["Find out why the simulations fail; the reasons are listed below."]
    if not s.is_random:
        return ["Say how the strength varies: a table [random_field.cohesion] in the study file."]
    spending = [_more(s), _cells(s, study)]
    if s.budget.is_whole and s.budget.discretisation > s.budget.sampling:
        spending.reverse()
    return [step for step in (_enlarge(s, study), _repair(s), *spending) if step][:2]


def _enlarge(s: Standing, study) -> str:
    worst = max(s.at_back, s.at_front)
    if worst <= EDGE_SHARE * s.completed or study.geometry.kind != "slope":
        return ""
    key = "crest_m" if s.at_back >= s.at_front else "foreland_m"
    side = "behind the crest" if key == "crest_m" else "beyond the toe"
    return (
        f"Model more ground {side} (geometry.{key}, now {getattr(study.geometry, key):g} m): "
        f"{words.count(worst, 'slide')} of {s.completed} met that edge."
    )


def _repair(s: Standing) -> str:
    failed = s.used - s.completed
    if failed > max(s.at_back, s.at_front) and s.budget.failed > s.budget.sampling:
        return "Find out why simulations failed: they widen the answer more than the number of simulations does."
    return ""


def _more(s: Standing) -> str:
    half = s.budget.sampling
    if 0.5 * (s.answer.upper - s.answer.lower) <= s.wanted < np.inf:
        return ""
    if 0.0 < s.wanted < half < np.inf:
        needed = s.used * (half / s.wanted) ** 2
        return f"Run on: about {words.number(needed, 2)} simulations in all would give the precision asked for."
    if s.asked.is_probability and s.beyond < FEW:
        needed = max(FEW * s.used / max(s.beyond, 1), 10.0 * FEW)
        return f"Run more, at least {words.number(needed, 1)} simulations{_or_rare(s)}: too few exceed the limit."
    if s.budget.discretisation is not None and half >= s.budget.discretisation:
        return "Run more simulations: their number is the larger error, and four times as many halve it."
    return ""


def _or_rare(s: Standing) -> str:
    rare = ', or look for the rare with method = "stratified" in [estimator]'
    return rare if s.beyond < 0.1 * s.completed else ""


def _cells(s: Standing, study) -> str:
    if s.budget.discretisation is None:
        return _two_sizes(s, study)
    if s.budget.discretisation > s.budget.sampling:
        return (
            f"Use finer cells (discretisation.cell_m, now {study.discretisation.cell_m:g} m): "
            "their size is the larger error, and more simulations cannot lower it."
        )
    return ""


def _two_sizes(s: Standing, study) -> str:
    """How to learn the error of the cells: nothing but time where the study has two sizes of them already."""
    if study.estimator is not None and study.estimator.coarser_cells_m:
        return f"Run on: what the size of the cells adds is known from {FEWEST_PAIRS} simulations on both sizes."
    cell, coarser = _pair_of_cells(study)
    own = "" if cell == study.discretisation.cell_m else f"discretisation.cell_m = {cell:g}, "
    method = "multilevel" if s.asked.quantile is not None else "two_phase"  # no gain for a quantile
    until = ""
    if study.study.until is None:
        most = max(study.study.realisations, 2 * FIRST_OF_TWO_PHASES)
        question = f'quantity = "{s.asked.quantity}", exceeds_m = {s.asked.limit:g}, at_most = {most}'
        until = f" and in [study], instead of realisations, until = {{ {question} }}"
    return (
        f"Learn what the size of the cells adds: in the study file, {own}coarser_cells_m = [{coarser:g}] and "
        f'method = "{method}" in [estimator]{until}; the coarser simulations are cheap.'
    )


def _pair_of_cells(study) -> tuple[float, float]:
    """Cells to simulate on and coarser ones beside them; softening over a length allows none larger than it [m]."""
    cell = study.discretisation.cell_m
    lengths = [m.softening_length_m for m in study.material if getattr(m, "softening_length_m", None)]
    return (cell, 2.0 * cell) if 2.0 * cell <= min(lengths, default=np.inf) else (0.5 * cell, cell)
