"""Workers as processes of this machine. The parent hands out the work, shows progress and notices who died."""

import multiprocessing
import os
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection, wait

from rfmpm.ensemble.dispatcher import Dispatcher
from rfmpm.ensemble.isolation import cause
from rfmpm.ensemble.worker import Report, Worker

POLL = 0.2  # seconds between two looks at the signals


def available_processors() -> int:
    """Count the processors this process may use."""
    if hasattr(os, "process_cpu_count"):
        return os.process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Processes:
    """A crew of local processes.

    Args:
        workers: how many; as many as there are processors if None.

    Raises:
        ValueError: if less than one is asked for.
    """

    rank = 0

    def __init__(self, workers: int | None):
        if workers is not None and workers < 1:
            raise ValueError(f"workers = {workers}: at least 1 is needed")
        self.size = workers or available_processors()

    def in_words(self) -> str:
        """Say who works, and what is wrong with their number."""
        processors = available_processors()
        workers = f"{self.size} local process{'es' if self.size > 1 else ''}"
        if self.size > processors:
            return f"{workers} on {processors} processors (more than there are only slows them; leave out --workers)"
        return f"{workers} on {processors} processors"

    def lead(self, worker: Worker, dispatcher: Dispatcher, renew: Callable[[], None]) -> None:
        """Start the workers and serve them until the last one has ended; one that dies is replaced.

        Args:
            worker: prepared; forked processes share its memory.
            dispatcher: of the work.
            renew: called now and then, to keep the status up to date.
        """
        # fork shares what the parent has prepared; where it is missing the workers prepare from the store
        is_forking = "fork" in multiprocessing.get_all_start_methods()
        context = multiprocessing.get_context("fork" if is_forking else "spawn")
        members: dict[Connection, tuple[int, multiprocessing.Process]] = {}

        def engage(rank: int) -> None:
            here, there = context.Pipe()
            inherited = [*members, here] if is_forking else []
            # no daemon: those may have no children, and a realisation may need a process of its own
            process = context.Process(target=_live, args=(worker, rank, there, inherited))
            process.start()
            there.close()  # so that the end of the process ends the connection
            members[here] = (rank, process)

        try:
            for rank in range(min(self.size, len(dispatcher.todo))):
                engage(rank)
            self._serve(members, engage, worker, dispatcher, renew)
        finally:
            for connection, (_, process) in members.items():
                connection.close()
                process.kill()
                process.join()

    def close(self) -> None:
        """Nothing is left to be closed."""

    def _serve(self, members: dict, engage: Callable, worker: Worker, dispatcher: Dispatcher, renew: Callable) -> None:
        signals_passed_on, ended, next_rank = 0, set(), len(members)
        while members:
            renew()
            for connection in wait(list(members), timeout=POLL):
                rank, process = members[connection]
                try:
                    report = connection.recv()
                    if report.is_last:
                        ended.add(rank)
                    connection.send(dispatcher.answer(rank, report))
                except (EOFError, OSError):
                    del members[connection]
                    connection.close()
                    process.join()
                    if rank not in ended and dispatcher.lost(rank, cause(process.exitcode)):
                        engage(next_rank)  # another rank: the marker of the dead one is evidence
                        next_rank += 1
            if worker.stop.count > signals_passed_on:
                signals_passed_on = worker.stop.count
                dispatcher.stop(worker.stop.reason)
                for _, process in members.values():
                    if signals_passed_on == 1:
                        process.terminate()
                    else:
                        process.kill()


def _live(worker: Worker, rank: int, connection: Connection, inherited: list[Connection]) -> None:
    for other in inherited:  # copies of the parent's ends; with them open its death would go unnoticed
        other.close()
    worker.stop.on_look = None  # the parent's

    def claim(report: Report) -> int | None:
        with suppress(EOFError, OSError):  # the parent is gone: end
            connection.send(report)
            return connection.recv()
        return None

    worker.work(rank, claim)
