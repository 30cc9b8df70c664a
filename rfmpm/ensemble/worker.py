"""What one worker does, in whatever process or rank it lives, and how it is asked to stop."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from rfmpm.ensemble.folder import WORK
from rfmpm.ensemble.segments import Row, SegmentWriter
from rfmpm.variables import failed_row

SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGUSR1") if hasattr(signal, name)]


class Abandoned(BaseException):
    """Raised inside a realisation that is given up; a BaseException so that nobody takes it for a failure."""


class Stop:
    """Notices the signals that ask for a clean end."""

    def __init__(self):
        self.count = 0
        self._is_interruptible = False

    @property
    def is_requested(self) -> bool:
        return self.count > 0

    def __call__(self, *_) -> None:
        self.count += 1
        if self._is_interruptible:
            self._is_interruptible = False  # once: what follows is the writing of finished rows
            raise Abandoned

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Take the signals while the body runs; outside the main thread, which alone may, this does nothing."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        earlier = {number: signal.signal(number, self) for number in SIGNALS}
        try:
            yield
        finally:
            for number, handler in earlier.items():
                signal.signal(number, handler)

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Let a signal raise Abandoned in the body; at once if one came before."""
        try:
            self._is_interruptible = True
            if self.is_requested:
                raise Abandoned
            yield
        finally:
            self._is_interruptible = False


@dataclass(frozen=True)
class Report:
    """What a worker tells when it asks for the next realisation, and when it ends."""

    status: int | None = None  # of the realisation it has just finished
    segments: list[dict] = field(default_factory=list)  # written since its last report
    is_last: bool = False
    is_stopping: bool = False  # a signal asked for the end
    error: str = ""  # why the worker cannot go on


Claim = Callable[[Report], int | None]


class Worker:
    """The one worker loop; back ends differ in how `claim` reaches whoever hands out the realisations."""

    def __init__(self, study, directory: Path):
        self.study, self.directory = study, directory
        self.stop = Stop()
        self.prepared = None

    def __getstate__(self) -> dict:
        return {**self.__dict__, "prepared": None}  # another process prepares from the store

    def prepare(self) -> None:
        """Compile, build the scene and find or make the factor of the field; once per process.

        Raises:
            Abandoned: if a signal asked for the end.
        """
        from rfmpm import realisation

        if self.prepared is None:
            with self.stop.interruptible():
                self.prepared = realisation.prepare(self.study, store=self.directory / WORK)
                realisation.compile_kernels(self.prepared)

    def work(self, rank: int, claim: Claim) -> None:
        """Run what `claim` hands out until there is nothing left or a signal comes; every finished row is written.

        Args:
            rank: of this worker.
            claim: sends a report and returns the next realisation or None.
        """
        from threadpoolctl import threadpool_limits

        writer = SegmentWriter(self.directory, self.study, rank)
        error = ""
        try:
            # A signal abandons the realisation at hand to a later run; the last report says so.
            with suppress(Abandoned), self.stop.listening(), threadpool_limits(limits=1):
                self.prepare()
                self._loop(writer, claim)
        except Exception as failure:
            error = _described(failure)
        try:
            segments = writer.flush()
        except OSError as failure:
            segments, error = [], error or _described(failure)
        claim(Report(segments=segments, is_last=True, is_stopping=self.stop.is_requested, error=error))

    def _loop(self, writer: SegmentWriter, claim: Claim) -> None:
        report = Report()
        while (index := claim(report)) is not None:
            row = self._run(index)
            report = Report(status=int(row["status"]), segments=writer.add(row))

    def _run(self, index: int) -> Row:
        from rfmpm import realisation

        started = time.perf_counter()
        try:
            with self.stop.interruptible():
                return realisation.run(self.prepared, index)
        except Exception as failure:
            return failed_row(
                self.study, index, "crashed", _described(failure), wall_time=time.perf_counter() - started
            )


def _described(failure: Exception) -> str:
    return " ".join(f"{type(failure).__name__}: {failure}".split())
