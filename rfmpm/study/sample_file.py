"""Reads measured values from which a distribution takes its shape."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rfmpm.columns import ColumnsError, read_columns

HEADERS = {"value": ("value", "value_kpa", "value_deg")}


def read_sample(path: Path, entry: Mapping[str, Any]) -> list[float]:
    """Read the sample of a random field.

    Args:
        path: a CSV file.
        entry: the table of the field.

    Returns:
        `sample` of the table.

    Raises:
        ColumnsError: what is wrong with the file, by line.
        OSError: it cannot be read.
    """
    columns = read_columns(path, HEADERS)
    wrong = [
        f"line {line}: value = {value:g}: must be greater than 0"
        for line, value in zip(columns.lines, columns["value"], strict=True)
        if value <= 0.0
    ]
    if wrong:
        raise ColumnsError(path, wrong)
    return columns["value"]
