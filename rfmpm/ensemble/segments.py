"""Segments: immutable files of finished rows; the valid ones are the truth about a campaign."""

import logging
import os
import shutil
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import results
from rfmpm.ensemble.folder import QUARANTINE, SEGMENTS, FolderMismatch
from rfmpm.variables import FAILED, STATUS, active_variables

log = logging.getLogger("rfmpm")

ROWS = 4096
SECONDS = 20.0  # a worker that is killed takes so much of its work with it
Row = dict[str, Any]

_BLOCK = 2**26  # bytes of the rows that are merged at once
_PLACES = np.dtype([("realisation", "i8"), ("segment", "i4"), ("row", "i4"), ("status", "i1")])


class RowsDiffer(RuntimeError):
    """Two rows of one realisation that are not the same, which no campaign can produce."""


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
            What was written: at most one entry with the segment's name and its realisations.

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
        self.rows, self.counter, self.since = [], self.counter + 1, time.monotonic()
        return [written]


@dataclass(frozen=True)
class Segment:
    """A valid segment."""

    name: str
    origin: str  # machine and versions that computed its rows
    is_whole: bool  # whether its rows have all that the study asks for


@dataclass(frozen=True)
class Finished:
    """Which realisations have a row and where it lies; 17 bytes each, the rows themselves stay on the disk."""

    segments: tuple[Segment, ...]
    places: np.ndarray  # one for each realisation on record, sorted; also of rows that lack what the study asks for

    @cached_property
    def _whole(self) -> np.ndarray:
        is_whole = np.array([segment.is_whole for segment in self.segments], bool)
        return self.places[is_whole[self.places["segment"]]]

    @cached_property
    def indices(self) -> np.ndarray:
        """Finished realisations, sorted, shape (n,)."""
        return np.ascontiguousarray(self._whole["realisation"])

    @cached_property
    def status(self) -> np.ndarray:
        """Code of STATUS of each of `indices`, shape (n,)."""
        return np.ascontiguousarray(self._whole["status"])

    @property
    def count(self) -> int:
        """Number of finished realisations."""
        return len(self.indices)

    @property
    def failed(self) -> int:
        """How many of them failed."""
        return int(np.isin(self.status, [STATUS[name] for name in FAILED]).sum())

    def between(self, first: int, stop: int) -> np.ndarray:
        """Places of the finished realisations from `first` up to `stop`, sorted."""
        return self._whole[np.searchsorted(self.indices, first) : np.searchsorted(self.indices, stop)]


NOTHING = Finished((), np.empty(0, _PLACES))


def finished(directory: Path, study, journal, earlier: Finished = NOTHING) -> Finished:
    """Find out which realisations have a valid row; a segment that is not valid counts as if it were not there.

    Rows without the surface that the study asks for, or with other bins, are no finished ones: they run again.

    Args:
        directory: of the campaign.
        study: the study that is run.
        journal: where a damaged segment is noted, which goes to quarantine; None leaves it where it is.
        earlier: what the same function found before; only segments that are new since are read.

    Returns:
        The finished realisations.

    Raises:
        FolderMismatch: if the rows were made by another study or another version of the sources.
        RowsDiffer: if two rows of one realisation are not the same.
    """
    known, physics_hash = {segment.name for segment in earlier.segments}, study.physics_hash
    segments, places = list(earlier.segments), [earlier.places]
    for path in sorted((Path(directory) / SEGMENTS).glob(f"*{results.ROWS_SUFFIX}")):
        if path.name in known or (stored := _valid(path, journal)) is None:
            continue
        _check_origin(path, stored.attributes, physics_hash)
        found = np.empty(len(stored.columns["realisation"]), _PLACES)
        found["realisation"], found["status"] = stored.columns["realisation"], stored.columns["status"]
        found["segment"], found["row"] = len(segments), np.arange(len(found))
        segments.append(Segment(path.name, _origin(stored.attributes), _is_whole(stored.attributes, study)))
        places.append(found)
    return Finished(tuple(segments), _one_each(Path(directory), tuple(segments), np.concatenate(places)))


def merge(
    directory: Path,
    study,
    journal,
    total: int,
    path: Path,
    attributes: Mapping[str, Any],
    first: int = 0,
    known: Finished = NOTHING,
) -> str:
    """Write the finished rows as one dataset, in bounded memory.

    Args:
        directory: of the campaign.
        study: the study that is run.
        journal: as for `finished`.
        total: realisations up to this one are taken, itself not included.
        path: the file to be written.
        attributes: further global attributes.
        first: the first realisation that is taken.
        known: what `finished` found before.

    Returns:
        Hash of the content.

    Raises:
        ValueError: if a realisation has no row.
        OSError: if the file cannot be written.
        FolderMismatch, RowsDiffer: as `finished`.
    """
    found = finished(directory, study, journal, known)
    places = found.between(first, total)
    if len(places) < total - first:
        raise ValueError(f"{directory}: {total - first - len(places)} of {total - first} realisations have no row")
    used = np.unique(places["segment"])
    origins = sorted({found.segments[segment].origin for segment in used})
    lines = "\n".join(f"{number}: {origin}" for number, origin in enumerate(origins))
    names = ["realisation", "level", "attempt", *(variable.name for variable in active_variables(study))]
    blocks = _blocks(Path(directory), found, places, origins, names)
    return results.write_ensemble(path, study, len(places), blocks, {**attributes, "origins": lines})


def _blocks(directory: Path, found: Finished, places: np.ndarray, origins, names) -> Iterator[results.Columns]:
    """Gather rows that follow each other from the segments they are scattered over."""
    start, step = 0, 1
    while start < len(places):
        block = places[start : start + step]
        taken = {"origin": np.empty(len(block), "i4")}
        for number in np.unique(block["segment"]):
            segment = found.segments[number]
            stored = _read(directory, segment).columns
            at = np.flatnonzero(block["segment"] == number)
            taken["origin"][at] = origins.index(segment.origin)
            for name in names:
                values = stored[name][block["row"][at]]
                taken.setdefault(name, np.empty((len(block), *values.shape[1:]), values.dtype))[at] = values
        yield taken
        start += len(block)
        step = max(1, _BLOCK // sum(values.nbytes // len(block) for values in taken.values()))


def _one_each(directory: Path, segments: tuple[Segment, ...], places: np.ndarray) -> np.ndarray:
    """Sort by realisation and keep one row each: a whole one before another, then that of the segment found first."""
    is_whole = np.array([segment.is_whole for segment in segments], bool)
    places = places[np.lexsort((places["segment"], ~is_whole[places["segment"]], places["realisation"]))]
    is_repeat = np.concatenate([[False], places["realisation"][1:] == places["realisation"][:-1]])[: len(places)]
    repeats = np.flatnonzero(is_repeat)
    if len(repeats):
        kept = np.flatnonzero(~is_repeat)[np.cumsum(~is_repeat)[repeats] - 1]
        pairs, group = np.unique(places["segment"][[kept, repeats]], axis=1, return_inverse=True)
        order = np.argsort(group.ravel(), kind="stable")
        of_pairs = np.split(order, np.searchsorted(group.ravel()[order], np.arange(1, pairs.shape[1])))
        for pair, at in zip(pairs.T, of_pairs, strict=True):
            _compare(directory, [segments[number] for number in pair], places[kept[at]], places[repeats[at]])
    return places[~is_repeat]


def _compare(directory: Path, pair: list[Segment], left: np.ndarray, right: np.ndarray) -> None:
    rows = zip((_read(directory, segment) for segment in pair), (left["row"], right["row"]), strict=True)
    first, second = ({name: values[at] for name, values in stored.columns.items()} for stored, at in rows)
    for name, is_different in results.differences(first, second).items():
        at = int(np.argmax(is_different))
        raise RowsDiffer(
            f"realisation {left['realisation'][at]} has two different rows: {name} is {first[name][at]} in "
            f"{pair[0].name} and {second[name][at]} in {pair[1].name}, both in {directory / SEGMENTS}"
        )


def _read(directory: Path, segment: Segment) -> results.StoredRows:
    return results.read_rows(directory / SEGMENTS / segment.name)


def _origin(attributes: Mapping[str, Any]) -> str:
    return f"{attributes['host']}; rfmpm {attributes['rfmpm_version']}, {attributes['library_versions']}"


def _is_whole(attributes: Mapping[str, Any], study) -> bool:
    asked = study.output.surface_bin_m
    return asked is None or attributes.get("surface_bin_m") == asked


def _valid(path: Path, journal) -> results.StoredRows | None:
    try:
        return results.read_rows(path)
    except results.UnreadableRows as error:
        if journal is not None:
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
            f"here {results.source_hash()[:12]}); discard them with --fresh, or choose another folder with --out"
        )
