"""Reads columns of numbers with a header from a text file, and says by line what is wrong with it."""

import csv
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path

DELIMITERS = ",;\t"
MOST_PROBLEMS = 20  # named one by one; a file of another kind has one on every line


class ColumnsError(ValueError):
    """A file that does not hold the columns asked for; `problems` lists what is wrong, by line."""

    def __init__(self, path: Path, problems: Sequence[str]):
        super().__init__(f"{path}: " + "\n  ".join(problems))
        self.problems = list(problems)


class Columns(dict[str, list[float]]):
    """Numbers by column, and `lines`, the line of the file that each row stands on, the first being 1."""

    lines: list[int]


def read_columns(path: Path, names: Mapping[str, Sequence[str]], optional: Sequence[str] = ()) -> Columns:
    """Read named columns; other columns are ignored.

    Cells are separated by commas, semicolons or tabs, whichever the header holds; empty lines and lines that begin with
    # are skipped. Every cell of the asked columns must be a finite number, but an optional column may leave cells
    empty, and is then NaN there.

    Args:
        path: the file, text in UTF-8.
        names: for each column, the headers it may have, any case.
        optional: columns that may be missing, and then are left out.

    Returns:
        the columns.

    Raises:
        ColumnsError: no such columns, or cells that are not finite numbers, by line.
        OSError: the file cannot be read.
    """
    path = Path(path)
    rows = _rows(path)
    if not rows:
        raise ColumnsError(path, ["is empty: must be a header and lines of numbers below it"])
    header = [cell.lower() for cell in rows[0][1]]
    places = _places(path, header, names, optional)
    columns = Columns({name: [] for name in places})
    columns.lines = [line for line, _ in rows[1:]]
    problems = []
    for line, cells in rows[1:]:
        for name, place in places.items():
            cell = cells[place] if place < len(cells) else ""
            value = float("nan") if not cell and name in optional else _number(cell)
            if value is None:
                shown = f"{header[place]} = {cell!r}" if cell else f"{header[place]} is empty"
                problems.append(f"line {line}: {shown}: must be a finite number")
            columns[name].append(value)
    if not columns.lines:
        problems.append("has a header and no line of numbers below it")
    if problems:
        more = [f"and {len(problems) - MOST_PROBLEMS} more"] if len(problems) > MOST_PROBLEMS else []
        raise ColumnsError(path, problems[:MOST_PROBLEMS] + more)
    return columns


def _rows(path: Path) -> list[tuple[int, list[str]]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ColumnsError(path, ["is not a text file in UTF-8"]) from None
    kept = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] != "#"]
    if not kept:
        return []
    delimiter = max(DELIMITERS, key=kept[0][1].count)
    return [(n, [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]) for n, line in kept]


def _places(path: Path, header: Sequence[str], names: Mapping[str, Sequence[str]], optional: Sequence[str]) -> dict:
    places, problems = {}, []
    for name, headers in names.items():
        found = [place for place, cell in enumerate(header) if cell in headers]
        if len(found) > 1:
            problems.append(
                f"the header names {name} {len(found)} times: {', '.join(header[place] for place in found)}"
            )
        elif found:
            places[name] = found[0]
        elif name not in optional:
            problems.append(f"the header has no column {' or '.join(headers)}; it has {', '.join(header)}")
    if problems:
        raise ColumnsError(path, problems)
    return places


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if isfinite(value) else None
