"""Markers: what each worker runs at the moment, so that the next start knows what was not finished."""

import json
import logging
import os
import platform
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.campaign_status import now, replace_text
from rfmpm.ensemble import codes
from rfmpm.ensemble.folder import RUNNING

log = logging.getLogger("rfmpm")


@dataclass(frozen=True)
class Task:
    """A realisation to be run, and the how manieth start of it this is, those that were never finished included."""

    code: int
    attempt: int = 1
    xi: np.ndarray | None = field(default=None, compare=False)  # None: drawn from the stream of the index

    @property
    def level(self) -> int:
        """On whose cells it is simulated: 0 for the study's own."""
        return codes.split(self.code)[0]

    @property
    def realisation(self) -> int:
        """Its index."""
        return codes.split(self.code)[1]


class Marker:
    """The file running/<rank>.json of one worker."""

    def __init__(self, directory: Path, rank: int):
        self.path = Path(directory) / RUNNING / f"{rank:05d}.json"

    def put(self, task: Task) -> None:
        """Say what is about to be run.

        Args:
            task: it.

        Raises:
            OSError: if it cannot be written.
        """
        content = {
            **codes.as_entry(task.code),
            "attempt": task.attempt,
            "started": now(),
            "host": platform.node(),
            "pid": os.getpid(),
        }
        replace_text(self.path, json.dumps(content))

    def remove(self) -> None:
        """Say that nothing is being run any more."""
        self.path.unlink(missing_ok=True)


def take_left_behind(directory: Path) -> list[dict[str, Any]]:
    """Read and remove the markers of workers that did not end cleanly; only while no worker runs.

    Args:
        directory: of the campaign.

    Returns:
        The contents of the markers, their rank included; one that was torn tells nothing and is named in the log.
    """
    found = []
    for path in sorted((Path(directory) / RUNNING).glob("*.json")):
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            found.append({**content, **codes.as_entry(codes.of_entry(content)), "rank": int(path.stem)})
        except (ValueError, KeyError, TypeError):
            log.warning("%s was torn: the start that it stood for is not counted", path)
        path.unlink()
    return found
