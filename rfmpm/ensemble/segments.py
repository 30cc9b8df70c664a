"""Segments: immutable files of finished rows; the valid ones are the truth about a campaign."""

import logging
import os
import shutil
import time
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import planning, results
from rfmpm.ensemble import codes
from rfmpm.ensemble.finished import NOTHING, PLACES, Finished, Segment, one_each
from rfmpm.ensemble.folder import QUARANTINE, SEGMENTS, FolderMismatch
from rfmpm.variables import BY_CHANCE, active_variables

log = logging.getLogger("rfmpm")

ROWS = 4096
SECONDS = 20.0  # a worker that is killed takes so much of its work with it
Row = dict[str, Any]

_BLOCK = 2**26  # bytes of the rows that are merged at once


class SegmentWriter:
    """Collects the rows of one worker and writes them as segments."""

    def __init__(self, directory: Path, study, rank: int):
        self.folder, self.study, self.rank = Path(directory) / SEGMENTS, study, rank
        self.rows: list[Row] = []
        self.counter = 0
        self.since = time.monotonic()

    @cached_property
    def attributes(self) -> dict[str, Any]:
        """What every segment of this worker says about its rows."""
        return results.row_attributes(self.study)

    def add(self, row: Row) -> list[dict]:
        """Take a finished row; write a segment if enough rows have gathered, or enough time since the last one.

        Args:
            row: of one realisation.

        Returns:
            What was written: at most one entry with the segment's name, its realisations and, if not all 0, levels.

        Raises:
            OSError: if the segment cannot be written.
        """
        self.rows.append(row)
        is_due = len(self.rows) >= ROWS or time.monotonic() - self.since >= SECONDS
        return self.flush() if is_due else []

    def flush(self) -> list[dict]:
        """Write the rows at hand, if there are any; returns and raises as `add`."""
        if not self.rows:
            return []
        stem = f"{self.rank:05d}-{os.getpid()}-{self.counter:05d}"
        path = results.write_rows(self.folder, stem, results.columns(self.rows, self.study), self.attributes)
        written = {"segment": path.name, "realisations": [int(row["realisation"]) for row in self.rows]}
        if any(levels := [int(row["level"]) for row in self.rows]):
            written["levels"] = levels
        self.rows, self.counter, self.since = [], self.counter + 1, time.monotonic()
        return [written]


def finished(directory: Path, study, journal, earlier: Finished = NOTHING) -> Finished:
    """Find out which realisations have a valid row; a segment that is not valid counts as if it were not there.

    Rows without the surface that the study asks for, or with other bins, are no finished ones: they run again.

    Args:
        directory: of the campaign.
        study: the study that is run.
        journal: where a damaged segment is noted, which goes to quarantine; None leaves it where it is.
        earlier: what the same function found before, there or in another folder; only other segments are read, and
            their rows are added.

    Returns:
        The finished realisations.

    Raises:
        FolderMismatch: if the rows were made by another study or another version of the sources.
        RowsDiffer: if two rows of one realisation are not the same.
    """
    known, physics_hash = {segment.path for segment in earlier.segments}, study.physics_hash
    segments, places = list(earlier.segments), [earlier.places]
    for path in sorted((Path(directory) / SEGMENTS).glob(f"*{results.ROWS_SUFFIX}")):
        if path in known or (stored := _valid(path, journal)) is None:
            continue
        _check_origin(path, stored.attributes, physics_hash)
        found = _places(stored.columns, study)
        found["segment"] = len(segments)
        segments.append(Segment(path, _origin(stored.attributes), _is_whole(stored.attributes, study)))
        places.append(found)
    return Finished(tuple(segments), one_each(segments, np.concatenate(places)))


def _places(columns: results.Columns, study) -> np.ndarray:
    """Places of the rows of one segment, whose number is still to be filled in."""
    found = np.empty(len(columns["realisation"]), PLACES)
    found["code"] = codes.encoded(columns["level"], columns["realisation"])
    found["status"], found["row"] = columns["status"], np.arange(len(found))
    found["value"], found["is_censored"] = planning.outcomes(study, columns)
    found["step_count"] = np.nan_to_num(columns["step_count"], nan=-1.0)
    return found


def merge(
    directory: Path,
    study,
    journal,
    wanted: np.ndarray,
    path: Path,
    attributes: Mapping[str, Any],
    known: Finished = NOTHING,
) -> str:
    """Write the finished rows as one dataset, in bounded memory.

    Args:
        directory: of the campaign.
        study: the study that is run.
        journal: as for `finished`.
        wanted: codes of what is taken, sorted, shape (n,).
        path: the file to be written.
        attributes: further global attributes.
        known: what `finished` found before.

    Returns:
        Hash of the content.

    Raises:
        ValueError: if a realisation has no row.
        OSError: if the file cannot be written.
        FolderMismatch, RowsDiffer: as `finished`.
    """
    found = finished(directory, study, journal, known)
    places = found.at(wanted)
    if len(places) < len(wanted):
        raise ValueError(f"{directory}: {len(wanted) - len(places)} of {len(wanted)} realisations have no row")
    used = np.unique(places["segment"])
    origins = sorted({found.segments[segment].origin for segment in used})
    lines = "\n".join(f"{number}: {origin}" for number, origin in enumerate(origins))
    names = ["realisation", "level", "attempt", *(variable.name for variable in active_variables(study))]
    described = {**attributes, "origins": lines, **_part(wanted, study)}
    return results.write_ensemble(path, study, len(places), _blocks(found, places, origins, names), described)


def _part(wanted: np.ndarray, study) -> dict[str, int]:
    """What a dataset says that holds a part of a study with a fixed number of realisations."""
    total = study.study.realisations
    if total is None or (wanted[0] == 0 and len(wanted) == total):
        return {}
    return {"first_realisation": int(wanted[0]), "realisations_of_study": total}


def find_row(directory: Path, index: int, level: int = 0) -> results.StoredRows:
    """Read the row of one realisation, of whatever study and version, complete campaign or not.

    Of several, one that did not end by chance (a crash, a time limit) comes first.

    Args:
        directory: of the campaign.
        index: of the realisation.
        level: on whose cells it was simulated; 0 for the study's own.

    Returns:
        The row, each column of shape (1,) or (1, bins), and what its segment says about it.

    Raises:
        LookupError: if no valid segment has it.
    """
    by_chance = None
    for path in sorted((Path(directory) / SEGMENTS).glob(f"*{results.ROWS_SUFFIX}")):
        if (stored := _valid(path, None)) is None:
            continue
        at = np.flatnonzero((stored.columns["realisation"] == index) & (stored.columns["level"] == level))
        if len(at):
            row = results.StoredRows({name: values[at] for name, values in stored.columns.items()}, stored.attributes)
            if int(row.columns["status"][0]) not in BY_CHANCE:
                return row
            by_chance = by_chance or row
    if by_chance is not None:
        return by_chance
    which = codes.in_words(codes.LEVEL * level + index)
    raise LookupError(f"{directory}: {which} has no row here; has it been run?")


def _blocks(found: Finished, places: np.ndarray, origins, names) -> Iterator[results.Columns]:
    """Gather rows that follow each other from the segments they are scattered over."""
    start, step = 0, 1
    while start < len(places):
        block = places[start : start + step]
        taken = {"origin": np.empty(len(block), "i4")}
        for number in np.unique(block["segment"]):
            segment = found.segments[number]
            stored = results.read_rows(segment.path).columns
            at = np.flatnonzero(block["segment"] == number)
            taken["origin"][at] = origins.index(segment.origin)
            for name in names:
                values = stored[name][block["row"][at]]
                taken.setdefault(name, np.empty((len(block), *values.shape[1:]), values.dtype))[at] = values
        yield taken
        start += len(block)
        step = max(1, _BLOCK // sum(values.nbytes // len(block) for values in taken.values()))


def _origin(attributes: Mapping[str, Any]) -> str:
    return f"{attributes['host']}; rfmpm {attributes['rfmpm_version']}, {attributes['library_versions']}"


def _is_whole(attributes: Mapping[str, Any], study) -> bool:
    asked = study.output.surface_bin_m
    return asked is None or attributes.get("surface_bin_m") == asked


def _valid(path: Path, journal) -> results.StoredRows | None:
    try:
        return results.read_rows(path)
    except results.UnreadableRows as error:
        if journal is None:
            log.warning("%s; its realisations count as missing", error)
        else:
            _quarantine(path, str(error), journal)
        return None


def _quarantine(path: Path, reason: str, journal) -> None:
    folder = path.parents[1] / QUARANTINE
    folder.mkdir(exist_ok=True)
    shutil.move(path, folder / path.name)
    log.warning("%s is not valid and was moved to %s; its realisations will run again", path.name, folder)
    journal.write("quarantine", segment=path.name, reason=reason)


def _check_origin(path: Path, attributes: Mapping[str, Any], physics_hash: str) -> None:
    if attributes.get("physics_hash") != physics_hash:
        raise FolderMismatch(f"{path}: holds rows of another study; choose another folder, or discard with --fresh")
    if attributes.get("source_hash") != results.source_hash():
        raise FolderMismatch(
            f"{path.parents[1]}: its results were made by another version of the program "
            f"({attributes.get('rfmpm_version')}, sources {str(attributes.get('source_hash'))[:12]}; "
            f"here {results.source_hash()[:12]}); use that version, discard them with --fresh, or choose another "
            "folder with --out"
        )
