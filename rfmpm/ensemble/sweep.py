"""A sweep: one campaign for each cell of a grid of parameters, each in a folder of its own, one after the other."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from rfmpm.ensemble.mpi import launched_ranks, wait_until
from rfmpm.ensemble.runner import run
from rfmpm.study import StudyError


@dataclass(frozen=True)
class Axis:
    """One dimension of the grid: keys that change together, and their values.

    Args:
        name: of the dimension.
        keys: dotted paths into the study.
        values: one entry per point of the axis, each with a value for every key.
    """

    name: str
    keys: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]


@dataclass(frozen=True)
class Cell:
    """One cell of the grid."""

    position: tuple[int, ...]  # along each axis
    name: str
    study: Any


def cells(study, axes: Sequence[Axis]) -> list[Cell]:
    """Make the study of every cell; the last axis runs fastest.

    All cells share the seed: realisation i has the same random numbers in each of them, so that cells differ by their
    parameters and not by chance.

    Args:
        study: the study.
        axes: of the grid.

    Returns:
        The cells.

    Raises:
        StudyError: with everything that is wrong in any cell, each problem once.
    """
    found, problems = [], {}
    for position in product(*(range(len(axis.values)) for axis in axes)):
        name = _name(axes, position)
        chosen = [(axis, axis.values[i]) for axis, i in zip(axes, position, strict=True)]
        changes = {key: value for axis, values in chosen for key, value in zip(axis.keys, values, strict=True)}
        try:
            found.append(Cell(position, name, study.with_changes(changes)))
        except StudyError as error:
            problems |= {problem: name for problem in error.problems if problem not in problems}
    if problems:
        raise StudyError([f"{problem} (in the cell {name})" for problem, name in problems.items()])
    return found


def _name(axes: Sequence[Axis], position: tuple[int, ...]) -> str:
    values = [axis.values[i] for axis, i in zip(axes, position, strict=True)]
    texts = ["_".join(map(str, value)).replace("/", "_") for value in values]
    return ",".join(f"{axis.name}={text}" for axis, text in zip(axes, texts, strict=True))


def run_cells(
    grid: Sequence[Cell], directory: Path, workers: int | None, tell: Callable[[str], None]
) -> Iterator[tuple[Cell, Any]]:
    """Run the campaign of every cell, or what is missing of it; under an MPI launcher every rank calls this.

    Args:
        grid: the cells.
        directory: in which each cell has its folder.
        workers: as for `run`.
        tell: is told which cell begins.

    Yields:
        Each cell with its rows; None for the rows on every MPI rank but 0.

    Raises:
        as `run`; then the other ranks end without an error.
    """
    for number, cell in enumerate(grid, start=1):
        tell(f"cell {number} of {len(grid)}: {cell.name.replace(',', ', ')}")
        try:
            rows = run(cell.study, directory / cell.name, workers=workers)
        except BaseException:
            _is_going_on(False)
            raise
        if not _is_going_on(True):
            return
        yield cell, rows


def _is_going_on(here: bool) -> bool:
    """Whether rank 0 goes on, told to every rank by it."""
    if (launched_ranks() or 1) == 1:
        return here
    try:
        from mpi4py import MPI
    except (ImportError, RuntimeError):  # no rank got any further
        return here
    word = bytearray([here])
    request = MPI.COMM_WORLD.Ibcast(word, 0)
    wait_until(request.Test)
    return bool(word[0])
