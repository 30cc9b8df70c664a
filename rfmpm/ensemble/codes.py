"""One whole number for each (level, realisation) of a campaign; those of level 0 are the indices themselves."""

from collections.abc import Mapping
from typing import Any

import numpy as np

LEVEL = 2**40  # more than any campaign has realisations


def split(code: int) -> tuple[int, int]:
    """Level and index of the realisation that a code stands for."""
    return divmod(int(code), LEVEL)


def codes_of(level: int, indices: range) -> range:
    """Codes of realisations on a level."""
    return range(level * LEVEL + indices.start, level * LEVEL + indices.stop)


def encoded(level: Any, realisation: Any) -> np.ndarray:
    """Codes of levels and indices, both of shape (n,)."""
    return np.asarray(level, np.int64) * LEVEL + np.asarray(realisation, np.int64)


def in_words(code: int) -> str:
    """Name what a code stands for: "realisation 7", "realisation 7 on level 1"."""
    level, index = split(code)
    return f"realisation {index}" + (f" on level {level}" if level else "")


def as_entry(code: int | None) -> dict[str, int | None]:
    """What a file says of it: "realisation", and "level" where it is not 0."""
    if code is None:
        return {"realisation": None}
    level, index = split(code)
    return {"realisation": index, "level": level} if level else {"realisation": index}


def of_entry(entry: Mapping[str, Any]) -> int:
    """The code that `as_entry` has made an entry of."""
    return int(entry.get("level", 0)) * LEVEL + int(entry["realisation"])
