"""Rows as columns, and the files of them that a campaign writes while it runs.

A campaign writes many small files of rows, and reads all of them when it is continued; a NetCDF file of 16 rows takes a
hundred times as long to write and to read as these, and twenty times the room. The layout: one line of JSON, padded
to a multiple of 64 bytes, says the attributes, the texts and the columns; the columns follow, one after the other, in
little-endian bytes. The end of the file's name is the hash of its bytes, so that no flipped bit goes unnoticed.
"""

import contextlib
import hashlib
import json
import os
import secrets
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.variables import RUN_DEPENDENT, Variable, active_variables

ROWS_SUFFIX = ".rows"
_LAYOUT = "rfmpm rows 1"
_ALIGNMENT = 64  # bytes
_DIGITS = 16  # of the hash in the name
_TYPES = {
    "realisation": "<i8",
    "level": "<i4",
    "attempt": "<i4",
    "status": "<i1",
}  # all others are floats, NaN where missing

Columns = dict[str, np.ndarray]


class UnreadableRows(ValueError):
    """A file of rows that is torn, altered or not one of ours."""


@dataclass(frozen=True)
class StoredRows:
    """What a file of rows holds."""

    columns: Columns  # by name; the first axis runs over the rows
    attributes: dict[str, Any]


def columns(rows: Sequence[Mapping[str, Any]], study) -> Columns:
    """Turn rows into columns, sorted by level and realisation.

    Args:
        rows: one mapping per realisation with every active variable by name, "realisation" and optionally "level" and
            "attempt".
        study: the study they belong to.

    Returns:
        Column by name, shape (n,), surfaces (n, bins); floats with NaN where a value is missing, texts as objects.

    Raises:
        KeyError: if a row lacks an active variable.
        ValueError: if a surface has another number of bins than the domain.
    """
    rows = sorted(rows, key=lambda row: (int(row.get("level", 0)), int(row["realisation"])))
    found = {
        "realisation": np.array([row["realisation"] for row in rows], _TYPES["realisation"]),
        "level": np.array([row.get("level", 0) for row in rows], _TYPES["level"]),
        "attempt": np.array([row.get("attempt", 1) for row in rows], _TYPES["attempt"]),
    }
    for variable in active_variables(study):
        values = [row[variable.name] for row in rows]
        is_wide = len(variable.dims) > 1
        found[variable.name] = _wide(variable, values, study) if is_wide else _column(variable, values)
    return found


def _column(variable: Variable, values: list) -> np.ndarray:
    if variable.dtype == "str":
        return np.array([str(value) for value in values], dtype=object)
    return np.array(values, _TYPES.get(variable.name, "<f8"))


def _wide(variable: Variable, values: list, study) -> np.ndarray:
    count = len(labels_along(variable.dims[1], study))
    return np.array([np.broadcast_to(np.asarray(value, "<f8"), count) for value in values]).reshape(-1, count)


def labels_along(dimension: str, study) -> np.ndarray:
    """Give the labels of what a row holds several of, shape (k,): bins along `x` [m], keys along `uncertain`."""
    if dimension == "x":
        return bin_positions(study)
    return np.array([entry.key for entry in study.uncertain], dtype=object)


def bin_positions(study) -> np.ndarray:
    """Give the centres of the bins of the final surface, shape (bins,) [m]."""
    from rfmpm.mpm.scene import domain_size
    from rfmpm.quantities.surface import bin_centres

    return bin_centres(domain_size(study)[0], study.output.surface_bin_m)


def write_rows(folder: Path, stem: str, given: Columns, attributes: Mapping[str, Any]) -> Path:
    """Write rows to a new file that survives a crash from the moment it has its name.

    Args:
        folder: that gets the file.
        stem: start of its name.
        given: the columns, as `columns` makes them.
        attributes: texts and numbers that belong to all rows.

    Returns:
        The file.

    Raises:
        OSError: if the file cannot be written.
    """
    content = _encoded(given, attributes)
    path = Path(folder) / f"{stem}-{_hash(content)}{ROWS_SUFFIX}"
    with whole_file(path) as temporary:
        temporary.write_bytes(content)
    return path


def _encoded(given: Columns, attributes: Mapping[str, Any]) -> bytes:
    texts = {name: list(values) for name, values in given.items() if values.dtype == object}
    numbers = {name: np.ascontiguousarray(values) for name, values in given.items() if values.dtype != object}
    header = {
        "layout": _LAYOUT,
        "attributes": dict(attributes),
        "texts": texts,
        "columns": [[name, values.dtype.str, list(values.shape)] for name, values in numbers.items()],
    }
    line = json.dumps(header, separators=(",", ":")).encode()
    padding = b" " * (-(len(line) + 1) % _ALIGNMENT)
    return b"".join([line, padding, b"\n", *(values.tobytes() for values in numbers.values())])


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:_DIGITS]


def read_rows(path: Path) -> StoredRows:
    """Read a file of `write_rows` and check it against the hash in its name.

    Args:
        path: the file.

    Returns:
        Its rows.

    Raises:
        UnreadableRows: if the file is torn, altered or not one of ours.
        OSError: if it cannot be read at all.
    """
    content = Path(path).read_bytes()
    if _hash(content) != path.stem.rpartition("-")[2]:
        raise UnreadableRows(f"{path}: its content does not match the hash in its name")
    line, _, _ = content.partition(b"\n")
    try:
        header = json.loads(line)
        found = {name: np.array(texts, dtype=object) for name, texts in header["texts"].items()}
        start = len(line) + 1
        for name, kind, shape in header["columns"]:
            count = int(np.prod(shape))
            found[name] = np.frombuffer(content, kind, count, start).reshape(shape)
            start += found[name].nbytes
        return StoredRows(found, header["attributes"])
    except (ValueError, KeyError, TypeError) as error:  # intact, and yet not ours
        raise UnreadableRows(f"{path}: {type(error).__name__}: {error}") from error


def copy_rows(path: Path, folder: Path) -> None:
    """Copy a file of rows; nothing happens if the folder has it.

    Args:
        path: the file.
        folder: that gets the copy, under the same name.

    Raises:
        UnreadableRows: if the file is torn or altered.
        OSError: if it cannot be read or the copy not be written.
    """
    if not (folder / path.name).exists():
        read_rows(path)
        with whole_file(folder / path.name) as temporary:
            shutil.copyfile(path, temporary)


def differences(first: Columns, second: Columns) -> dict[str, np.ndarray]:
    """Compare rows bit for bit, what depends on the run left out, and surfaces where both have the same bins.

    Args:
        first: columns of n rows.
        second: columns of n rows.

    Returns:
        For each column that differs, where it does, shape (n,); in the order of the names.
    """
    found = {}
    for name in sorted(first.keys() & second.keys() - RUN_DEPENDENT):
        left, right = first[name], second[name]
        if left.shape != right.shape:
            continue
        is_different = ~_is_same(left, right)
        if is_different.any():
            found[name] = is_different.any(axis=tuple(range(1, is_different.ndim)))
    return found


def _is_same(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    if left.dtype.kind != "f":
        return left == right
    bits = left.view("u8") == right.view("u8")  # minus zero is not zero
    return bits | (np.isnan(left) & np.isnan(right))


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Let a file appear whole or not at all: temporary name in its folder, flushed to the disk, then renamed.

    Args:
        path: the file; replaced if it exists.

    Yields:
        The temporary name, to be written by the body.

    Raises:
        OSError: if the file cannot be written; the old one, if there was one, is as before.
    """
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    try:
        yield temporary
        flush_to_disk(temporary)
        os.replace(temporary, path)
    except OSError as error:
        if error.filename is None and error.errno is not None:  # a write says what, but not where
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
    finally:
        temporary.unlink(missing_ok=True)
    flush_to_disk(path.parent)


def flush_to_disk(path: Path) -> None:
    """Wait until a file, or a folder's list of names, is on the disk; folders where the system allows it.

    Args:
        path: the file or folder.
    """
    with contextlib.suppress(PermissionError) if path.is_dir() else contextlib.nullcontext():
        descriptor = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
