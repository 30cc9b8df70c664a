"""Replaces the files that random fields and regions of a study name by what they hold: a study stands by itself."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rfmpm.columns import ColumnsError
from rfmpm.study.data_file import read_data
from rfmpm.study.errors import Problem
from rfmpm.study.region_file import read_region
from rfmpm.study.sample_file import read_sample

Read = Callable[[Path, Mapping[str, Any]], list[Any]]  # path, table of the field -> content
CONTENT: dict[str, tuple[str, Read]] = {"data_file": ("data", read_data), "sample_file": ("sample", read_sample)}
REGION: dict[str, tuple[str, Read]] = {"file": ("corners_m", read_region)}


def read_named_files(tables: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Replace the keys of `CONTENT` in random fields, a material's own too, and `file` in regions, by their content.

    Args:
        tables: of the study file; not changed.
        folder: to which the names of files are relative.

    Returns:
        the tables without names of files, and what is wrong with the files, with the lines.
    """
    problems: list[str] = []
    changed = _fields_replaced((), tables, folder, problems)
    materials, geometry = tables.get("material"), tables.get("geometry")
    if isinstance(materials, list | tuple):
        changed["material"] = [
            _fields_replaced(("material", number), material, folder, problems)
            for number, material in enumerate(materials)
        ]
    if isinstance(geometry, Mapping) and isinstance(geometry.get("region"), list | tuple):
        regions = [
            _replaced(("geometry", "region", number), entry, REGION, folder, problems)
            for number, entry in enumerate(geometry["region"])
        ]
        changed["geometry"] = {**geometry, "region": regions}
    return changed, problems


def _fields_replaced(place: tuple[str | int, ...], table: Any, folder: Path, problems: list[str]) -> Any:
    """A table whose random fields name no files; what is wrong with them is added to `problems`."""
    if not isinstance(table, Mapping):
        return table
    changed = dict(table)
    if isinstance(fields := table.get("random_field"), Mapping):
        changed["random_field"] = {
            variable: _replaced((*place, "random_field", str(variable)), entry, CONTENT, folder, problems)
            for variable, entry in fields.items()
        }
    return changed


def _replaced(
    place: tuple[str | int, ...],
    entry: Any,
    contents: Mapping[str, tuple[str, Read]],
    folder: Path,
    problems: list[str],
) -> Any:
    """A table without names of files; what is wrong with them is added to `problems`."""
    if not isinstance(entry, Mapping):
        return entry
    table = entry
    for key, (content, read) in contents.items():
        if not isinstance(entry.get(key), str):
            continue
        own = {name: value for name, value in table.items() if name != key}
        found, wrong = _content(folder / entry[key], entry, content, read)
        table = own if wrong else own | {content: found}
        problems += [str(Problem((*place, key), text, entry[key])) for text in wrong]
    return table


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
