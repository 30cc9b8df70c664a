"""Campaigns whose realisations sleep: what ranks and local processes lose between two realisations."""

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.scheduling.replay import ideal, replay

STAND_IN = "rfmpm.benchmark.scheduling.stand_in"
CREWS = ("ranks", "processes")


class Loss(NamedTuple):
    """What a campaign of given times took."""

    span: float  # from the first start of a realisation to the last end [s]
    late: float  # how much later than the first worker the others started, mean over all [s]
    ideal: float  # the least that any schedule could take [s]
    greedy: float  # what handing out in order takes if nothing but the realisations takes time [s]
    between: float  # median time between two realisations of a worker [s]
    lost: float  # time between realisations over time in them, of all workers [-]

    @property
    def over_ideal(self) -> float:
        """Share by which it took longer than ideal for workers that start so late [-]."""
        return self.span / (self.ideal + self.late) - 1.0


def launcher() -> Path | None:
    """The mpirun that lies beside this Python, or None."""
    path = Path(sys.executable).with_name("mpirun")
    return path if path.exists() else None


def measure(seconds: np.ndarray, workers: int, crew: str) -> Loss:
    """Run a campaign whose realisations sleep.

    Args:
        seconds: of each realisation, shape (n,) [s].
        workers: that share them.
        crew: "ranks" of mpirun, or local "processes".

    Returns:
        What it took.
    """
    with tempfile.TemporaryDirectory() as scratch:
        given = Path(scratch) / "seconds.npy"
        np.save(given, seconds)
        stand_in = [sys.executable, "-m", STAND_IN, scratch, str(given)]
        under_mpi = [str(launcher()), "-n", str(workers), *stand_in]
        _run(under_mpi if crew == "ranks" else [*stand_in, "--workers", str(workers)])
        began, ended, worker = np.load(Path(scratch) / "spans.npy").T
    own = [(began[worker == w], ended[worker == w]) for w in np.unique(worker)]
    gaps = np.concatenate([np.sort(start)[1:] - np.sort(end)[:-1] for start, end in own])
    starts = [start.min() for start, _ in own]
    return Loss(
        float(ended.max() - began.min()),
        float(np.mean(starts) - min(starts)),
        ideal(seconds, workers),
        replay(seconds, workers).makespan,
        float(np.median(gaps)),
        float(gaps.sum() / seconds.sum()),
    )


def service_seconds(claims: int) -> float:
    """Time that rank 0 takes for one claim while claims wait in line [s]."""
    with tempfile.TemporaryDirectory() as scratch:
        text = _run([str(launcher()), "-n", "2", sys.executable, "-m", STAND_IN, scratch, str(claims), "--flood"])
    return float(text)


def _run(command: list[str]) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
