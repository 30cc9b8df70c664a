"""A campaign in its folder: what its plan lacks is run, in rounds, until it lacks nothing or something ends it."""

import logging
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

from rfmpm import campaign_status, results
from rfmpm.ensemble import codes, folder, segments
from rfmpm.ensemble.board import Board
from rfmpm.ensemble.books import Books, CampaignFailed
from rfmpm.ensemble.course import FixedCourse, OpenCourse
from rfmpm.ensemble.dispatcher import Dispatcher, Todo
from rfmpm.ensemble.finished import NOTHING
from rfmpm.ensemble.markers import take_left_behind
from rfmpm.ensemble.progress import Progress
from rfmpm.ensemble.stop import Abandoned
from rfmpm.ensemble.worker import ISOLATED_FROM, Worker
from rfmpm.ensemble.xi import XiMaker
from rfmpm.variables import BY_CHANCE, FAILED_CODES, STATUS

log = logging.getLogger("rfmpm")


class Interrupted(RuntimeError):
    """A campaign that ended early; what is finished is on disk and the same command continues it."""


class TooShort(Interrupted):
    """A campaign whose wall time was over before one realisation was finished: the same command gets no further."""


class Campaign:
    """A campaign in a folder that is locked; rank 0 alone has one.

    Args:
        crew: who works.
        worker: of this process.
        journal: of the folder.
        course: along which the realisations to be had are found.
        allowed: share of failed realisations that is allowed.
        repeat_failed: whether what a crash or a time limit ended is run again.
        is_shown: whether progress and remarks are shown on standard error.

    Raises:
        FolderMismatch: if the rows in the folder are another study's or another version's.
    """

    def __init__(
        self,
        crew,
        worker: Worker,
        journal,
        course: FixedCourse | OpenCourse,
        allowed: float,
        repeat_failed: bool,
        is_shown: bool,
    ):
        self.crew, self.worker, self.journal = crew, worker, journal
        self.allowed, self.is_shown = allowed, is_shown
        self.study, self.directory = worker.study, worker.directory
        self.course, self.xi = course, XiMaker(worker)
        self.found, self.progress = NOTHING, Progress(0, 0, is_shown)
        self.done = 0  # by this run
        self.again = np.empty(0, dtype=np.int64)  # realisations that have a row and run once more
        self._look()
        if repeat_failed:
            places = self.found.at(self.position.planned())
            self.again = places["code"][np.isin(places["status"], list(BY_CHANCE))]
            self._look()
        self.desk = Dispatcher(self.todo, {}, self.books, journal, self.progress)

    def _look(self) -> None:
        """Find out what the folder holds, and what the plan lacks."""
        put_aside = len(self.journal.events("quarantine"))
        self.found = segments.finished(self.directory, self.study, self.journal, self.found)
        for event in self.journal.events("quarantine")[put_aside:]:
            where = f"{self.directory / folder.QUARANTINE}; its realisations run again"
            self._say(f"{event['segment']} is not valid and was moved to {where}")
        self.position = self.course.follow(self.found, self.again)
        self.todo = Todo(self.position.missing)
        places = self.found.at(self.position.planned())
        status, numbers = np.unique(places["status"][~np.isin(places["code"], self.again)], return_counts=True)
        counts = dict(zip(status.tolist(), numbers.tolist(), strict=True))
        policy = self.study.failures
        self.books = Books(self.total, counts, policy.action, self.allowed, self._examples(counts))
        self.outlook = self.course.outlook(self.position)
        self.progress.begin(self.total, self.books.before, self.outlook.expected)

    @property
    def total(self) -> int:
        """What is planned so far [-]."""
        return self.position.total

    def _counts(self) -> str:
        return f"{self.books.before} of {self.total} realisations" + self.course.so_far

    def _examples(self, counts: Mapping[int, int]) -> dict[int, tuple[int, str]]:
        if not FAILED_CODES.intersection(counts):
            return {}
        events = [(codes.of_entry(event), event) for event in self.journal.events("failed")]
        planned = [(code, event) for code, event in reversed(events) if code in self.position]
        return {STATUS[event["status"]]: (code, event["reason"]) for code, event in planned}

    def begin(self, fresh: bool) -> None:
        """Note the start.

        Args:
            fresh: whether results were discarded.
        """
        (self.directory / folder.RUNNING).mkdir(exist_ok=True)
        origin = {"physics_hash": self.study.physics_hash, "source_hash": results.source_hash(), **results.versions()}
        counts = {"realisations": self.total, "todo": len(self.todo), "workers": self.crew.size}
        self.journal.write("start", fresh=fresh, **counts, **origin)
        if folder.take_stop_file(self.directory):
            self._say(f"removed the file {folder.STOP_FILE}, which had asked an earlier run for its end")
        self.worker.stop.file = self.directory / folder.STOP_FILE
        if self.todo:
            lacking = f"{len(self.todo)} of {self.total} realisations{self.course.so_far} to run"
            self._say(f"{lacking}, {self.crew.in_words()}, one thread each")

    def _say(self, remark: str) -> None:
        log.info(remark)
        if self.is_shown:
            print(f"rfmpm: {remark}", file=sys.stderr, flush=True)

    @contextmanager
    def posted(self) -> Iterator[None]:
        """Keep status.json up to date while the body runs, and let it say in the end how that went."""
        board = Board(self.directory, self._state)
        self.worker.stop.on_look = self.renew = board.renew
        try:
            yield
        except BaseException as error:
            state = campaign_status.STOPPED if isinstance(error, Interrupted | OSError) else campaign_status.FAILED
            board.close(state, (str(error) or type(error).__name__).splitlines()[-1].strip())
            raise
        else:
            board.close(campaign_status.COMPLETE)
        finally:
            self.worker.stop.on_look = None

    def _state(self) -> dict[str, Any]:
        books, progress = self.books, self.progress
        return {
            "first": self.course.first,
            "total": self.total,
            "done": sum(books.counts.values()),
            "failed": books.failures(),
            "running": self.desk.running(),
            "rate_per_minute": progress.per_minute(books.done),
            "seconds_left": progress.seconds_left(books.done),
            "workers": self.crew.size,
            **self.outlook.as_entry(),
        }

    def carry_out(self) -> None:
        """Run what the plan lacks, plan after plan; returns when it lacks nothing.

        Raises:
            Interrupted: if something asked for the end, or workers died without getting anything done.
            CampaignFailed: if the failure policy does not let it go on.
        """
        idle = 0
        losses: list[str] = []
        while True:
            why = self.books.why_not()
            if why and (self.todo or self.books.action == "abort"):
                self.journal.write("stop", complete=False, missing=len(self.todo), reason=why)
                raise CampaignFailed(f"stopped with {self._counts()}: {why}")
            if not self.todo:
                return self._name_what_is_beyond()
            if idle == ISOLATED_FROM:
                self._interrupt("workers die and nothing gets done", losses)
            before, ran, stopped_by = self.found.count, self.position, self._round()
            losses += self.desk.losses
            self.done += self.books.done
            self.again = self.again[[code in self.desk.todo or code not in ran for code in self.again.tolist()]]
            self._look()
            if self.total > ran.total:
                self.journal.write("plan", realisations=self.total, todo=len(self.todo), **self.outlook.as_entry())
            idle = 0 if self.found.count > before else idle + 1
            if stopped_by and self.todo:
                self._interrupt(stopped_by, losses)

    def _name_what_is_beyond(self) -> None:
        if beyond := self.found.count - self.total:
            self._say(f"{beyond} more realisations in the folder than were asked for stay there, out of ensemble.nc")

    def _interrupt(self, reason: str, losses: list[str]) -> None:
        self.journal.write("stop", complete=False, missing=len(self.todo), reason=reason)
        lines = "".join(f"\n  {line}" for line in dict.fromkeys([*losses, reason]))
        counts = f"stopped early with {self._counts()}"
        if "--wall-time" in reason and not self.done:
            raise TooShort(
                f"{counts}; not one was finished by this run: give a longer --wall-time, in which making the scene and "
                f"compiling count too (rfmpm warmup compiles beforehand){lines}"
            )
        raise Interrupted(f"{counts}; run the same command again to continue{lines}")

    def _round(self) -> str:
        """Let the crew work on what is missing; returns what asked for the end, empty if nothing did."""
        from threadpoolctl import threadpool_limits

        self._note_unfinished()
        starts = self.journal.unfinished_starts()
        deadline = self.worker.stop.deadline
        longest = self.desk.longest
        self.desk = Dispatcher(self.todo, starts, self.books, self.journal, self.progress, deadline, self.xi)
        self.desk.longest = longest
        self.worker.needed = tuple(sorted({codes.split(part.start)[0] for part in self.position.missing}))
        try:
            with threadpool_limits(limits=1):
                self.worker.prepare(self.worker.needed)
                self.xi.prepare(self.position.rows)
        except Abandoned:
            return self.worker.stop.reason
        with self.progress:
            self.crew.lead(self.worker, self.desk, self.renew)
        return self.desk.stopped_by or self.worker.stop.reason

    def _note_unfinished(self) -> None:
        for marker in take_left_behind(self.directory):
            if codes.of_entry(marker) not in self.found.codes:
                self.journal.write("unfinished_start", **marker)
