"""What `rfmpm estimate` says of a campaign, beside what the campaign then takes."""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rfmpm import cost, results

PROGRAM = "import sys; from rfmpm.cli import main; main()"


class Found(NamedTuple):
    """Predicted and measured, of one study."""

    predicted: dict[str, int | float]
    seconds: np.ndarray  # of each realisation on a busy machine, shape (n,) [s]
    elapsed: float  # of the whole command [s]
    processor: float  # time of all its processes [s]
    disk: int  # [bytes]
    load: float  # mean number of processes that wanted a processor, before and after


def compare(study) -> Found:
    """Estimate a campaign, then run it with its report as the command does.

    Args:
        study: the study.

    Returns:
        Both.
    """
    predicted = cost.estimate(study)
    with tempfile.TemporaryDirectory() as scratch:
        file, folder = Path(scratch) / "study.toml", Path(scratch) / "campaign"
        file.write_text(study.to_toml(), encoding="utf-8")
        load, before, started = os.getloadavg()[0], _children(), time.perf_counter()
        command = [sys.executable, "-c", PROGRAM, "run", str(file), "--out", str(folder)]
        subprocess.run(command, check=True, capture_output=True)
        elapsed, processor = time.perf_counter() - started, _children() - before
        rows = results.open_ensemble(folder)
        disk = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    return Found(predicted, rows["wall_time"].values, elapsed, processor, disk, 0.5 * (load + os.getloadavg()[0]))


def _children() -> float:
    used: Any = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def row(name: str, found: Found) -> str:
    """One row of the table: predicted / measured."""
    p, count = found.predicted, len(found.seconds)
    work = p["work_s"] + p["report_s"] + p["preparation_s"] + (p["workers"] - 1) * p["worker_start_s"]
    return (
        f"| {name} | {p['trial_realisations']} at {p['trial_cell_m']:g} m | {p['realisation_s']:.3g} "
        f"({p['realisation_shortest_s']:.3g} to {p['realisation_longest_s']:.3g}) | {np.median(found.seconds):.3g} "
        f"({found.seconds.min():.3g} to {found.seconds.max():.3g}) | {work:.3g} | {found.processor:.3g} "
        f"| {100 * (work / found.processor - 1):+.0f} % | {p['campaign_s']:.3g} ({p['campaign_low_s']:.3g} to "
        f"{p['campaign_high_s']:.3g}) | {found.elapsed:.3g} | {p['disk_bytes'] / 1e6:.2f} / {found.disk / 1e6:.2f} "
        f"| {count} | {found.load:.1f} |"
    )


HEAD = (
    "| study | trial | realisation, predicted [s] | realisation, wall [s] | processor time, predicted [s] | used [s] "
    "| off | campaign, predicted [s] | took [s] | disk, predicted / used [MB] | realisations | load |\n"
    + "|---" * 12
    + "|"
)
