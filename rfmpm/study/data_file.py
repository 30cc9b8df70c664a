"""Reads measured values that every realisation agrees with."""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot, isnan
from pathlib import Path
from typing import Any

from rfmpm.columns import Columns, ColumnsError, read_columns

HEADERS = {
    "x_m": ("x_m", "x"),
    "y_m": ("y_m", "y"),
    "value": ("value", "value_kpa", "value_deg"),
    "measurement_error": ("measurement_error",),
}
SAME_PLACE = 1e-9  # [m]


def read_data(path: Path, entry: Mapping[str, Any]) -> list[dict[str, float]]:
    """Read the measured values of a random field.

    Args:
        path: a CSV file.
        entry: the table of the field; its `measurement_error` is that of values without one.

    Returns:
        `data` of the table.

    Raises:
        ColumnsError: what is wrong with the file, by line.
        OSError: it cannot be read.
    """
    columns = read_columns(path, HEADERS, optional=["measurement_error"])
    rows = _rows(columns)
    common = entry.get("measurement_error")
    labels = [f"line {line}" for line in columns.lines]
    wrong = [
        f"{label}: {key} = {row[key]:g}: {text}"
        for label, row in zip(labels, rows, strict=True)
        for key, is_wrong, text in (
            ("value", row["value"] <= 0, "must be greater than 0"),
            ("measurement_error", not 0 <= row.get("measurement_error", 0.0) <= 2, "must be at least 0 and at most 2"),
        )
        if is_wrong
    ]
    places = [(row["x_m"], row["y_m"], row["value"], row.get("measurement_error", common) or 0.0) for row in rows]
    wrong += [f"{first} and {second} {text}" for first, second, text in contradictions(places, labels)]
    if wrong:
        raise ColumnsError(path, wrong)
    return rows


def _rows(columns: Columns) -> list[dict[str, float]]:
    rows = [dict(zip(columns, numbers, strict=True)) for numbers in zip(*columns.values(), strict=True)]
    return [{key: value for key, value in row.items() if not isnan(value)} for row in rows]


def contradictions(
    data: Sequence[tuple[float, float, float, float]], labels: Sequence[str]
) -> Iterator[tuple[str, str, str]]:
    """Pairs of exact data that differ at one place.

    Args:
        data: x, y [m], value and coefficient of variation of its error [-]; 0 for an exact one.
        labels: a name for each.

    Yields:
        the two names, and what is wrong.
    """
    exact = sorted((x, y, value, label) for (x, y, value, error), label in zip(data, labels, strict=True) if error == 0)
    for first, (x, y, value, label) in enumerate(exact):
        for other_x, other_y, other_value, other in exact[first + 1 :]:
            if other_x - x > SAME_PLACE:
                break
            if hypot(other_x - x, other_y - y) <= SAME_PLACE and abs(other_value - value) > 1e-9 * abs(value):
                text = (
                    f"contradict each other: {value:.6g} and {other_value:.6g}, both exact, at x = {x:g} m, y = {y:g} m"
                )
                yield label, other, f"{text}; give them a measurement_error, or keep one"
