"""The standard-normal vector `xi` of one realisation as a file: NumPy's .npy, which keeps every bit."""

from pathlib import Path

import numpy as np


def write_xi(path: Path, xi: np.ndarray) -> None:
    """Write a vector, shape (n,) [-]; OSError if the file cannot be written."""
    with open(path, "wb") as file:
        np.save(file, np.asarray(xi, dtype=np.float64), allow_pickle=False)


def read_xi(path: Path, count: int) -> np.ndarray:
    """Read a vector that `write_xi` wrote.

    Args:
        path: the file.
        count: length that the study's fields take.

    Returns:
        `xi`, shape (count,) [-].

    Raises:
        OSError: if there is no such file, or it cannot be read.
        ValueError: if the file is none of these, or holds another number of values or some that are not finite.
    """
    try:
        with open(path, "rb") as file:
            xi = np.load(file, allow_pickle=False)
    except (ValueError, EOFError):
        text = "is not a NumPy file (.npy) with numbers; `rfmpm field STUDY --write-xi FILE` writes one"
        raise ValueError(f"{path}: {text}") from None
    if not isinstance(xi, np.ndarray) or xi.dtype != np.float64 or xi.shape != (count,):
        found = f"{xi.dtype} of shape {xi.shape}" if isinstance(xi, np.ndarray) else "several arrays"
        raise ValueError(f"{path}: holds {found}; this study's fields take {count} numbers (float64, shape ({count},))")
    if not np.all(np.isfinite(xi)):
        raise ValueError(f"{path}: holds values that are not finite")
    return xi
