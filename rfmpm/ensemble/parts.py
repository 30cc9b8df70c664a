"""Puts together the campaign of one study that was run in parts, in several folders or on several machines."""

import os
import platform
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

from rfmpm import campaign_status, planning, results
from rfmpm.campaign_status import now
from rfmpm.ensemble import folder, segments
from rfmpm.ensemble.books import Books
from rfmpm.ensemble.finished import NOTHING, Finished
from rfmpm.ensemble.journal import JOURNAL_FILE, Journal
from rfmpm.study import StudyError, load_study


@dataclass(frozen=True)
class Whole:
    """What parts came to."""

    total: int  # realisations of the study
    missing: np.ndarray  # realisations that no part has, sorted
    failed: int  # of those that are there
    allowed: float  # share of failed ones that the study allows


def merge_parts(parts: Sequence[Path], out: Path) -> Whole:
    """Gather the rows of several folders in one, which a run of the same study continues.

    The folders are read only; nothing is written before they are known to belong together. The study is that of the
    part that has most realisations.

    Args:
        parts: folders of campaigns of one study; their realisations may overlap and leave gaps.
        out: the folder that gets copies of the rows, and ensemble.nc if none is missing; made if need be. It may hold
            results of the same study, which are kept.

    Returns:
        What is there and what is missing.

    Raises:
        FolderMismatch: if a folder holds no campaign, the studies differ in their physics or the sources do, or `out`
            cannot be used.
        RowsDiffer: if two rows of one realisation are not the same.
        OSError: if something cannot be read or written.
    """
    parts = list(dict.fromkeys([*parts, *([out] if (out / folder.STUDY_FILE).is_file() else [])]))
    studies = [_study(part) for part in parts]
    study = max(studies, key=lambda study: study.study.realisations)
    for part, other in zip(parts, studies, strict=True):
        if other.physics_hash != study.physics_hash:
            raise folder.FolderMismatch(
                f"{part}: holds another study than {parts[studies.index(study)]}\n  "
                + "\n  ".join(folder.differences(other, study))
            )
    found = NOTHING
    for part in parts:
        found = segments.finished(part, study, None, found)
    with folder.opened(out, study, fresh=False) as journal:
        found = segments.finished(out, study, journal, found)
        for segment in found.segments:
            results.copy_rows(segment.path, out / folder.SEGMENTS)
        start, end = _times([*parts, out])
        missing = np.setdiff1d(np.arange(study.study.realisations), found.codes)
        journal.write("start", time=start, end=end, parts=[str(part) for part in parts], missing=len(missing))
        if not len(missing):
            _finish(out, study, journal, found, {"start": start, "end": end})
        _post(out, study.study.realisations, found, start)
    return Whole(study.study.realisations, missing, found.failed, study.failures.max_failed_fraction)


def _study(part: Path):
    try:
        study = load_study(part / folder.STUDY_FILE)
    except (OSError, StudyError) as error:
        raise folder.FolderMismatch(f"{part}: holds no readable {folder.STUDY_FILE} of a campaign") from error
    if study.study.until is not None:
        raise folder.FolderMismatch(f"{part}: {planning.NOT_DIVISIBLE}")
    return study


def _times(folders: Sequence[Path]) -> tuple[str, str]:
    """When the first of several campaigns started and when the last rows were written, ISO 8601."""
    journals = [Journal(path / JOURNAL_FILE) for path in folders]
    begun = [journal for journal in journals if journal.events("start")]
    if not begun:
        return now(), now()
    starts, ends = [journal.started() for journal in begun], [journal.ended() for journal in begun]
    return min(starts, key=datetime.fromisoformat), max(ends, key=datetime.fromisoformat)


def _finish(out: Path, study, journal, found: Finished, times: dict[str, str]) -> None:
    path, wanted = out / results.ENSEMBLE_FILE, np.arange(study.study.realisations)
    content_hash = segments.merge(out, study, journal, wanted, path, times, found)
    journal.write("stop", complete=True, content_hash=content_hash)


def _post(out: Path, total: int, found: Finished, start: str) -> None:
    """Let status.json say what the parts came to."""
    books = Books(total, dict(Counter(found.status.tolist())), "record", 1.0)
    state = campaign_status.COMPLETE if books.before == total else campaign_status.STOPPED
    reason = "" if books.before == total else f"{total - books.before} realisations are in none of the parts"
    counts = {"first": 0, "total": total, "done": books.before, "failed": books.failures(), "workers": 0}
    rest = {"running": [], "rate_per_minute": 0.0, "seconds_left": None, "host": platform.node(), "pid": os.getpid()}
    when = {"started": start, "updated": campaign_status.now()}
    campaign_status.write(out, {"state": state, "reason": reason, **counts, **rest, **when})


def ranges(indices: np.ndarray) -> list[str]:
    """Name sorted indices in words.

    Args:
        indices: sorted, shape (n,).

    Returns:
        Runs without a gap: "3", "7 to 9".
    """
    runs = np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1) if len(indices) else []
    return [str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
