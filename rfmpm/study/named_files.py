"""Replaces the files that random fields of a study name by what they hold, so that a study stands by itself."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rfmpm.columns import ColumnsError
from rfmpm.study.data_file import read_data
from rfmpm.study.errors import Problem
from rfmpm.study.sample_file import read_sample

Read = Callable[[Path, Mapping[str, Any]], list[Any]]  # path, table of the field -> content
CONTENT: dict[str, tuple[str, Read]] = {"data_file": ("data", read_data), "sample_file": ("sample", read_sample)}


def read_named_files(tables: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Replace the keys of `CONTENT` in every random field by what the files hold.

    Args:
        tables: of the study file; not changed.
        folder: to which the names of files are relative.

    Returns:
        the tables without names of files, and what is wrong with the files, with the lines.
    """
    problems: list[str] = []
    fields = tables.get("random_field")
    if not isinstance(fields, Mapping):
        return dict(tables), problems
    changed = dict(fields)
    for variable, entry in fields.items():
        for key, (content, read) in CONTENT.items():
            if not isinstance(entry, Mapping) or not isinstance(entry.get(key), str):
                continue
            own = {name: value for name, value in changed[variable].items() if name != key}
            found, wrong = _content(folder / entry[key], entry, content, read)
            changed[variable] = own if wrong else own | {content: found}
            problems += [str(Problem(("random_field", str(variable), key), text, entry[key])) for text in wrong]
    return {**tables, "random_field": changed}, problems


def _content(path: Path, entry: Mapping[str, Any], content: str, read: Read) -> tuple[list[Any], list[str]]:
    """What the file holds, and what is wrong."""
    if content in entry:
        return [], [f"cannot be given together with {content}"]
    try:
        return read(path, entry), []
    except ColumnsError as error:
        return [], list(error.problems)
    except OSError as error:
        return [], [f"cannot be read: {error.strerror}"]
