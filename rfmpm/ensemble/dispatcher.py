"""Hands out realisations to workers and keeps the books: who runs what, what is finished, who was lost."""

import threading
from collections import deque
from collections.abc import Iterable

from rfmpm.ensemble.worker import Report
from rfmpm.variables import FAILED, STATUS

_FAILED_CODES = frozenset(STATUS[name] for name in FAILED)


class Dispatcher:
    """The one desk where every worker of a run claims; safe to use from several threads.

    Args:
        todo: the realisations to run, in order.
        journal: where segments and losses are noted.
        progress: the display.
    """

    def __init__(self, todo: Iterable[int], journal, progress):
        self.todo = deque(todo)
        self.journal, self.progress = journal, progress
        self.held: dict[int, int] = {}
        self.done = self.failed = 0
        self.losses: list[str] = []
        self.is_stopped = False
        self._lock = threading.Lock()

    def answer(self, rank: int, report: Report) -> int | None:
        """Take the report of a worker and name its next realisation.

        Args:
            rank: of the worker.
            report: what it did since the last one.

        Returns:
            The next realisation, or None if it should end.
        """
        with self._lock:
            self.held.pop(rank, None)
            for segment in report.segments:
                self.journal.write("segment", rank=rank, **segment)
            if report.status is not None:
                self.done += 1
                self.failed += report.status in _FAILED_CODES
            if report.error:
                self.losses.append(f"worker {rank} could not go on: {report.error}")
                self.journal.write("worker_error", rank=rank, reason=report.error)
            self.is_stopped |= report.is_stopping or bool(report.error)
            self.progress.show(self.done, self.failed)
            if report.is_last or self.is_stopped or not self.todo:
                return None
            self.held[rank] = self.todo.popleft()
            return self.held[rank]

    def stop(self) -> None:
        """Hand out nothing more."""
        self.is_stopped = True

    def lost(self, rank: int, reason: str) -> None:
        """Note a worker that died without a word; the others go on.

        Args:
            rank: of the worker.
            reason: what is known of its end.
        """
        with self._lock:
            index = self.held.pop(rank, None)
            at = "" if index is None else f" in realisation {index}"
            self.losses.append(f"worker {rank} died{at}: {reason}")
            self.journal.write("worker_lost", rank=rank, realisation=index, reason=reason)
