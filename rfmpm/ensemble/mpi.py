"""Workers as MPI ranks. Every rank works; a thread of rank 0 hands out the work. Nobody spins: all waits sleep."""

import os
import threading
import time
from collections.abc import Callable, Iterator

from rfmpm.ensemble.dispatcher import Dispatcher
from rfmpm.ensemble.markers import Task
from rfmpm.ensemble.worker import Report, Worker

LONGEST_SLEEP = 0.001  # seconds; waiting so costs 2 % of a processor
_START, _CLAIM, _ANSWER = 1, 2, 3  # message tags


class LauncherMismatch(RuntimeError):
    """The launcher started several copies, but the MPI library does not see them as ranks of one job."""


def launched_ranks() -> int | None:
    """Count the ranks that a launcher says it started, without importing MPI.

    Returns:
        Their number, or None if this process was not started by a launcher. The copies that `srun` starts without a way
        to find each other count too.
    """
    for name in ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE"):
        if name in os.environ:
            return int(os.environ[name])
    tasks = int(os.environ.get("SLURM_STEP_NUM_TASKS", "1"))
    if "PMIX_RANK" in os.environ:
        return tasks
    is_step = "SLURM_STEP_ID" in os.environ and "SLURM_PROCID" in os.environ
    return tasks if is_step and tasks > 1 else None


def _remedy() -> str:
    if "SLURM_STEP_ID" in os.environ and not {"PMI_SIZE", "PMIX_RANK"}.intersection(os.environ):
        return (
            "srun gave the copies no way to find each other; start them with mpirun -n N instead of srun, or with the "
            "srun --mpi=... that fits your MPI (srun --mpi=list names them)"
        )
    return (
        "mpirun belongs to another MPI than mpi4py uses; install the matching one with pip install 'rfmpm[mpi]' and "
        "use its mpirun, which lies beside this Python"
    )


def pauses() -> Iterator[None]:
    """Sleep a little longer each time, so that a wait costs no processor."""
    pause = 0.0001
    while True:
        time.sleep(pause)
        yield
        pause = min(2.0 * pause, LONGEST_SLEEP)


def wait_until(is_done: Callable[[], bool]) -> None:
    """Look at once, then poll with sleeps, until something is so."""
    for _ in () if is_done() else pauses():
        if is_done():
            return


class Ranks:
    """A crew of MPI ranks.

    Raises:
        LauncherMismatch: if MPI is missing or sees another number of ranks than the launcher started.
    """

    def __init__(self):
        try:
            from mpi4py import MPI
        except (ImportError, RuntimeError) as error:
            raise LauncherMismatch(
                f"started by an MPI launcher, but no MPI library was found ({error}); install one with "
                "pip install 'rfmpm[mpi]' and use its mpirun"
            ) from error
        found, started = MPI.COMM_WORLD.Get_size(), launched_ranks()
        if started is not None and started > 1 and found != started:
            raise LauncherMismatch(
                f"the launcher started {started} ranks, but the MPI library sees {found}: {_remedy()}"
            )
        if MPI.Query_thread() < MPI.THREAD_SERIALIZED:
            raise LauncherMismatch("this MPI library does not let a second thread communicate, which rank 0 needs")
        self.mpi, self.comm = MPI, MPI.COMM_WORLD.Dup()
        self.rank, self.size = self.comm.Get_rank(), found
        here = self.comm.Split_type(MPI.COMM_TYPE_SHARED)
        self.size_here = here.Get_size()
        here.Free()

    def in_words(self) -> str:
        """Say who works, and what is wrong with their number."""
        processors, ranks = os.cpu_count() or 1, f"{self.size} MPI rank{'s' if self.size > 1 else ''}"
        if self.size_here > processors:
            return f"{ranks}, {self.size_here} of them on the {processors} processors of this host (too many slow it)"
        return ranks

    def follow(self, worker: Worker) -> None:
        """Work under rank 0, as often as it finds something to do; returns when rank 0 has closed the crew.

        Args:
            worker: of this rank.
        """
        from rfmpm import realisation  # noqa: F401  (takes a second, in which rank 0 looks at the folder)

        while needed := self._receive(0, _START):
            worker.needed = needed
            worker.work(self.rank, self._claim)
        self._part()

    def lead(self, worker: Worker, dispatcher: Dispatcher, renew: Callable[[], None]) -> None:
        """Let all ranks work, this one too, and serve them until the last one has ended.

        Args:
            worker: of this rank, prepared.
            dispatcher: of the work.
            renew: called now and then, to keep the status up to date.
        """
        self._start(worker.needed)
        desk = threading.Thread(target=self._serve, args=(dispatcher, renew), name="dispatcher")
        desk.start()
        try:
            worker.work(0, lambda report: dispatcher.answer(0, report))
        except BaseException:
            dispatcher.stop("rank 0 could not go on")
            raise
        finally:
            desk.join()

    def close(self) -> None:
        """Let the other ranks go; to be called by rank 0 in any case."""
        self._start(())
        self._part()

    def _part(self) -> None:
        self._meet()
        self.comm.Free()  # MPI has room for some thousand of them only, and a sweep opens one for each cell

    def _start(self, needed: tuple[int, ...]) -> None:
        """Let the other ranks work on these levels, or end where there is none."""
        for rank in range(1, self.size):
            self._send(needed, rank, _START)

    def _serve(self, dispatcher: Dispatcher, renew: Callable[[], None]) -> None:
        # While this runs no other thread of rank 0 calls MPI.
        try:
            working = self.size - 1
            while working:
                rank, report = self._receive_from_any(_CLAIM, renew)
                answer = dispatcher.answer(rank, report)
                if report.is_last:
                    working -= 1
                else:
                    self._send(answer, rank, _ANSWER)
        except BaseException:
            self.comm.Abort(1)
            raise

    def _claim(self, report: Report) -> Task | None:
        self._send(report, 0, _CLAIM)
        return None if report.is_last else self._receive(0, _ANSWER)

    def _send(self, message, rank: int, tag: int) -> None:
        request = self.comm.isend(message, rank, tag)
        wait_until(lambda: request.test()[0])

    def _receive(self, rank: int, tag: int):
        wait_until(lambda: self.comm.iprobe(rank, tag))
        return self.comm.recv(source=rank, tag=tag)

    def _receive_from_any(self, tag: int, meanwhile: Callable[[], None]):
        status = self.mpi.Status()

        def has_come() -> bool:
            meanwhile()
            return self.comm.iprobe(self.mpi.ANY_SOURCE, tag, status)

        wait_until(has_come)
        return status.Get_source(), self.comm.recv(source=status.Get_source(), tag=tag)

    def _meet(self) -> None:
        request = self.comm.Ibarrier()
        wait_until(request.Test)
