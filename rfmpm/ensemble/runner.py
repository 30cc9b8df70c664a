"""Carries out a campaign: takes the folder, runs what is missing, merges the segments into the one dataset."""

import shutil
import time
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from rfmpm import results
from rfmpm.ensemble import folder, segments
from rfmpm.ensemble.campaign import Campaign
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
    allow_failed: float | None = None,
    wall_time: float | None = None,
    log_level: str = "warning",
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
        allow_failed: share of failed realisations that is allowed; the study's `failures.max_failed_fraction` if None.
        wall_time: time after which the campaign ends to be continued later [s]; no limit if None.
        log_level: of logs/rank-<rank>.log.

    Returns:
        The first `realisations` rows; None on every MPI rank but 0.

    Raises:
        FolderMismatch: if the folder cannot take this campaign; nothing in it was changed.
        LauncherMismatch: if mpirun and the MPI library do not belong together.
        Interrupted: if it ended early, by a signal, by its wall time or because workers were lost.
        CampaignFailed: if the failure policy of the study ended it.
        ValueError: for less than one realisation or worker, or for workers under several MPI ranks.
    """
    deadline = inf if wall_time is None else time.monotonic() + wall_time
    if realisations is not None:
        study = study.with_changes({"study.realisations": realisations})
    crew = _crew(workers)
    stop = Stop(deadline, max(LOOK_EVERY, crew.size / LOOKS))
    worker = Worker(study, Path(directory), stop, log_level)
    if crew.rank > 0:
        stop.file = worker.directory / folder.STOP_FILE
        crew.follow(worker)
        return None
    allowed = study.failures.max_failed_fraction if allow_failed is None else allow_failed
    try:
        with stop.listening(), folder.opened(worker.directory, study, fresh) as journal:
            campaign = Campaign(crew, worker, journal, allowed, progress)
            campaign.begin(fresh)
            with campaign.posted():
                campaign.carry_out()
                rows = segments.read_all(worker.directory, study, journal)
                total = study.study.realisations
                return _finish(study, worker.directory, [rows[index] for index in range(total)], journal)
    finally:
        crew.close()


def _crew(workers: int | None) -> Processes | Ranks:
    ranks = launched_ranks()
    if ranks is None or (ranks == 1 and workers is not None):
        return Processes(workers)
    if workers is not None:
        raise ValueError(f"workers = {workers}: under mpirun the {ranks} ranks are the workers; leave it out")
    return Ranks()


def _finish(study, directory: Path, rows: list[segments.Row], journal) -> "xr.Dataset":
    path = directory / results.ENSEMBLE_FILE
    merged = results.dataset(rows, study, {"start": journal.started(), "end": journal.ended()})
    results.write_dataset(path, merged)
    for name in (folder.WORK, folder.RUNNING):
        shutil.rmtree(directory / name, ignore_errors=True)
    journal.write("stop", complete=True, content_hash=merged.attrs["content_hash"])
    return results.open_ensemble(path)
