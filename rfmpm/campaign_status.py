"""How far a campaign is, for whoever sees its folder: the file status.json, and what may be said from it."""

import json
import os
import platform
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

STATUS_FILE = "status.json"
STUDY_FILE = "study.toml"
SEGMENTS = "segments"
RUNNING, STOPPED, COMPLETE, FAILED = "running", "stopped", "complete", "failed"
QUIET = 60.0  # seconds without news after which a campaign that says it runs is doubted


def now() -> str:
    """The time, ISO 8601 with its offset from UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def name_while_written(name: str) -> str:
    """Name that a file of `replace_text` has until it is whole."""
    return f".{name}.new"


def replace_text(path: Path, text: str) -> None:
    """Replace a small file at once, so that a reader never sees half of it; OSError if it cannot be written."""
    temporary = path.with_name(name_while_written(path.name))
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def write(directory: Path, content: Mapping[str, Any]) -> None:
    """Replace status.json.

    Args:
        directory: of the campaign.
        content: whatever it says.

    Raises:
        OSError: if it cannot be written.
    """
    replace_text(Path(directory) / STATUS_FILE, json.dumps(content, indent=1))


def read(directory: Path) -> dict[str, Any]:
    """Read status.json and add what this host can tell of it; nothing is changed.

    Args:
        directory: of the campaign.

    Returns:
        Its content, with "doubt": why a campaign that says it runs may not, or empty.

    Raises:
        FileNotFoundError: if there is none.
        ValueError: if it is not one of ours.
    """
    path = Path(directory) / STATUS_FILE
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        updated = datetime.fromisoformat(content["updated"])
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{path}: is not the status of a campaign ({error})") from error
    return {**content, "doubt": _doubt(content, updated) if content.get("state") == RUNNING else ""}


def _doubt(content: Mapping[str, Any], updated: datetime) -> str:
    if content.get("host") == platform.node() and not _is_alive(content.get("pid")):
        return f"its process {content.get('pid')} is gone; no sign of life since {content['updated']}"
    silent = (datetime.now(UTC) - updated).total_seconds()
    if silent > QUIET:
        return f"no sign of life since {content['updated']}, {silent:.0f} s ago by the clock of this host"
    return ""


def _is_alive(pid: Any) -> bool:
    try:
        os.kill(int(pid), 0)
    except (ProcessLookupError, TypeError, ValueError):
        return False
    except OSError:
        return True
    return True


def estimate_so_far(directory: Path, first: int = 0, total: int | None = None) -> dict[str, Any] | None:
    """Estimate P(run-out > limit) from what is finished without a gap in the indices.

    What is finished beyond a gap was finished because it was quick, and is no fair sample.

    Args:
        directory: of the campaign.
        first: index at which it begins.
        total: how many realisations it asks for; those that the folder has beyond them do not count.

    Returns:
        limit_m, value (None where every one failed), lower, upper, confidence and n; None if nothing is finished
        without a gap.
    """
    directory = Path(directory)
    paths = sorted((directory / SEGMENTS).glob("*.rows"))
    if not paths or not (columns := list(_columns(paths))):
        return None
    import numpy as np

    index, run_out, censored = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    index, place = np.unique(index, return_index=True)
    index, place = index[index >= first], place[index >= first]
    n = int(np.sum(index[:total] == first + np.arange(index[:total].size)))
    if n == 0:
        return None
    from rfmpm.estimators import exceedance

    limit = float(tomllib.loads((directory / STUDY_FILE).read_text("utf-8"))["quantities"]["run_out_limit_m"])
    found = exceedance(run_out[place][:n], limit, censored[place][:n])
    names = ("lower", "upper", "confidence", "n")
    value = None if np.isnan(found.value) else found.value  # JSON has no NaN
    return {"limit_m": limit, "value": value, **{name: getattr(found, name) for name in names}}


def _columns(paths: Iterable[Path]) -> Iterator[tuple]:
    """Index, run-out (NaN where it failed) and whether that is a lower bound, of every readable file of rows."""
    from rfmpm.results.row_files import UnreadableRows, read_rows

    for path in paths:
        try:
            columns = read_rows(path).columns
        except (OSError, UnreadableRows):  # torn, or put aside this moment
            continue
        # copies: a column as it was read keeps the whole file, surfaces included, in memory
        yield columns["realisation"].copy(), columns["run_out"].copy(), columns["run_out_censored"] == 1
