"""Reads the files of measured values, from which a distribution takes its shape, into the study itself."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rfmpm.columns import ColumnsError, read_columns
from rfmpm.study.errors import Problem

HEADERS = {"value": ("value", "value_kpa", "value_deg")}


def read_sample_files(tables: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Replace the `sample_file` of every random field by its content, as `sample`.

    Args:
        tables: of the study file; not changed.
        folder: to which the names of files are relative.

    Returns:
        the tables without `sample_file`, and what is wrong with the files.
    """
    problems: list[str] = []
    fields = tables.get("random_field")
    if not isinstance(fields, Mapping):
        return dict(tables), problems
    changed = {}
    for variable, entry in fields.items():
        changed[variable] = entry
        if isinstance(entry, Mapping) and isinstance(entry.get("sample_file"), str):
            changed[variable] = {key: value for key, value in entry.items() if key != "sample_file"}
            values, wrong = _sample(folder / entry["sample_file"], entry)
            if not wrong:
                changed[variable]["sample"] = values
            path = ("random_field", str(variable), "sample_file")
            problems += [str(Problem(path, text, entry["sample_file"])) for text in wrong]
    return {**tables, "random_field": changed}, problems


def _sample(path: Path, entry: Mapping[str, Any]) -> tuple[list[float], list[str]]:
    """The values, and what is wrong."""
    if "sample" in entry:
        return [], ["cannot be given together with sample"]
    try:
        columns = read_columns(path, HEADERS)
    except ColumnsError as error:
        return [], error.problems
    except OSError as error:
        return [], [f"cannot be read: {error.strerror}"]
    wrong = [
        f"line {line}: value = {value:g}: must be greater than 0"
        for line, value in zip(columns.lines, columns["value"], strict=True)
        if value <= 0.0
    ]
    return columns["value"], wrong
