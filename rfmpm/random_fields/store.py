"""Keeps what a field method prepares in files, for other processes and later runs to read instead of making it."""

import hashlib
import os
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.methods import METHODS


def find_or_prepare(
    method: str, correlation: Correlation, points: np.ndarray, options: Mapping[str, float], folder: Path
) -> Any:
    """Read the record of a method from the folder, or prepare it and keep it there.

    The arrays of the record are mapped from their files, so processes on one machine share the memory. A damaged or
    foreign file is replaced. Files appear whole: written under another name, then renamed.

    Args:
        method: name in `METHODS`.
        correlation: correlation of the standard-normal field.
        points: positions, shape (n, 2) [m].
        options: what else its `prepare` takes, by name.
        folder: where the files are; made if missing.

    Returns:
        the record of the method.

    Raises:
        OSError: the folder cannot be written.
    """
    chosen = METHODS[method]
    folder = Path(folder)
    stem = f"{method}-{_fingerprint(method, correlation, points, options)}"
    files = {field: folder / f"{stem}.{field}.npy" for field in chosen.Record._fields}
    record = read(chosen.Record, files)
    if record is not None and chosen.is_intact(record, points):
        return record
    folder.mkdir(parents=True, exist_ok=True)
    fresh = chosen.prepare(correlation, points, **options)
    for field, path in files.items():
        write(path, getattr(fresh, field))
    return read(chosen.Record, files) or fresh


def _fingerprint(method: str, correlation: Correlation, points: np.ndarray, options: Mapping[str, float]) -> str:
    # Everything the bits of a record depend on, but the processor: records are best shared within one kind of machine.
    versions = [version(package) for package in ("rfmpm", "numpy", "scipy")]
    described = repr((method, dict(options), correlation, points.shape, points.dtype.str, versions))
    return hashlib.sha256(described.encode() + points.tobytes()).hexdigest()[:32]


def read(record: type[Any], files: dict[str, Path]) -> Any | None:
    """Read a record, its arrays mapped from the files of its fields; None where one is missing or damaged."""
    try:
        return record(*(np.asarray(np.load(path, mmap_mode="r")) for path in files.values()))
    except (FileNotFoundError, ValueError, EOFError):
        return None


def write(path: Path, array: np.ndarray) -> None:
    """Write an array so that its file appears whole; OSError if the folder cannot be written."""
    temporary = path.with_name(f"{path.stem}.{uuid4().hex}.tmp")
    try:
        with open(temporary, "xb") as file:
            np.save(file, array)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        raise OSError(f"{path.parent}: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)
