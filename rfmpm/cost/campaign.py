"""What a campaign will cost: times, memory and disk, from trials."""

import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import planning, realisation
from rfmpm.cost import results as files_of_results
from rfmpm.cost import trial
from rfmpm.ensemble.processes import available_processors
from rfmpm.report.numbers import MOST_PICTURED

UNKNOWN_ERROR = 0.5  # where a single realisation was tried, or none [-]
UNKNOWN_COUNT = 1000  # of realisations, where nothing of what is said depends on it
NORMAL_95 = 1.96  # half width of a 95 % interval over the standard error [-]
WORST_CASE = 0.25 * 1.1  # variance of an indicator of probability one half, and how much more the exact interval takes
OF_ALL_CELLS = (
    *("campaign_s", "campaign_low_s", "campaign_high_s", "campaign_at_most_s"),
    *("disk_bytes", "disk_at_most_bytes"),
)
OF_THE_CAMPAIGN = (*OF_ALL_CELLS, "work_s", "report_s")
LEAST_ERROR = 0.15  # of a time measured for seconds, on a machine that others use too [-]


@dataclass(frozen=True)
class Trials:
    """What the trials of a study showed."""

    prepared: realisation.Prepared
    preparation: float  # scene and factor of the fields, once per campaign [s]
    time_step: float  # [s]
    speed: trial.Speed
    lengths: trial.Lengths | None
    files: files_of_results.Files

    @property
    def steps_at_most(self) -> int:
        """Steps of a realisation that moves to the end."""
        return ceil(self.prepared.study.time.end_s / self.time_step)

    def seconds(self, steps: Any) -> Any:
        """Time of realisations of so many steps [s]."""
        return self.speed.beside + self.speed.step * steps


def estimate(study, ranks: int | None = None) -> dict[str, int | float]:
    """Predict the cost of a campaign from trials of some seconds; nothing is kept.

    Args:
        study: the study.
        ranks: workers of the campaign, here or on machines like this one; None for the processors of this machine.

    Returns:
        Counts, times in keys that end in `_s`, lengths in `_m` and sizes in `_bytes`. What is "at most" holds for
        realisations that move until `time.end_s`; the rest expects realisations to come to rest as the trial ones do.
        Where a question decides how many there are, those of the campaign are for `realisations_at_most`, or left out
        where that is not known; coarser cells have keys of their own, and the campaign is then `work_s` on the study's
        own cells, at most. Times are those of processors that do nothing else; `campaign_high_s` includes what else
        they did in the trial.

    Raises:
        ValueError: for less than one rank.
    """
    if ranks is not None and ranks < 1:
        raise ValueError(f"ranks = {ranks}: at least 1 is needed")
    levels, most = planning.studies_by_level(study), most_realisations(study)
    count = most or UNKNOWN_COUNT
    workers = min(ranks or available_processors(), count)
    tried = levels[0].with_changes({"study.until": None, "study.realisations": count, "estimator": None})
    with tempfile.TemporaryDirectory() as scratch:
        trials = _try(tried, min(workers, available_processors()), Path(scratch))
        coarser = _coarser(trials, levels[1:], workers, Path(scratch))
    found = _sizes(trials, count, workers) | _times(trials, count, workers)
    if study.study.until is None:
        return found
    unknown = {*(OF_THE_CAMPAIGN if most is None else ()), *(OF_ALL_CELLS if coarser else ())}
    known = {name: value for name, value in found.items() if name not in unknown}
    return ({} if most is None else {"realisations_at_most": most}) | known | coarser


def most_realisations(study) -> int | None:
    """How many realisations on the study's own cells its campaign has at the most; None where that is not known.

    Args:
        study: the study.

    Returns:
        The fixed number, `at_most`, or what the width of a probability's interval takes in the worst case.
    """
    asked = study.study.until
    if asked is None or asked.at_most is not None:
        return study.study.realisations if asked is None else asked.at_most
    if asked.half_width is None:
        return None
    return ceil(WORST_CASE * (NORMAL_95 / asked.half_width) ** 2)


def _coarser(trials: Trials, levels: Sequence[Any], workers: int, scratch: Path) -> dict[str, int | float]:
    """Cost of a simulation on each of the coarser cells; steps are taken as proportional to the cells along a side."""
    own, found = trials.prepared.study.discretisation.cell_m, {}
    steps = trials.lengths.steps if trials.lengths else np.array([float(trials.steps_at_most)])
    for number, level in enumerate(levels, start=1):
        cell = level.discretisation.cell_m
        time_step = trials.time_step * cell / own
        speed = trial.speed(level, scratch / "work", min(workers, available_processors()), time_step)
        found |= {
            f"level_{number}_cell_m": cell,
            f"level_{number}_realisation_s": float(speed.beside + speed.step * steps.mean() * own / cell),
        }
    return found


def _try(study, workers: int, scratch: Path) -> Trials:
    from threadpoolctl import threadpool_limits

    store, folder = scratch / "work", scratch / "results"
    store.mkdir()
    folder.mkdir()
    with threadpool_limits(limits=1):
        started = time.process_time()
        prepared = realisation.prepare(study, store)
        preparation = time.process_time() - started
    realisation.compile_kernels(prepared)
    controls = prepared.scene.controls
    time_step = controls.courant * controls.cell / controls.wave_speed
    speed = trial.speed(study, store, workers, time_step)
    lengths = trial.lengths(study, store, speed.beside + speed.step * study.time.end_s / time_step)
    rows = lengths.rows if lengths else [trial.begin(prepared, time_step)]
    files = files_of_results.measure(study, prepared.scene, rows, folder)
    return Trials(prepared, preparation, time_step, speed, lengths, files)


def _sizes(trials: Trials, count: int, workers: int) -> dict[str, int | float]:
    scene, files = trials.prepared.scene, trials.files
    segments = files_of_results.segment_count(_durations(trials).mean(), count, workers)
    return {
        "points": len(scene.points.mass),
        "cells": scene.axes.x.cells * scene.axes.y.cells,
        "time_step_s": trials.time_step,
        "memory_per_worker_bytes": trials.speed.memory,
        "memory_bytes": trials.speed.memory * workers,
        "disk_bytes": files_of_results.disk(files, count, segments),
        "disk_at_most_bytes": files_of_results.disk(files, count, count),
    }


def _times(trials: Trials, count: int, workers: int) -> dict[str, int | float]:
    seconds, at_most = _durations(trials), trials.seconds(trials.steps_at_most)
    mean, longest = float(seconds.mean()), float(seconds.max())
    before = trials.preparation + trials.speed.start
    pictured = min(count, MOST_PICTURED)
    after = trials.files.report_seconds + pictured * mean
    campaign = before + makespan(mean, longest, count, workers) + after
    error = relative_error(seconds, count)
    lengths = trials.lengths
    return {
        "steps_at_most": trials.steps_at_most,
        "realisation_at_most_s": at_most,
        "local_workers": min(available_processors(), count),
        "campaign_at_most_s": before + at_most * (ceil(count / workers) + pictured) + trials.files.report_seconds,
        "trial_realisations": len(seconds) if lengths else 0,
        "trial_cell_m": lengths.cell if lengths else 0.0,
        "steps": round(float(lengths.steps.mean())) if lengths else trials.steps_at_most,
        "realisation_s": mean,
        "realisation_shortest_s": float(seconds.min()),
        "realisation_longest_s": longest,
        "workers": workers,
        "preparation_s": before,
        "worker_start_s": trials.speed.start,
        "report_s": after,
        "work_s": mean * count,
        "campaign_s": campaign,
        "campaign_low_s": campaign * (1.0 - error),
        "campaign_high_s": campaign * (1.0 + error) / trials.speed.share,
        "processor_share": round(trials.speed.share, 2),
    }


def _durations(trials: Trials) -> np.ndarray:
    """Time of each trial realisation, were it run with the study's cells; the longest possible one if none was [s]."""
    lengths = trials.lengths
    return trials.seconds(lengths.steps if lengths else np.array([float(trials.steps_at_most)]))


def makespan(mean: float, longest: float, count: int, workers: int) -> float:
    """Expect how long workers need that take one realisation after the other.

    When the first worker finds nothing left, each of the others has on average half a realisation to go.

    Args:
        mean: time of a realisation [s].
        longest: time of the longest one [s].
        count: of realisations.
        workers: that share them.

    Returns:
        Time from the first start to the last end [s].
    """
    if count <= workers:
        return longest
    return max(longest, mean * count / workers + 0.5 * longest * (1.0 - 1.0 / workers))


def relative_error(seconds: np.ndarray, count: int) -> float:
    """How far the time of a campaign may be off: two standard errors of what a few trials tell, and what speed varies.

    Args:
        seconds: of the trial realisations, shape (n,) [s].
        count: of the campaign's realisations.

    Returns:
        Share of the time [-].
    """
    n = len(seconds)
    if n < 2:
        return UNKNOWN_ERROR
    spread = float(np.std(seconds, ddof=1) / np.mean(seconds))
    return min(0.9, sqrt(LEAST_ERROR**2 + (2.0 * spread) ** 2 * (1.0 / n + 1.0 / count)))
