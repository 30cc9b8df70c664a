"""The notice board of a campaign: keeps status.json up to date while the run lives."""

import logging
import os
import platform
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rfmpm import campaign_status

log = logging.getLogger("rfmpm")

EVERY = 2.0  # seconds


class Board:
    """Writes status.json, at most every EVERY seconds; a file that cannot be written is no reason to stop.

    Args:
        directory: of the campaign.
        state_of: gives what the file says, but for times and who writes it.
    """

    def __init__(self, directory: Path, state_of: Callable[[], dict[str, Any]]):
        self.directory, self.state_of = directory, state_of
        self.started = campaign_status.now()
        self._last = -EVERY
        self._turn = threading.Lock()
        self._has_complained = False

    def renew(self) -> None:
        """Write if it is time to; from any thread or signal handler, and never waiting for another one."""
        if time.monotonic() - self._last < EVERY or not self._turn.acquire(blocking=False):
            return
        try:
            self._write(campaign_status.RUNNING, "")
        finally:
            self._turn.release()

    def close(self, state: str, reason: str = "") -> None:
        """Write how it ended.

        Args:
            state: a state of campaign_status.
            reason: why, if there is more to say.
        """
        with self._turn:
            self._write(state, reason)

    def _write(self, state: str, reason: str) -> None:
        self._last = time.monotonic()
        who = {"host": platform.node(), "pid": os.getpid()}
        when = {"started": self.started, "updated": campaign_status.now()}
        try:
            campaign_status.write(self.directory, {"state": state, "reason": reason, **self.state_of(), **who, **when})
        except OSError as error:
            if not self._has_complained:
                log.warning("%s cannot be written (%s)", campaign_status.STATUS_FILE, error.strerror)
            self._has_complained = True
