"""Workers as processes of this machine. The parent hands out the work, shows progress and notices who died."""

import multiprocessing
import os
import signal
from contextlib import suppress
from multiprocessing.connection import Connection, wait

from rfmpm.ensemble.dispatcher import Dispatcher
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

    def lead(self, worker: Worker, dispatcher: Dispatcher) -> None:
        """Start the workers and serve them until the last one has ended.

        Args:
            worker: prepared; forked processes share its memory.
            dispatcher: of the work.
        """
        # fork shares what the parent has prepared; where it is missing the workers prepare from the store
        is_forking = "fork" in multiprocessing.get_all_start_methods()
        context = multiprocessing.get_context("fork" if is_forking else "spawn")
        members: dict[Connection, tuple[int, multiprocessing.Process]] = {}
        try:
            for rank in range(min(self.size, len(dispatcher.todo))):
                here, there = context.Pipe()
                inherited = [*members, here] if is_forking else []
                process = context.Process(target=_live, args=(worker, rank, there, inherited), daemon=True)
                process.start()
                there.close()  # so that the end of the process ends the connection
                members[here] = (rank, process)
            self._serve(members, worker, dispatcher)
        finally:
            for connection, (_, process) in members.items():
                connection.close()
                process.kill()
                process.join()

    def close(self) -> None:
        """Nothing is left to be closed."""

    def _serve(self, members: dict, worker: Worker, dispatcher: Dispatcher) -> None:
        signals_passed_on, ended = 0, set()
        while members:
            for connection in wait(list(members), timeout=POLL):
                rank, process = members[connection]
                try:
                    report = connection.recv()
                    ended.add(rank) if report.is_last else None
                    connection.send(dispatcher.answer(rank, report))
                except (EOFError, OSError):
                    del members[connection]
                    connection.close()
                    process.join()
                    if rank not in ended:
                        dispatcher.lost(rank, _cause(process.exitcode))
            if worker.stop.count > signals_passed_on:
                signals_passed_on = worker.stop.count
                dispatcher.stop()
                for _, process in members.values():
                    process.terminate() if signals_passed_on == 1 else process.kill()


def _live(worker: Worker, rank: int, connection: Connection, inherited: list[Connection]) -> None:
    for other in inherited:  # copies of the parent's ends; with them open its death would go unnoticed
        other.close()

    def claim(report: Report) -> int | None:
        with suppress(EOFError, OSError):  # the parent is gone: end
            connection.send(report)
            return connection.recv()
        return None

    worker.work(rank, claim)


def _cause(exit_code: int | None) -> str:
    if exit_code is not None and exit_code < 0:
        with suppress(ValueError):
            return f"killed by {signal.Signals(-exit_code).name}"
    return f"exit code {exit_code}"
