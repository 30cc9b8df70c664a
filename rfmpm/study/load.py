"""Reads a study from a file, a text, a dict or a study."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rfmpm.study.errors import StudyError
from rfmpm.study.named_files import read_named_files
from rfmpm.study.study import Study


def load_study(source: str | Path | Mapping[str, Any] | Study) -> Study:
    """Read and validate a study, with the files it names.

    Args:
        source: path of a TOML file, TOML text (it holds a newline or '='), a dict of the file's tables, or a study.
            The files that it names are beside the TOML file, or in the working directory for a text or a dict.

    Returns:
        The validated study.

    Raises:
        StudyError: with everything that is wrong, named by the file if the source is one.
    """
    if isinstance(source, Study):
        return source
    if isinstance(source, Mapping):
        return _study({str(key): table for key, table in source.items()}, Path())
    if isinstance(source, str) and ("\n" in source or ("=" in source and not Path(source).exists())):
        return _study(_parse(source, "study"), Path())
    path = Path(source)
    tables = _parse(_read(path), str(path))
    try:
        return _study(tables, path.parent)
    except StudyError as error:
        raise StudyError(error.problems, str(path)) from None


def _study(tables: dict[str, Any], folder: Path) -> Study:
    # Files are named relative to the folder. What is wrong with them is said together with what is wrong elsewhere.
    tables, problems = read_named_files(tables, folder)
    try:
        study = Study(**tables)
    except StudyError as error:
        raise StudyError([*problems, *error.problems]) from None
    if problems:
        raise StudyError(problems)
    return study


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise StudyError(["there is no such study file"], str(path)) from None
    except UnicodeDecodeError:
        raise StudyError(["is not a text file in UTF-8"], str(path)) from None
    except OSError as error:
        raise StudyError([f"cannot be read: {error.strerror}"], str(path)) from None


def _parse(text: str, source: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise StudyError([f"is not valid TOML: {error}"], source) from None
