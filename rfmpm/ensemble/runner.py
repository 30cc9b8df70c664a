"""Carries out a campaign: takes the folder, runs what is missing, merges the segments into the one dataset."""

import shutil
import time
from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from rfmpm import planning, results
from rfmpm.ensemble import folder, segments
from rfmpm.ensemble.campaign import Campaign, Interrupted
from rfmpm.ensemble.course import FixedCourse, OpenCourse
from rfmpm.ensemble.mpi import Ranks, launched_ranks
from rfmpm.ensemble.processes import Processes
from rfmpm.ensemble.stop import LOOK_EVERY, Stop
from rfmpm.ensemble.worker import Worker

if TYPE_CHECKING:
    import xarray as xr

LOOKS = 100.0  # per second at the file STOP, by all ranks together: a shared file system bears no more


def run(
    study,
    directory: Path | str,
    realisations: int | None = None,
    workers: int | None = None,
    fresh: bool = False,
    progress: bool = True,
    *,
    indices: tuple[int, int] | None = None,
    allow_failed: float | None = None,
    wall_time: float | None = None,
    log_level: str = "warning",
    repeat_failed: bool = False,
) -> "xr.Dataset | None":
    """Run a campaign, or what is missing of it, and gather its rows in ensemble.nc.

    Under an MPI launcher every rank calls this and works; otherwise local processes do.

    Args:
        study: the study.
        directory: folder of the results; continued if it holds results of the same study.
        realisations: how many, of a study that has a number of them; the study's own if None.
        workers: local processes; as many as there are processors if None.
        fresh: discard the results the folder holds.
        progress: show progress on standard error.
        indices: run the realisations from the first of these up to the second, itself not included, as a part of the
            study with a fixed number of independent ones; all of them if None.
        allow_failed: share of failed realisations that is allowed; the study's `failures.max_failed_fraction` if None.
        wall_time: time after which the campaign ends to be continued later [s]; no limit if None.
        log_level: of logs/rank-<rank>.log.
        repeat_failed: run what a crash or a time limit ended once more; not where later realisations follow from it.

    Returns:
        The rows that were asked for, or that the study's question took: those of coarser cells too, sorted by level
        and index. None on every MPI rank but 0.

    Raises:
        FolderMismatch: if the folder cannot take this campaign; nothing in it was changed.
        LauncherMismatch: if mpirun and the MPI library do not belong together.
        Interrupted: if it ended early, by a signal, by its wall time (TooShort: before one realisation was finished),
            because workers were lost or because something could not be written.
        CampaignFailed: if the failure policy of the study ended it.
        ValueError: for less than one realisation or worker, for workers under several MPI ranks, or for indices that
            the study does not have or may not be divided by.
        StudyError: if the study asks a question and `realisations` are given.
    """
    deadline = inf if wall_time is None else time.monotonic() + wall_time
    if realisations is not None:
        study = study.with_changes({"study.realisations": realisations})
    course = _course(study, indices, repeat_failed)
    crew = _crew(workers)
    stop = Stop(deadline, max(LOOK_EVERY, crew.size / LOOKS))
    worker = Worker(study, Path(directory), stop, log_level)
    if crew.rank > 0:
        stop.file = worker.directory / folder.STOP_FILE
        with stop.listening():
            crew.follow(worker)
        return None
    allowed = study.failures.max_failed_fraction if allow_failed is None else allow_failed
    try:
        with stop.listening(), folder.opened(worker.directory, study, fresh) as journal:
            campaign = Campaign(crew, worker, journal, course(), allowed, repeat_failed, progress)
            campaign.begin(fresh)
            with campaign.posted():
                campaign.carry_out()
                return _finish(campaign)
    except OSError as error:
        raise Interrupted(f"stopped early: {error}\nmend that and run the same command again to continue") from error
    finally:
        crew.close()


def _course(study, indices: tuple[int, int] | None, repeat_failed: bool) -> Callable[[], FixedCourse | OpenCourse]:
    """What makes the course of a study, for the one process that follows it."""
    if repeat_failed and planning.approaches_limit(study):
        raise ValueError(f"repeat_failed: {planning.NOT_AGAIN}")
    if indices is not None and not planning.is_divisible(study):
        raise ValueError(f"indices: {planning.NOT_DIVISIBLE}")
    if study.study.until is not None:
        return lambda: OpenCourse(study, planning.estimator_of(study))
    total = study.study.realisations
    first, stop = (0, total) if indices is None else indices
    if not 0 <= first < stop <= total:
        raise ValueError(f"indices = {first}:{stop}: must be a part, not empty, of 0:{total}")
    return lambda: FixedCourse(range(first, stop))


def _crew(workers: int | None) -> Processes | Ranks:
    ranks = launched_ranks()
    if ranks is None or (ranks == 1 and workers is not None):
        return Processes(workers)
    if workers is not None:
        raise ValueError(f"workers = {workers}: under mpirun the {ranks} ranks are the workers; leave it out")
    return Ranks()


def _finish(campaign: Campaign) -> "xr.Dataset":
    study, directory, journal = campaign.study, campaign.directory, campaign.journal
    path, wanted = directory / results.ENSEMBLE_FILE, campaign.position.done
    when = {"start": journal.started(), "end": journal.ended()}
    content_hash = segments.merge(directory, study, journal, wanted, path, when, campaign.found)
    for name in (folder.WORK, folder.RUNNING):
        shutil.rmtree(directory / name, ignore_errors=True)
    journal.write("stop", complete=True, content_hash=content_hash)
    return results.open_ensemble(path)
