"""How far the plan of a campaign has come, found by following it from its beginning along what is finished."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, inf, isfinite
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import planning
from rfmpm.ensemble import codes, segments
from rfmpm.ensemble.finished import Finished
from rfmpm.estimators.monte_carlo import Estimate
from rfmpm.estimators.rows import Rows


@dataclass(frozen=True)
class Position:
    """Where a campaign stands.

    Attributes:
        done: codes of all plans that are finished as a whole, sorted; an estimate may rest on these alone.
        present: codes of the plan at hand, as ranges; empty if the campaign is at its end.
        missing: what that plan still lacks, as ranges.
        rows: those of `done`, as the estimator sees them; None where a fixed range was asked for.
    """

    done: np.ndarray
    present: tuple[range, ...]
    missing: tuple[range, ...]
    rows: Rows | None

    @property
    def total(self) -> int:
        """What is planned up to here [-]."""
        return len(self.done) + sum(map(len, self.present))

    def __contains__(self, code: int) -> bool:
        at = np.searchsorted(self.done, code)
        return (at < len(self.done) and self.done[at] == code) or any(code in part for part in self.present)

    def planned(self) -> np.ndarray:
        """Codes of all that is planned up to here, sorted."""
        return np.sort(np.concatenate([self.done, *(np.arange(part.start, part.stop) for part in self.present)]))


@dataclass(frozen=True)
class Outlook:
    """What is known of the answer, and how many realisations it may take in all."""

    question: str = ""
    estimate: Estimate | None = None
    expected: int | None = None

    def as_entry(self) -> dict[str, Any]:
        """What status.json says of it; numbers that are not finite are None, which JSON has."""
        if not self.question:
            return {}
        return {"question": self.question, "estimate": _plain(self.estimate), "expected": self.expected}


class FixedCourse:
    """A range of realisations on the study's own cells, which is asked for as a whole.

    Args:
        asked: their indices.
    """

    so_far = ""

    def __init__(self, asked: range):
        self.asked, self.first = asked, asked.start

    def outlook(self, position: Position) -> Outlook:
        """Nothing is asked but the realisations themselves."""
        return Outlook()

    def follow(self, found: Finished, again: np.ndarray) -> Position:
        """Say what is missing; arguments and result as for `OpenCourse`."""
        have = found.codes[~np.isin(found.codes, again)]
        missing = tuple(gaps(self.asked, have))
        if missing:
            return Position(np.empty(0, np.int64), (self.asked,), missing, None)
        return Position(np.arange(self.asked.start, self.asked.stop), (), (), None)


class OpenCourse:
    """What an estimator plans, one plan after the other.

    Each plan is made from the rows of all plans before it, every one of them finished, however many rows of its own or
    of an earlier campaign with another aim lie in the folder: so a campaign that was stopped, in whatever place and
    however often, makes the same plans as one that was not, on any number of processes.

    Args:
        study: the study.
        estimator: that plans.
    """

    first = 0
    so_far = " planned so far"

    def __init__(self, study, estimator):
        self.study, self.estimator = study, estimator
        self.points = planning.point_counts(study)

    def outlook(self, position: Position) -> Outlook:
        """Estimate from the plans that are finished, and expect an interval that shrinks with the root of the number.

        Args:
            position: where the campaign stands.

        Returns:
            The outlook.
        """
        question, n = planning.question_of(self.study), len(position.done)
        words = planning.in_words(question)
        if not n:
            return Outlook(words)
        found = self.estimator.estimate(position.rows)
        excess = question.excess(found) if question.is_open_ended and position.present else inf
        expected = max(position.total, ceil(n * excess**2)) if isfinite(excess) else None
        if expected is not None and question.at_most is not None and len(self.points) == 1:
            expected = min(expected, question.at_most)
        return Outlook(words, found, expected)

    def follow(self, found: Finished, again: np.ndarray) -> Position:
        """Follow the plans up to the first one that is not finished.

        Args:
            found: what is finished.
            again: codes of what counts as if it were not, sorted.

        Returns:
            Where the campaign stands.
        """
        have = found.codes[~np.isin(found.codes, again)]
        done = np.empty(0, np.int64)
        while True:
            rows = self._rows(found, done)
            present = tuple(codes.codes_of(level, indices) for level, indices in self.estimator.plan(rows))
            present = tuple(part for whole in present for part in gaps(whole, done))
            missing = tuple(part for whole in present for part in gaps(whole, have))
            if missing or not present:
                return Position(done, present, missing, rows)
            done = Position(done, present, (), None).planned()

    def _rows(self, found: Finished, done: np.ndarray) -> Rows:
        return _as_rows(found.at(done), self.points)


def _as_rows(places: np.ndarray, points: np.ndarray) -> Rows:
    level, index = np.divmod(places["code"], codes.LEVEL)
    outcome = places["value"], places["is_censored"], places["step_count"]
    return planning.as_rows(level, index, *outcome, points)


def rows_on_record(directory: Path, study) -> Rows:
    """Read what a folder holds of a campaign, complete or not, as estimators see it; changes nothing.

    Args:
        directory: of the campaign.
        study: of the campaign.

    Returns:
        The rows.

    Raises:
        FolderMismatch: if the rows were made by another study or another version of the sources.
        RowsDiffer: if two rows of one realisation are not the same.
    """
    found = segments.finished(directory, study, None)
    return _as_rows(found.at(found.codes), planning.point_counts(study))


def _plain(found: Estimate | None) -> dict[str, float | None] | None:
    if found is None:
        return None
    numbers = {name: float(getattr(found, name)) for name in ("value", "lower", "upper", "confidence")}
    return {name: number if isfinite(number) else None for name, number in numbers.items()} | {"n": int(found.n)}


def gaps(wanted: range, have: np.ndarray) -> Iterator[range]:
    """What of a range is missing.

    Args:
        wanted: codes.
        have: codes, sorted, shape (n,).

    Yields:
        The missing codes, in ascending order, as ranges.
    """
    inside = have[np.searchsorted(have, wanted.start) : np.searchsorted(have, wanted.stop)]
    edges = np.concatenate([[wanted.start - 1], inside, [wanted.stop]])
    for before in np.flatnonzero(np.diff(edges) > 1):
        yield range(int(edges[before]) + 1, int(edges[before + 1]))
