"""The lock of a folder: two runs never share one, on one host or on several.

The lock of the system is what counts where there is one; it ends with its process. Where it is missing, or may not
reach to the other host, the file of the lock names the holder and the other run looks whether status.json goes on
changing. No clock of two hosts is compared, and a clock that was set back changes nothing.
"""

import json
import logging
import os
import platform
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rfmpm.campaign_status import STATUS_FILE

log = logging.getLogger("rfmpm")

LOCK_FILE = ".lock"
LOOK_FOR = 10.0  # seconds; several times the interval in which a run renews status.json
SETTLE = 1.0  # seconds after which the last of two that began at once has written its name


class InUse(RuntimeError):
    """Another run holds the lock; says who."""


@contextmanager
def locked(directory: Path, started: str) -> Iterator[None]:
    """Hold the lock of a folder while the body runs.

    Args:
        directory: the folder.
        started: when this run began, for whoever is refused.

    Raises:
        InUse: if another run holds it.
        OSError: if the folder cannot be written.
    """
    descriptor = os.open(directory / LOCK_FILE, os.O_RDWR | os.O_CREAT, 0o666)
    holder = _content(descriptor)
    me = {"host": platform.node(), "pid": os.getpid(), "started": started}
    try:
        is_sure = _lock(descriptor, holder)
        if holder and (not is_sure or holder.get("host") != me["host"]):
            _look_for_life(directory, holder)
        _write(descriptor, me)
        if not is_sure:
            time.sleep(SETTLE)
            if _content(descriptor) != me:
                raise InUse(_who(_content(descriptor)))
        try:
            yield
        finally:
            os.ftruncate(descriptor, 0)
    finally:
        os.close(descriptor)


def _lock(descriptor: int, holder: dict[str, Any]) -> bool:
    # The lock belongs to the process and the workers it forked; the system releases it when the last of them ends.
    try:
        import fcntl
    except ImportError:  # no such locks on this system
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InUse(_who(holder)) from None
    except OSError as error:
        log.warning("this file system has no locks (%s)", error.strerror)
        return False
    return True


def _look_for_life(directory: Path, holder: dict[str, Any]) -> None:
    log.warning("%s: last used by %s, which did not end cleanly; looking for signs of life", directory, _who(holder))
    before = _status(directory)
    end = time.monotonic() + LOOK_FOR
    while time.monotonic() < end:
        time.sleep(0.05 * LOOK_FOR)
        if _status(directory) != before:
            raise InUse(_who(holder))


def _status(directory: Path) -> bytes:
    try:
        return (directory / STATUS_FILE).read_bytes()
    except OSError:
        return b""


def _content(descriptor: int) -> dict[str, Any]:
    try:
        found = json.loads(os.pread(descriptor, 4096, 0))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def _write(descriptor: int, content: dict[str, Any]) -> None:
    os.ftruncate(descriptor, 0)
    os.pwrite(descriptor, json.dumps(content).encode(), 0)


def _who(holder: dict[str, Any]) -> str:
    if not holder:
        return "a run that has just begun"
    return f"process {holder.get('pid')} on {holder.get('host')}, started {holder.get('started')}"
