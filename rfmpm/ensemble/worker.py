"""What one worker does, in whatever process or rank it lives."""

import logging
import platform
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rfmpm import planning
from rfmpm.ensemble import codes
from rfmpm.ensemble.folder import LOGS, WORK
from rfmpm.ensemble.isolation import ChildDied, run_apart
from rfmpm.ensemble.markers import Marker, Task
from rfmpm.ensemble.segments import Row, SegmentWriter
from rfmpm.ensemble.stop import Abandoned, Stop
from rfmpm.variables import BY_CHANCE, STATUS_NAMES, failed_row

ISOLATED_FROM = 3  # the start from which a realisation gets a process of its own

log = logging.getLogger("rfmpm.worker")


@dataclass(frozen=True)
class Ended:
    """How a realisation ended."""

    code: int
    status: int
    reason: str
    wall_time: float  # [s], of all its repetitions


@dataclass(frozen=True)
class Report:
    """What a worker tells when it asks for the next realisation, and when it ends."""

    ended: Ended | None = None  # the realisation it has just finished
    segments: list[dict] = field(default_factory=list)  # written since its last report
    host: str = ""  # told once
    is_last: bool = False
    stopping: str = ""  # what asked for the end
    error: str = ""  # why the worker cannot go on


Claim = Callable[[Report], Task | None]


class Worker:
    """The one worker loop; back ends differ in how `claim` reaches whoever hands out the realisations.

    Args:
        study: the study.
        directory: of the campaign.
        stop: what asks for the end; signals alone if None.
        log_level: of logs/rank-<rank>.log.
    """

    def __init__(self, study, directory: Path, stop: Stop | None = None, log_level: str = "warning"):
        self.study, self.directory = study, directory
        self.stop, self.log_level = stop or Stop(), log_level
        self.studies = planning.studies_by_level(study)
        self.needed: tuple[int, ...] = (0,)  # levels that the work to come is on
        self.prepared: dict[int, Any] = {}  # by level

    def __getstate__(self) -> dict:
        return {**self.__dict__, "prepared": {}}  # another process prepares from the store

    def prepare(self, levels: Sequence[int]) -> None:
        """Compile, build the scene and find or make the factor of the field; once per process and level.

        Args:
            levels: what is to be prepared; 0 for the study's own cells.

        Raises:
            Abandoned: if something asked for the end.
        """
        from rfmpm import realisation

        for level in (level for level in levels if level not in self.prepared):
            # Between these steps only: an exception that a signal raises amid compiling leaves half-made kernels.
            self.stop.abandon_if_requested()
            prepared = realisation.prepare(self.studies[level], store=self.directory / WORK)
            self.stop.abandon_if_requested()
            realisation.compile_kernels(prepared)
            self.stop.abandon_if_requested()
            self.prepared[level] = prepared

    def work(self, rank: int, claim: Claim) -> None:
        """Run what `claim` hands out until nothing is left or something asks for the end; finished rows are written.

        Args:
            rank: of this worker.
            claim: sends a report and returns the next task or None.
        """
        from threadpoolctl import threadpool_limits

        writer, marker = SegmentWriter(self.directory, self.study, rank), Marker(self.directory, rank)
        with self.stop.listening(), threadpool_limits(limits=1), self._log_of(rank):
            error, segments = "", []
            try:
                # Asked to end, it abandons the realisation at hand to a later run; the last report says so.
                with suppress(Abandoned):
                    self.prepare(self.needed)
                    self._loop(writer, marker, claim)
            except Exception as failure:
                error = described(failure)
            try:
                segments = writer.flush()
            except Exception as failure:
                error = error or described(failure)
            with suppress(OSError):  # the last report has to go out; a marker that stays counts as one start too many
                marker.remove()
            claim(Report(segments=segments, is_last=True, stopping=self.stop.reason, error=error))

    def _loop(self, writer: SegmentWriter, marker: Marker, claim: Claim) -> None:
        report = Report(host=platform.node())
        while (task := claim(report)) is not None:
            started = time.perf_counter()
            marker.put(task)
            row = {**self._run(task), "attempt": task.attempt}
            ended = Ended(task.code, int(row["status"]), str(row["status_reason"]), _since(started))
            name = STATUS_NAMES[ended.status]
            log.info("%s: %s in %.3g s %s", codes.in_words(task.code), name, ended.wall_time, ended.reason)
            report = Report(ended, writer.add(row))

    def _run(self, task: Task) -> Row:
        if task.attempt < ISOLATED_FROM:
            return self.run_here(task)
        log.warning("%s: start %d, in a process of its own", codes.in_words(task.code), task.attempt)
        started = time.perf_counter()
        try:
            with self.stop.interruptible():
                return run_apart(self.study, self.directory, task)
        except ChildDied as death:
            reason = f"its process ended in each of {task.attempt} starts, the last one alone in a process: {death}"
            return self._crashed(task, reason, started)

    def _crashed(self, task: Task, reason: str, started: float) -> Row:
        return failed_row(self.study, task.realisation, "crashed", reason, task.level, _since(started))

    def run_here(self, task: Task) -> Row:
        """Run a realisation in this process, repeated where the study asks for it and it may end otherwise.

        Args:
            task: the realisation.

        Returns:
            Its row.

        Raises:
            Abandoned: if something asked for the end.
        """
        policy = self.study.failures
        times = 1 + (policy.retries if policy.action == "retry" else 0)
        for repetition in range(1, times + 1):
            row = self._attempt(task)
            if row["status"] not in BY_CHANCE:
                return row
            which = codes.in_words(task.code)
            log.warning("%s, try %d of %d: %s", which, repetition, times, row["status_reason"])
        return row if times == 1 else {**row, "status_reason": f"{row['status_reason']}; tried {times} times"}

    def _attempt(self, task: Task) -> Row:
        from rfmpm import realisation

        started, prepared = time.perf_counter(), self.prepared[task.level]
        options = planning.run_options(prepared, task.level, task.realisation, task.xi)
        try:
            row = realisation.run(prepared, task.realisation, watch=self.stop.abandon_if_requested, **options)
            return row if task.level == 0 else planning.with_own_bins(row, self.study)
        except Exception as failure:
            return self._crashed(task, described(failure), started)

    @contextmanager
    def _log_of(self, rank: int) -> Iterator[None]:
        handler = LateFile(self.directory / LOGS / f"rank-{rank:05d}.log", encoding="utf-8", delay=True)
        handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
        earlier = log.level, log.propagate
        log.setLevel(self.log_level.upper())
        log.propagate = False
        log.addHandler(handler)
        try:
            yield
        finally:
            log.removeHandler(handler)
            log.setLevel(earlier[0])
            log.propagate = earlier[1]
            handler.close()


class LateFile(logging.FileHandler):
    """A log file that appears, with its folder, when there is something to say."""

    def _open(self):
        Path(self.baseFilename).parent.mkdir(exist_ok=True)
        return super()._open()


def _since(started: float) -> float:
    return time.perf_counter() - started


def described(failure: Exception) -> str:
    """Say in one line what a realisation or a worker raised."""
    return " ".join(f"{type(failure).__name__}: {failure}".split())
