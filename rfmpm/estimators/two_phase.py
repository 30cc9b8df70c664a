"""Coarse runs of many realisations first; then the study's own cells where the coarse runs leave the answer open."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rfmpm.estimators.contributions import Contributions
from rfmpm.estimators.levels import FOLDS
from rfmpm.estimators.monte_carlo import Estimate, missing
from rfmpm.estimators.multilevel import sharing_functions
from rfmpm.estimators.phases import Phases, contributions, variances
from rfmpm.estimators.protocol import Runs
from rfmpm.estimators.question import Exceedances, Functions, Question
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.staged import LEAST_GROWTH, Staged
from rfmpm.estimators.strata import natural_breaks, quotas

FIRST = 32  # indices that are simulated on both cell sizes whatever they give
FIRST_COARSE = 128  # coarse runs whose values part all of them into strata
LARGEST_RATIO = 16.0  # of the numbers on the coarse and the own cells


class Stage(NamedTuple):
    """What is simulated by the end of a stage."""

    coarse: int  # indices from 0 on, on the coarse cells
    own: np.ndarray  # indices on the study's own cells, ascending
    wanted: int  # number of the latter that this many coarse ones are meant for


class TwoPhase(Staged):
    """Double sampling: of the coarse runs, those of uncertain outcome are repeated on the study's own cells.

    The first indices run on both cell sizes. Gaps between the first coarse values part all coarse runs into up to three
    strata; later stages take as many from each of them, in the order of the indices, so that the rare outcomes are met
    as often as the common ones. Features of the field with known means reduce the scatter of the coarse mean.

    Rows on the own cells are no fair sample but for the first indices.
    """

    method = "double sampling: coarse runs first, own cells where these leave it open"

    def __init__(
        self,
        question: Question,
        features: Callable[[range], np.ndarray] | None = None,
        realisations: int | None = None,
        first: int = FIRST,
    ):
        """Ask a question.

        Args:
            question: what is wanted.
            features: indices -> independent standard normals of their fields (principal components), shape (n, d); None
                for none.
            realisations: fixed number on the study's own cells; that on the coarse ones follows from it [-]. None where
                the question wants a half width.
            first: indices that are simulated on both cell sizes whatever they give [-].

        Raises:
            ValueError: if a number is out of range, or neither a number nor a half width is given.
        """
        super().__init__(question, realisations)
        self.components = features
        self.first = first
        self._ratios: dict[tuple, float] = {}  # by the rows that gave them: `plan` passes all stages at every call

    def plan(self, rows: Rows) -> list[Runs]:
        """Name the simulations of the present stage that have no row yet; empty when the question is answered."""
        stage = self.first_stage()
        while stage is not None:
            here = [rows.index[rows.level == level] for level in (0, 1)]
            own = np.setdiff1d(stage.own, here[0])
            todo = [Runs(0, part) for part in _ranges(own)]
            todo += [Runs(1, part) for part in missing(here[1], stage.coarse)]
            if todo:
                return todo
            stage = self.next_stage(_until(rows, stage), stage)
        return []

    def first_numbers(self) -> list[int]:
        """Return how many indices of each level the first stage runs."""
        n = int(min(self.first, math.ceil(0.5 * self.most) if math.isfinite(self.most) else self.first))
        return [n, max(n, FIRST_COARSE)]

    def next_numbers(self, rows: Rows, numbers: list[int]) -> None:
        """Numbers do not name what is chosen: see `next_stage`."""

    def first_stage(self) -> Stage:
        """Return the first indices on both cell sizes."""
        own, coarse = self.first_numbers()
        return Stage(coarse, np.arange(own), own)

    def next_stage(self, rows: Rows, stage: Stage) -> Stage | None:
        """Return the stage after the one that gave these rows; None if there is none.

        Coarse runs come before the choice from them.
        """
        own = stage.own.size
        if stage.wanted > own:
            return stage._replace(own=self._chosen(rows, stage))
        wanted = own
        if self.realisations is None:
            growth = self.growth(rows, own)
            if not growth:
                return None
            wanted = math.ceil(max(growth, LEAST_GROWTH * own))
        elif own < self.most:
            wanted = 4 * own
        wanted = int(min(wanted, self.most))
        coarse = max(stage.coarse, FOLDS * math.ceil(self._ratio(rows) * wanted / FOLDS))
        return None if (coarse, wanted) == (stage.coarse, own) else Stage(coarse, stage.own, wanted)

    def _ratio(self, rows: Rows) -> float:
        """Coarse runs for each run on the own cells with which a given variance costs least, by the rows so far [-]."""
        key = self.question, *(column.tobytes() for column in (rows.level, rows.index, rows.value, rows.work))
        if key not in self._ratios:
            self._ratios[key] = self._find_ratio(rows)
        return self._ratios[key]

    def _find_ratio(self, rows: Rows) -> float:
        functions = sharing_functions(self.question, rows.where((rows.level == 0) & (rows.index < self.first)))
        coarse, own = variances(self._phases(functions(rows), rows, functions))
        work = [float(np.nanmean(rows.work[rows.level == level])) for level in (0, 1)]
        cost = work[1] / work[0] if min(work) > 0.0 else 1.0
        ratio = math.sqrt(coarse / max(own * cost, 1e-9 * max(coarse, 1e-300)))
        # Whole powers of 2, as in `allocate`: numbers that follow variances closely dilute some outcomes only.
        return 2.0 ** round(math.log2(min(max(ratio, 1.0), LARGEST_RATIO)))

    def _chosen(self, rows: Rows, stage: Stage) -> np.ndarray:
        """Indices on the own cells with those that the strata get beside the present ones."""
        of = self.strata(rows)
        numbers = quotas(np.bincount(of[stage.own], minlength=of.max() + 1), np.bincount(of), stage.wanted)
        return np.sort(np.concatenate([np.flatnonzero(of == h)[:n] for h, n in enumerate(numbers)]))

    def strata(self, rows: Rows) -> np.ndarray:
        """Return the stratum of each coarse run, by edges between the first ones, shape (n,)."""
        value = _with_failed_above(rows.on_level(1))
        found = np.searchsorted(natural_breaks(value[:FIRST_COARSE]), value)
        return np.unique(found, return_inverse=True)[1]

    def _phases(self, outcome: np.ndarray, rows: Rows, functions: Functions) -> Phases:
        own, coarse = rows.on_level(0), rows.on_level(1)
        n = coarse.index.size
        placed, quantity = np.full((n, outcome.shape[1]), np.nan), np.full(n, np.nan)
        placed[own.index] = outcome[rows.level == 0]
        quantity[own.index] = np.where(own.is_censored & ~own.is_failed, np.inf, own.value)
        return Phases(
            outcome=placed,
            coarse_outcome=outcome[rows.level == 1],
            quantity=quantity,
            coarse_quantity=_with_failed_above(coarse),
            stratum=self.strata(rows),
            is_probability=functions.is_probability,
            limits=np.atleast_1d(functions.limits) if isinstance(functions, Exceedances) else None,
            normals=None if self.components is None else np.asarray(self.components(range(n)), float),
        )

    def used(self, rows: Rows) -> Rows:
        """Return the coarse rows without a gap before them, and of each stratum the own rows without a gap."""
        n = rows.numbers(2)[1]
        rows = rows.where((rows.level < 2) & (rows.index < n))
        if not np.any(rows.level == 0):
            return rows.where(rows.level < 0)
        of, held = self.strata(rows), np.isin(np.arange(n), rows.index[rows.level == 0])
        fair = np.zeros(n, bool)
        for stratum in np.unique(of):
            here = np.flatnonzero(of == stratum)
            fair[here[np.cumprod(held[here]).astype(bool)]] = True
        return rows.where((rows.level == 1) | fair[rows.index])

    def is_fair(self, used: Rows) -> np.ndarray:
        """Whether rows are on the own cells and a fair sample of all: none is, for the choice follows the strata."""
        return np.zeros(used.level.shape, bool)

    def contributions(self, outcome: np.ndarray, rows: Rows, functions: Functions) -> Contributions:
        """Return what every index of the coarse runs adds."""
        if not rows.value.size:
            return Contributions(np.zeros((0, outcome.shape[1])), np.zeros(0, int), np.zeros(outcome.shape[1]))
        return contributions(self._phases(outcome, rows, functions))

    def notes(self, rows: Rows, found: Estimate) -> list[str]:
        """Return what must be known to read an estimate, the number of coarse simulations first."""
        number = int(np.sum(self.used(rows).level == 1))
        return [*([f"with {number} on coarser cells no. 1"] if number else []), *super().notes(rows, found)]


def _with_failed_above(coarse: Rows) -> np.ndarray:
    """The quantity, infinite where it is censored or the simulation failed."""
    return np.where(coarse.is_censored | coarse.is_failed, np.inf, coarse.value)


def _until(rows: Rows, stage: Stage) -> Rows:
    """The rows of a stage and those before it."""
    coarse = (rows.level == 1) & (rows.index < stage.coarse)
    return rows.where(coarse | ((rows.level == 0) & np.isin(rows.index, stage.own)))


def _ranges(indices: np.ndarray) -> list[range]:
    """Ascending indices as ranges."""
    parts = np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1)
    return [range(int(part[0]), int(part[-1]) + 1) for part in parts if part.size]
