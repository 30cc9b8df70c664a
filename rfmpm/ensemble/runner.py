"""Carries out a campaign: takes the folder, runs what is missing, merges the segments into the one dataset."""

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from rfmpm import results
from rfmpm.ensemble import folder, segments
from rfmpm.ensemble.dispatcher import Dispatcher
from rfmpm.ensemble.finished import Finished
from rfmpm.ensemble.mpi import Ranks, launched_ranks
from rfmpm.ensemble.processes import Processes
from rfmpm.ensemble.progress import Progress
from rfmpm.ensemble.worker import Abandoned, Worker
from rfmpm.estimators.monte_carlo import MonteCarlo
from rfmpm.variables import failed_row

if TYPE_CHECKING:
    import xarray as xr

FATAL_STARTS = 3  # a realisation that took so many workers with it is given up


class Interrupted(RuntimeError):
    """A campaign that ended early; what is finished is on disk and the same command continues it."""


def run(
    study,
    directory: Path | str,
    realisations: int | None = None,
    workers: int | None = None,
    fresh: bool = False,
    progress: bool = True,
    indices: tuple[int, int] | None = None,
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

    Returns:
        The rows that were asked for; None on every MPI rank but 0.

    Raises:
        FolderMismatch: if the folder cannot take this campaign; nothing in it was changed.
        LauncherMismatch: if mpirun and the MPI library do not belong together.
        Interrupted: if it ended early, by a signal, because workers were lost or because something could not be
            written.
        ValueError: for less than one realisation or worker, for workers under several MPI ranks, or for indices that
            the study does not have.
    """
    if realisations is not None:
        study = study.with_changes({"study.realisations": realisations})
    asked = _asked(study.study.realisations, indices)
    crew, worker = _crew(workers), Worker(study, Path(directory))
    if crew.rank > 0:
        crew.follow(worker)
        return None
    try:
        with worker.stop.listening(), folder.opened(worker.directory, study, fresh) as journal:
            return _campaign(crew, worker, journal, asked, fresh, progress)
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


def _campaign(
    crew: Processes | Ranks, worker: Worker, journal, asked: range, fresh: bool, is_shown: bool
) -> "xr.Dataset":
    study, directory = worker.study, worker.directory
    total = len(asked)
    before = segments.finished(directory, study, journal)
    todo = _missing(asked, before)
    journal.write("start", fresh=fresh, realisations=total, todo=len(todo), workers=crew.size, **_origin(study))
    todo = _give_up(todo, worker, journal)
    losses = []
    if todo:
        losses = _carry_out(crew, worker, journal, todo, Progress(total, total - len(todo), is_shown))
    after = segments.finished(directory, study, journal, before)
    missing = _missing(asked, after)
    if missing:
        journal.write("stop", complete=False, missing=len(missing))
        raise Interrupted(_what_is_left(total, missing, losses))
    return _finish(study, directory, asked, after, journal)


def _missing(asked: range, found: Finished) -> list[int]:
    return [index for index in MonteCarlo(asked.stop).plan(found.indices) if index in asked]


def _origin(study) -> dict[str, str]:
    return {"physics_hash": study.physics_hash, "source_hash": results.source_hash(), **results.versions()}


def _give_up(todo: list[int], worker: Worker, journal) -> list[int]:
    """Write rows with status lost for realisations that kill their workers; returns the others."""
    fatal = {index for index, count in journal.fatal_starts().items() if count >= FATAL_STARTS}
    writer = segments.SegmentWriter(worker.directory, worker.study, 0)
    reason = f"{FATAL_STARTS} workers died in this realisation"
    written = []
    for index in sorted(fatal.intersection(todo)):
        written += writer.add(failed_row(worker.study, index, "lost", reason))
    for segment in written + writer.flush():
        journal.write("segment", rank=0, **segment)
    return [index for index in todo if index not in fatal]


def _carry_out(crew: Processes | Ranks, worker: Worker, journal, todo: list[int], progress: Progress) -> list[str]:
    from threadpoolctl import threadpool_limits

    try:
        with threadpool_limits(limits=1):
            worker.prepare()
    except Abandoned:
        return ["a signal asked for the end"]
    with progress:
        dispatcher = Dispatcher(todo, journal, progress)
        crew.lead(worker, dispatcher)
    return [*dispatcher.losses, *(["a signal asked for the end"] if worker.stop.is_requested else [])]


def _what_is_left(total: int, missing: list[int], losses: list[str]) -> str:
    reasons = "".join(f"\n  {loss}" for loss in losses)
    return (
        f"stopped early with {total - len(missing)} of {total} realisations; "
        f"run the same command again to continue{reasons}"
    )


def _finish(study, directory: Path, asked: range, found: Finished, journal) -> "xr.Dataset":
    path = directory / results.ENSEMBLE_FILE
    when = {"start": journal.started(), "end": journal.ended()}
    content_hash = segments.merge(directory, study, journal, asked.stop, path, when, asked.start, found)
    shutil.rmtree(directory / folder.WORK, ignore_errors=True)
    journal.write("stop", complete=True, content_hash=content_hash)
    return results.open_ensemble(path)
