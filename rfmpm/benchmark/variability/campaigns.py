"""The campaigns of the study: one for each combination of variation and scales, in rounds that keep them equal."""

from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from rfmpm import campaign_status
from rfmpm.ensemble.sweep import Cell, run_cells

FIELD = "random_field.cohesion"


class Grid(NamedTuple):
    """The values along the three dimensions of the study, at least two along each, named as in its dataset."""

    coefficient_of_variation: tuple[float, ...]  # [-]
    vertical_scale: tuple[float, ...]  # of fluctuation [m]
    scale_ratio: tuple[float, ...]  # horizontal over vertical scale of fluctuation [-]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of values along each dimension."""
        return tuple(map(len, self))


def cells(study, grid: Grid) -> list[Cell]:
    """Make the study of every combination; the ratio of the scales runs fastest.

    All share the seed: realisation i has the same random numbers in each of them.

    Args:
        study: with a random cohesion.
        grid: of the combinations.

    Returns:
        The combinations.

    Raises:
        StudyError: if one of them is no valid study.
    """
    found = []
    for position in product(*map(range, grid.shape)):
        values = dict(zip(grid._fields, (along[i] for along, i in zip(grid, position, strict=True)), strict=True))
        changes = {
            f"{FIELD}.coefficient_of_variation": values["coefficient_of_variation"],
            f"{FIELD}.scale_of_fluctuation_v_m": values["vertical_scale"],
            f"{FIELD}.scale_of_fluctuation_h_m": values["scale_ratio"] * values["vertical_scale"],
        }
        name = ",".join(f"{dimension}={value:g}" for dimension, value in values.items())
        found.append(Cell(position, name, study.with_changes(changes)))
    return found


def run_in_rounds(
    study, grid: Grid, folder: Path, block: int, workers: int | None, tell: Callable[[str], None]
) -> Iterator[dict[tuple[int, ...], Any]]:
    """Run every combination to a first number of realisations, then all of them to the next, up to the study's own.

    So all hold as many, whenever it is stopped. Called again it goes on with the first round that is not complete.

    Args:
        study: with a random cohesion.
        grid: of the combinations.
        folder: in which each combination has its own.
        block: realisations that a round adds to each combination, at least 1 [-].
        workers: local processes; as many as there are processors if None.
        tell: is told what begins.

    Yields:
        After each round the rows of every combination by its position; not on further ranks of an MPI launcher.

    Raises:
        as `ensemble.run`.
    """
    total = study.study.realisations
    done = min(_finished(folder / cell.name) for cell in cells(study, grid))
    first = min(total, (done // block + 1) * block)
    for number in [*range(first, total, block), total]:
        tell(f"{number} realisations of each combination")
        combinations = cells(study.with_changes({"study.realisations": number}), grid)
        rows = {cell.position: found for cell, found in run_cells(combinations, folder, workers, tell)}
        if all(found is not None for found in rows.values()):
            yield rows


def _finished(folder: Path) -> int:
    """How many realisations the campaign in a folder last had; 0 where there is none."""
    try:
        return int(campaign_status.read(folder)["done"])
    except FileNotFoundError:
        return 0
