"""Runs cases in a process of their own, so that a crash or a run without end is a verdict and not the end."""

import multiprocessing
from contextlib import suppress
from multiprocessing.connection import Connection

import psutil

from rfmpm.benchmark.stability.case import Case
from rfmpm.benchmark.stability.verdict import FAIL, Verdict, judge

LOOK_INTERVAL = 0.5  # [s] from one look at a process to the next


class Guard:
    """A process that judges one case after another; a new one takes its place when it dies.

    Patience is processor time, which does not pass while others keep the machine busy.
    """

    def __init__(self, patience: float):
        self.patience = patience  # [s] of processor time for one case, compiling included
        self.process = self.line = None

    def judge(self, case: Case) -> Verdict:
        """Judge a case.

        Args:
            case: what is run.

        Returns:
            Its verdict; FAIL where the process died, computed for longer than the patience or raised an error.
        """
        if self.process is None:
            context = multiprocessing.get_context("spawn")
            self.line, end = context.Pipe()
            self.process = context.Process(target=serve, args=(end,), daemon=True)
            self.process.start()
            end.close()  # so that the end of the process ends the connection
        self.line.send(case)
        last = self._spent() + self.patience
        try:
            while self._spent() < last:
                if self.line.poll(LOOK_INTERVAL):
                    return self.line.recv()
            words = f"no end after {self.patience:g} s of computing"
        except EOFError:
            self.process.join()
            words = f"the process died with exit code {self.process.exitcode}"
        self.close()
        return Verdict(FAIL, words)

    def _spent(self) -> float:
        """Processor time of the process so far [s]."""
        times = psutil.Process(self.process.pid).cpu_times()
        return times.user + times.system

    def close(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.line.close()
        self.process = self.line = None


def serve(line: Connection) -> None:
    """Judge what comes in until nothing more does."""
    with suppress(EOFError, BrokenPipeError):
        while True:
            case = line.recv()
            try:
                verdict = judge(case)
            except Exception as error:
                verdict = Verdict(FAIL, f"{type(error).__name__}: {error}")
            line.send(verdict)
