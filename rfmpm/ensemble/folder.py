"""The folder of a campaign: whose it is, the lock, the journal and the log."""

import json
import logging
import os
import shutil
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rfmpm.results import ENSEMBLE_FILE
from rfmpm.study import StudyError, load_study
from rfmpm.study.study import NOT_PHYSICS

log = logging.getLogger("rfmpm")

STUDY_FILE = "study.toml"
JOURNAL_FILE = "journal.jsonl"
LOG_FILE = "rfmpm.log"
LOCK_FILE = ".lock"
SEGMENTS, QUARANTINE, WORK = "segments", "quarantine", "work"
RESULTS = (SEGMENTS, QUARANTINE, WORK, ENSEMBLE_FILE, "report.html", "report.json", "snapshots")


class FolderMismatch(ValueError):
    """A folder that cannot take this campaign: another study's, another version's, foreign, in use, not writable."""


def now() -> str:
    """The time, ISO 8601 with its offset from UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


@contextmanager
def opened(directory: Path, study, fresh: bool) -> Iterator["Journal"]:
    """Take a folder for a campaign: check whose it is before anything is changed, lock it, open log and journal.

    Args:
        directory: the folder; made if missing.
        study: the study to be run.
        fresh: throw away the results that the folder holds, of whatever study.

    Yields:
        The journal.

    Raises:
        FolderMismatch: if the folder cannot take this campaign.
    """
    check_owner(directory, study, fresh)
    try:
        (directory / SEGMENTS).mkdir(parents=True, exist_ok=True)
        lock = os.open(directory / LOCK_FILE, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise FolderMismatch(f"{directory}: cannot be written ({error})") from error
    try:
        _lock(lock, directory)
        if fresh:
            _discard(directory)
        _sweep(directory)
        _replace_text(directory / STUDY_FILE, study.to_toml())
        with _log_file(directory / LOG_FILE):
            yield Journal(directory / JOURNAL_FILE)
    finally:
        os.close(lock)


def check_owner(directory: Path, study, fresh: bool) -> None:
    """Refuse a folder that holds something else than this study's results; reads only.

    Args:
        directory: the folder; it need not exist.
        study: the study to be run.
        fresh: accept the results of another study.

    Raises:
        FolderMismatch: naming the keys that differ, "path: there -> here".
    """
    if directory.exists() and not directory.is_dir():
        raise FolderMismatch(f"{directory}: is not a folder")
    if not directory.is_dir() or not (names := {path.name for path in directory.iterdir()}):
        return
    if names <= {SEGMENTS, LOCK_FILE, _temporary(STUDY_FILE)} and not any(directory.glob(f"{SEGMENTS}/*")):
        return  # a run that was killed as it began
    try:
        there = load_study(directory / STUDY_FILE)
    except (OSError, StudyError) as error:
        raise FolderMismatch(
            f"{directory}: is not empty and holds no readable {STUDY_FILE} of a campaign; choose another folder"
        ) from error
    if not fresh and there.physics_hash != study.physics_hash:
        raise FolderMismatch(
            f"{directory}: holds results of another study; choose another folder, or discard them with --fresh\n  "
            + "\n  ".join(differences(there, study))
        )


def differences(there, here) -> list[str]:
    """List the keys in which two studies differ, with both values.

    Args:
        there: the study a folder holds.
        here: the study to be run.

    Returns:
        Lines "path: there -> here".
    """
    left, right = (dict(_flat(study.model_dump(exclude_none=True))) for study in (there, here))
    absent = "absent"
    other = {".".join(path) for path in NOT_PHYSICS}
    return [
        f"{key}: {left.get(key, absent)} -> {right.get(key, absent)}"
        for key in {**left, **right}
        if key not in other and left.get(key, absent) != right.get(key, absent)
    ]


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict | list | tuple):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _flat(inner, f"{path}.{key}" if path else str(key))
    else:
        yield path, value


def _temporary(name: str) -> str:
    return f".{name}.new"


def _replace_text(path: Path, text: str) -> None:
    temporary = path.with_name(_temporary(path.name))
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def _lock(descriptor: int, directory: Path) -> None:
    # The lock belongs to the process and the workers it forked; the system releases it when the last of them ends.
    try:
        import fcntl
    except ImportError:  # no such locks on this system
        return
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise FolderMismatch(f"{directory}: another run is using this folder") from None
    except OSError as error:
        log.warning("%s: cannot be locked (%s); do not start a second run in it", directory, error)


def _discard(directory: Path) -> None:
    for name in RESULTS:
        path = directory / name
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    (directory / SEGMENTS).mkdir()


def _sweep(directory: Path) -> None:
    """Remove the temporary files that a killed run left."""
    for path in [*directory.glob(f".{ENSEMBLE_FILE}.*"), *(directory / SEGMENTS).glob(".*")]:
        path.unlink(missing_ok=True)


@contextmanager
def _log_file(path: Path) -> Iterator[None]:
    handler = logging.FileHandler(path, encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    earlier = log.level
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.setLevel(earlier)
        log.removeHandler(handler)
        handler.close()


class Journal:
    """What happened to a campaign, one JSON object a line; it informs, the segments are the truth."""

    def __init__(self, path: Path):
        self.path = path

    def write(self, event: str, **details: Any) -> None:
        """Append one event.

        Args:
            event: its name.
            details: whatever belongs to it.
        """
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"time": now(), "event": event, **details}) + "\n")
        log.info("%s %s", event, " ".join(f"{name}={value}" for name, value in details.items()))

    def events(self) -> list[dict[str, Any]]:
        """Read the events since the results were last discarded; a torn line is passed over.

        Returns:
            The events, oldest first.
        """
        if not self.path.is_file():
            return []
        found = []
        for line in self.path.read_text(encoding="utf-8", errors="replace").splitlines():
            try:
                event = json.loads(line)
            except json.JSONDecodeError:
                continue
            if event.get("event") == "start" and event.get("fresh"):
                found.clear()
            found.append(event)
        return found

    def started(self) -> str:
        """When the campaign was first started, ISO 8601."""
        return next(event["time"] for event in self.events() if event["event"] == "start")

    def ended(self) -> str:
        """When the last rows were written, ISO 8601."""
        written = [event["time"] for event in self.events() if event["event"] == "segment"]
        return written[-1] if written else self.started()

    def fatal_starts(self) -> Counter[int]:
        """Count, for each realisation, the workers that died while they ran it."""
        return Counter(
            event["realisation"]
            for event in self.events()
            if event["event"] == "worker_lost" and event["realisation"] is not None
        )
