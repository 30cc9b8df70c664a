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
    ideal: float  # the least that any schedule could take [s]
    greedy: float  # what the same order would take if nothing but the realisations took time [s]
    between: float  # median time between two realisations of a worker [s]

    @property
    def over_ideal(self) -> float:
        """Share by which it took longer than ideal [-]."""
        return self.span / self.ideal - 1.0

    @property
    def over_greedy(self) -> float:
        """Share by which it took longer than if nothing but the realisations took time [-]."""
        return self.span / self.greedy - 1.0


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
    gaps = [np.diff(np.column_stack([began, ended])[worker == w].ravel())[1::2] for w in np.unique(worker)]
    return Loss(
        float(ended.max() - began.min()),
        ideal(seconds, workers),
        replay(seconds, workers).makespan,
        float(np.median(np.concatenate(gaps))),
    )


def service_seconds(claims: int) -> float:
    """Time that rank 0 takes for one claim while claims wait in line [s]."""
    with tempfile.TemporaryDirectory() as scratch:
        text = _run([str(launcher()), "-n", "2", sys.executable, "-m", STAND_IN, scratch, str(claims), "--flood"])
    return float(text)


def _run(command: list[str]) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
