"""Hands out realisations to workers and keeps the books: who runs what, what is finished, who was lost."""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from rfmpm.ensemble import codes
from rfmpm.ensemble.books import Books
from rfmpm.ensemble.markers import Task
from rfmpm.ensemble.worker import Report
from rfmpm.variables import FAILED_CODES, STATUS_NAMES


class Todo:
    """Codes of what is still to be run, held as ranges.

    Args:
        ranges: of codes, in order.
    """

    def __init__(self, ranges: Iterable[range]):
        self.ranges = deque(ranges)

    def __len__(self) -> int:
        return sum(map(len, self.ranges))

    def __bool__(self) -> bool:
        return bool(self.ranges)

    def __contains__(self, code: int) -> bool:
        return any(code in part for part in self.ranges)

    def take(self) -> int:
        """Take the next code out."""
        first = self.ranges.popleft()
        if len(first) > 1:
            self.ranges.appendleft(first[1:])
        return first[0]


@dataclass(frozen=True)
class Held:
    """What a worker has at hand."""

    task: Task
    since: float  # time.monotonic [s]


class Dispatcher:
    """The one desk where every worker of a run claims; safe to use from several threads.

    Args:
        todo: the realisations to run.
        starts: starts of realisations that came to no end, by code.
        books: of the campaign.
        journal: where segments, failures and losses are noted.
        progress: the display.
        deadline: nothing is handed out that would last beyond it, if it took as long as the longest so far; on the
            clock of time.monotonic [s].
        xi_of: makes the random vector of a code, shape (n_variables,) [-]; None where each is drawn from its stream.
    """

    def __init__(
        self,
        todo: Todo,
        starts: Mapping[int, int],
        books: Books,
        journal,
        progress,
        deadline: float = inf,
        xi_of: Callable[[int], np.ndarray | None] = lambda code: None,
    ):
        self.todo, self.starts, self.books, self.xi_of = todo, starts, books, xi_of
        self.journal, self.progress, self.deadline = journal, progress, deadline
        self.held: dict[int, Held] = {}
        self.hosts: dict[int, str] = {}
        self.losses: list[str] = []
        self.longest = 0.0
        self.stopped_by = ""
        self.verdict = ""  # of the failure policy
        self._lock = threading.Lock()

    @property
    def is_stopped(self) -> bool:
        return bool(self.stopped_by or self.verdict)

    def answer(self, rank: int, report: Report) -> Task | None:
        """Take the report of a worker and name its next realisation.

        Args:
            rank: of the worker.
            report: what it did since the last one.

        Returns:
            The next task, or None if it should end.
        """
        with self._lock:
            self.held.pop(rank, None)
            self._note(rank, report)
            self.progress.show(self.books.done, self.books.failed)
            if report.is_last or not self.todo or self._is_to_end():
                return None
            code = self.todo.take()
            self.held[rank] = Held(Task(code, 1 + self.starts.get(code, 0), self.xi_of(code)), time.monotonic())
            return self.held[rank].task

    def _note(self, rank: int, report: Report) -> None:
        if report.host:
            self.hosts[rank] = report.host
        for segment in report.segments:
            self._write("segment", rank=rank, **segment)
        if (ended := report.ended) is not None:
            self.books.enter(ended)
            self.longest = max(self.longest, ended.wall_time)
            if ended.status in FAILED_CODES:
                status, which = STATUS_NAMES[ended.status], codes.as_entry(ended.code)
                self._write("failed", rank=rank, **which, status=status, reason=ended.reason)
        if report.error:
            self.losses.append(f"worker {rank} could not go on: {report.error}")
            self._write("worker_error", rank=rank, reason=report.error)
            self.stop(self.losses[-1])
        if report.stopping:
            self.stop(report.stopping)

    def _write(self, event: str, **details: Any) -> None:
        try:
            self.journal.write(event, **details)
        except OSError as error:  # the workers are to end and to write what they have, not to be cut off
            self.stop(f"the journal cannot be written: {error}")

    def _is_to_end(self) -> bool:
        self.verdict = self.verdict or self.books.why_not()
        if time.monotonic() + self.longest >= self.deadline:
            self.stop(
                f"what is left of --wall-time is shorter than the longest realisation so far, {self.longest:.3g} s"
                if self.longest
                else "the limit of --wall-time was reached before a realisation was finished; it is too short"
            )
        return self.is_stopped

    def stop(self, reason: str) -> None:
        """Hand out nothing more.

        Args:
            reason: what asks for it; the first one counts.
        """
        self.stopped_by = self.stopped_by or reason

    def lost(self, rank: int, reason: str) -> bool:
        """Note a worker that died without a word; the others go on.

        Args:
            rank: of the worker.
            reason: what is known of its end.

        Returns:
            Whether another worker may take its place: it died over a realisation, and there is more to do.
        """
        with self._lock:
            held = self.held.pop(rank, None)
            code = None if held is None else held.task.code
            at = "" if code is None else f" in {codes.in_words(code)}"
            self.losses.append(f"worker {rank} died{at}: {reason}")
            self._write("worker_lost", rank=rank, **codes.as_entry(code), reason=reason)
            return held is not None and bool(self.todo) and not self.is_stopped

    def running(self) -> list[dict[str, Any]]:
        """List what the workers have at hand, for status.json."""
        clock = time.monotonic()
        return [
            {
                "rank": rank,
                "host": self.hosts.get(rank, ""),
                **codes.as_entry(held.task.code),
                "attempt": held.task.attempt,
                "seconds": round(clock - held.since, 1),
            }
            for rank, held in sorted(self.held.items())
        ]
