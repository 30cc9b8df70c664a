"""The folder of a campaign: whose it is, what is thrown away in it, and the main log."""

import logging
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from rfmpm.campaign_status import SEGMENTS, STATUS_FILE, STUDY_FILE, name_while_written, now, replace_text
from rfmpm.ensemble.journal import JOURNAL_FILE, Journal
from rfmpm.ensemble.lock import LOCK_FILE, InUse, locked
from rfmpm.results import ENSEMBLE_FILE
from rfmpm.study import StudyError, load_study
from rfmpm.study.study import NOT_PHYSICS

log = logging.getLogger("rfmpm")

LOG_FILE = "rfmpm.log"
STOP_FILE = "STOP"
QUARANTINE, WORK, RUNNING, LOGS = "quarantine", "work", "running", "logs"
RESULTS = (
    *(SEGMENTS, QUARANTINE, WORK, RUNNING, LOGS),
    *(ENSEMBLE_FILE, STATUS_FILE, "report.html", "report.json", "snapshots"),
)


class FolderMismatch(ValueError):
    """A folder that cannot take this campaign: another study's, another version's, foreign, in use, not writable."""


@contextmanager
def opened(directory: Path, study, fresh: bool) -> Iterator[Journal]:
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
    with ExitStack() as held:
        try:
            (directory / SEGMENTS).mkdir(parents=True, exist_ok=True)
            held.enter_context(locked(directory, now()))
            check_owner(directory, study, fresh)  # again: a run that began at the same time may have ended since
            if fresh:
                _discard(directory)
            _sweep(directory)
            replace_text(directory / STUDY_FILE, study.to_toml())
            held.enter_context(_log_file(directory / LOG_FILE))
        except InUse as error:
            raise FolderMismatch(f"{directory}: another run is using this folder: {error}") from error
        except OSError as error:
            raise FolderMismatch(
                f"{directory}: cannot be written ({error.strerror}); choose another folder with --out"
            ) from error
        yield Journal(directory / JOURNAL_FILE)


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
    begun = {SEGMENTS, RUNNING, LOCK_FILE, STOP_FILE, name_while_written(STUDY_FILE)}
    if names <= begun and not any(directory.glob(f"{SEGMENTS}/*")):
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


def take_stop_file(directory: Path) -> bool:
    """Remove the file that asked an earlier run for its end; tells whether there was one."""
    path = directory / STOP_FILE
    was_there = path.exists()
    path.unlink(missing_ok=True)
    return was_there


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
    other = tuple(".".join(path) + "." for path in NOT_PHYSICS)
    return [
        f"{key}: {left.get(key, absent)} -> {right.get(key, absent)}"
        for key in {**left, **right}
        if not f"{key}.".startswith(other) and left.get(key, absent) != right.get(key, absent)
    ]


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict | list | tuple):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _flat(inner, f"{path}.{key}" if path else str(key))
    else:
        yield path, value


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
