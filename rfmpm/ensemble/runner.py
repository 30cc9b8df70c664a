"""Carries out a campaign: takes the folder, runs what is missing, merges the segments into the one dataset."""

import shutil
import time
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from rfmpm import results
from rfmpm.ensemble import folder, segments
from rfmpm.ensemble.campaign import Campaign, Interrupted
from rfmpm.ensemble.finished import Finished
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
        realisations: how many; the study's number if None.
        workers: local processes; as many as there are processors if None.
        fresh: discard the results the folder holds.
        progress: show progress on standard error.
        indices: run the realisations from the first of these up to the second, itself not included, as a part of the
            study; all of them if None.
        allow_failed: share of failed realisations that is allowed; the study's `failures.max_failed_fraction` if None.
        wall_time: time after which the campaign ends to be continued later [s]; no limit if None.
        log_level: of logs/rank-<rank>.log.
        repeat_failed: run what a crash or a time limit ended once more.

    Returns:
        The rows that were asked for; None on every MPI rank but 0.

    Raises:
        FolderMismatch: if the folder cannot take this campaign; nothing in it was changed.
        LauncherMismatch: if mpirun and the MPI library do not belong together.
        Interrupted: if it ended early, by a signal, by its wall time (TooShort: before one realisation was finished),
            because workers were lost or because something could not be written.
        CampaignFailed: if the failure policy of the study ended it.
        ValueError: for less than one realisation or worker, for workers under several MPI ranks, or for indices that
            the study does not have.
    """
    deadline = inf if wall_time is None else time.monotonic() + wall_time
    if realisations is not None:
        study = study.with_changes({"study.realisations": realisations})
    asked = _asked(study.study.realisations, indices)
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
            campaign = Campaign(crew, worker, journal, asked, allowed, repeat_failed, progress)
            campaign.begin(fresh)
            with campaign.posted():
                campaign.carry_out()
                return _finish(study, worker.directory, asked, campaign.found, journal)
    except OSError as error:
        raise Interrupted(f"stopped early: {error}\nmend that and run the same command again to continue") from error
    finally:
        crew.close()


def _asked(total: int, indices: tuple[int, int] | None) -> range:
    first, stop = (0, total) if indices is None else indices
    if not 0 <= first < stop <= total:
        raise ValueError(f"indices = {first}:{stop}: must be a part, not empty, of 0:{total}")
    return range(first, stop)


def _crew(workers: int | None) -> Processes | Ranks:
    ranks = launched_ranks()
    if ranks is None or (ranks == 1 and workers is not None):
        return Processes(workers)
    if workers is not None:
        raise ValueError(f"workers = {workers}: under mpirun the {ranks} ranks are the workers; leave it out")
    return Ranks()


def _finish(study, directory: Path, asked: range, found: Finished, journal) -> "xr.Dataset":
    path = directory / results.ENSEMBLE_FILE
    when = {"start": journal.started(), "end": journal.ended()}
    content_hash = segments.merge(directory, study, journal, asked.stop, path, when, asked.start, found)
    for name in (folder.WORK, folder.RUNNING):
        shutil.rmtree(directory / name, ignore_errors=True)
    journal.write("stop", complete=True, content_hash=content_hash)
    return results.open_ensemble(path)
