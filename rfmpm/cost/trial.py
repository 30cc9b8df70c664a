"""Short trials on this machine: how fast a worker is in the true scene, and how many steps realisations take."""

import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from rfmpm import realisation
from rfmpm.ensemble import segments
from rfmpm.study import StudyError

FIRST_STEPS = 200
SPEED_SECONDS = 3.0
STEPS_SECONDS = 15.0
LEAST_REALISATIONS, MOST_REALISATIONS = 4, 24
CELL_FACTORS = (1, 2, 3, 4, 5, 6, 8)


class Speed(NamedTuple):
    """What a worker needs while others work beside it; times of a processor, which other users do not lengthen."""

    start: float  # until it can begin its first realisation [s]
    beside: float  # of a realisation, besides its steps: field, quantities [s]
    step: float  # [s]
    memory: int  # [bytes]
    share: float  # of a processor that it got; less than 1 where the machine has other work [-]


class Lengths(NamedTuple):
    """How many steps realisations take."""

    cell: float  # of the trial [m]
    steps: np.ndarray  # of each trial realisation, as it would be with the study's cells, shape (n,)
    rows: list[dict[str, Any]]  # of the trial realisations


def speed(study, store: Path, workers: int, time_step: float) -> Speed:
    """Measure workers that run the beginning of a realisation at the same time.

    Args:
        study: the study.
        store: folder with the factor of its fields, if it has one.
        workers: how many at once.
        time_step: of the study [s].

    Returns:
        Means over the workers.
    """
    context = get_context("spawn")  # a fresh process, as a rank of MPI is
    gate = (context.Barrier(workers),)
    with ProcessPoolExecutor(workers, mp_context=context, initializer=_keep_gate, initargs=gate) as pool:
        found = [pool.submit(_measure, study, store, time_step) for _ in range(workers)]
        measured = np.array([entry.result() for entry in found])
    start, beside, step, memory, share = measured.mean(axis=0)
    return Speed(start, beside, step, int(memory), min(share, 1.0))


def _keep_gate(gate) -> None:
    global _gate
    _gate = gate


def _measure(study, store: Path, time_step: float) -> Speed:
    import psutil
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        prepared = realisation.prepare(study, store)
        realisation.compile_kernels(prepared)
        row = begin(prepared, time_step)  # brings what a first realisation and a first segment import
        with TemporaryDirectory() as folder:
            (Path(folder) / segments.SEGMENTS).mkdir()
            writer = segments.SegmentWriter(Path(folder), study, 0)
            writer.add(row)
            writer.flush()
        start = time.process_time()
        _gate.wait()
        beside = min(_timed(prepared, time_step)[0] for _ in range(3))
        busy, steps = _timed(prepared, FIRST_STEPS * time_step)
        wanted = SPEED_SECONDS * steps / max(busy - beside, 1e-9)
        started = time.perf_counter()
        busy, steps = _timed(prepared, min(wanted * time_step, study.time.end_s))
        share = busy / (time.perf_counter() - started)
    return Speed(start, beside, max(busy - beside, 0.0) / steps, psutil.Process().memory_info().rss, share)


def _timed(prepared: realisation.Prepared, end: float) -> tuple[float, int]:
    """Processor time [s] and steps of the beginning of a realisation."""
    started = time.process_time()
    row = begin(prepared, end)
    return time.process_time() - started, row["step_count"]


def begin(prepared: realisation.Prepared, end: float) -> dict[str, Any]:
    """Run realisation 0 up to another end than the study's [s]; returns its row."""
    return realisation.run(replace(prepared, study=prepared.study.with_changes({"time.end_s": end})), 0)


def lengths(study, store: Path, at_most: float) -> Lengths | None:
    """Run realisations to their end, on the finest cells on which a few fit into a quarter of a minute.

    The number of steps is taken as proportional to the number of cells along a side.

    Args:
        study: the study.
        store: folder for the factor of its fields.
        at_most: seconds of a realisation that moves until `time.end_s`, with the study's cells.

    Returns:
        What they took, or None if no cells are coarse enough.
    """
    chosen = next(_affordable(study, at_most), None)
    if chosen is None:
        return None
    factor, coarse = chosen
    prepared = realisation.prepare(coarse, store if factor == 1 else None)
    realisation.compile_kernels(prepared)
    rows = []
    end = time.perf_counter() + STEPS_SECONDS
    while len(rows) < min(MOST_REALISATIONS, study.study.realisations) and time.perf_counter() < end:
        rows.append(realisation.run(prepared, len(rows)))
    steps = factor * np.array([float(row["step_count"]) for row in rows])
    return Lengths(coarse.discretisation.cell_m, steps, rows)


def _affordable(study, at_most: float) -> Iterator[tuple[int, Any]]:
    for factor in CELL_FACTORS:
        if LEAST_REALISATIONS * at_most / factor**3 > STEPS_SECONDS:
            continue
        try:
            yield factor, study.with_changes({"discretisation.cell_m": factor * study.discretisation.cell_m})
        except StudyError:  # cells that do not fit the scene or the soil
            continue
