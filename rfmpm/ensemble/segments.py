"""Segments: immutable files of finished rows; the valid ones are the truth about a campaign."""

import logging
import os
import secrets
import shutil
import time
from pathlib import Path
from typing import Any

from rfmpm import results
from rfmpm.ensemble.folder import QUARANTINE, SEGMENTS, FolderMismatch

log = logging.getLogger("rfmpm")

ROWS = 16
SECONDS = 10.0
Row = dict[str, Any]


class RowsDiffer(RuntimeError):
    """Two rows of one realisation that are not the same, which no campaign can produce."""


class SegmentWriter:
    """Collects the rows of one worker and writes them as segments."""

    def __init__(self, directory: Path, study, rank: int):
        self.folder, self.study, self.rank = Path(directory) / SEGMENTS, study, rank
        self.rows: list[Row] = []
        self.counter = 0
        self.since = 0.0

    def add(self, row: Row) -> list[dict]:
        """Take a finished row; write a segment if enough rows or enough time have gathered.

        Args:
            row: of one realisation.

        Returns:
            What was written: at most one entry with the segment's name and its realisations.

        Raises:
            OSError: if the segment cannot be written.
        """
        if not self.rows:
            self.since = time.monotonic()
        self.rows.append(row)
        is_due = len(self.rows) >= ROWS or time.monotonic() - self.since >= SECONDS
        return self.flush() if is_due else []

    def flush(self) -> list[dict]:
        """Write the rows at hand, if there are any; returns and raises as `add`."""
        if not self.rows:
            return []
        name = f"{self.rank:05d}-{os.getpid()}-{self.counter:05d}-{secrets.token_hex(4)}.nc"
        results.write_rows(self.folder / name, self.rows, self.study)
        written = {"segment": name, "realisations": [int(row["realisation"]) for row in self.rows]}
        self.rows, self.counter = [], self.counter + 1
        return [written]


def read_all(directory: Path, study, journal) -> dict[int, Row]:
    """Read every valid segment of a folder; a file that is not valid goes to quarantine and its rows count as missing.

    Args:
        directory: of the campaign.
        study: the study that is run.
        journal: where a quarantined file is noted.

    Returns:
        Realisation -> row.

    Raises:
        FolderMismatch: if the rows were made by another study or another version of the sources.
        RowsDiffer: if two rows of one realisation are not the same.
    """
    rows: dict[int, Row] = {}
    for path in sorted((Path(directory) / SEGMENTS).glob("*.nc")):
        try:
            found, attributes = results.read_rows(path)
        except results.UnreadableRows as error:
            _quarantine(path, str(error), journal)
            continue
        _check_origin(path, attributes, study)
        for row in found:
            index = int(row["realisation"])
            if index in rows and not _is_same(rows[index], row, study):
                raise RowsDiffer(f"realisation {index} has two different rows; the second is in {path}")
            rows.setdefault(index, row)
    return rows


def _is_same(first: Row, second: Row, study) -> bool:
    return len({results.content_hash(results.dataset([row], study)) for row in (first, second)}) == 1


def _quarantine(path: Path, reason: str, journal) -> None:
    folder = path.parents[1] / QUARANTINE
    folder.mkdir(exist_ok=True)
    shutil.move(path, folder / path.name)
    log.warning("%s is not valid and was moved to %s; its realisations will run again", path.name, folder)
    journal.write("quarantine", segment=path.name, reason=reason)


def _check_origin(path: Path, attributes: dict, study) -> None:
    if attributes.get("physics_hash") != study.physics_hash:
        raise FolderMismatch(f"{path}: holds rows of another study; choose another folder, or discard with --fresh")
    if attributes.get("source_hash") != results.source_hash():
        raise FolderMismatch(
            f"{path.parents[1]}: its results were made by another version of the program "
            f"({attributes.get('rfmpm_version')}, sources {str(attributes.get('source_hash'))[:12]}; "
            f"here {results.source_hash()[:12]}); discard them with --fresh, or choose another folder with --out"
        )
