"""The journal of a campaign: what happened to it; it informs, the segments are the truth."""

import json
import logging
import os
from collections import Counter
from pathlib import Path
from typing import Any

from rfmpm.campaign_status import now
from rfmpm.ensemble import codes

log = logging.getLogger("rfmpm")

JOURNAL_FILE = "journal.jsonl"


class Journal:
    """One JSON object a line.

    Args:
        path: the file.
    """

    def __init__(self, path: Path):
        self.path = path

    def write(self, event: str, **details: Any) -> None:
        """Append one event.

        Args:
            event: its name.
            details: whatever belongs to it.
        """
        line = json.dumps({"time": now(), "event": event, **details}).encode()
        with self.path.open("ab+") as file:
            if file.tell():
                file.seek(-1, os.SEEK_END)
                if file.read() != b"\n":  # a line that a kill has torn does not take this one with it
                    file.write(b"\n")
            file.write(line + b"\n")
        log.info("%s %s", event, " ".join(f"{name}={value}" for name, value in details.items()))

    def events(self, *names: str) -> list[dict[str, Any]]:
        """Read events since the results were last discarded; a torn line is passed over.

        Args:
            names: of the events; all if none is given. The others are not held in memory.

        Returns:
            The events, oldest first.
        """
        if not self.path.is_file():
            return []
        found = []
        with self.path.open(encoding="utf-8", errors="replace") as lines:
            for line in lines:
                try:
                    event = json.loads(line)
                except json.JSONDecodeError:
                    continue
                if event.get("event") == "start" and event.get("fresh"):
                    found.clear()
                if not names or event["event"] in names:
                    found.append(event)
        return found

    def started(self) -> str:
        """When the campaign was first started, ISO 8601."""
        return self.events("start")[0]["time"]

    def ended(self) -> str:
        """When the last rows were written, ISO 8601."""
        written = [
            event.get("end", event["time"])
            for event in self.events("segment", "start")
            if event["event"] == "segment" or "end" in event
        ]
        return written[-1] if written else self.started()

    def unfinished_starts(self) -> Counter[int]:
        """Count, by code, the starts that came to no end because the worker, or the whole job, died."""
        starts = {
            (codes.of_entry(event), event.get("host"), event.get("pid"), event.get("started"))
            for event in self.events("unfinished_start")
        }
        return Counter(code for code, *_ in starts)
