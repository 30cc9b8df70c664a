"""The levels of a study: the same fields on coarser cells."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm.study.question_checks import level_tables
from rfmpm.study.study import plain

if TYPE_CHECKING:
    import xarray as xr


def studies_by_level(study) -> tuple[Any, ...]:
    """Make the study of each level: the same fields and question on other cells.

    Args:
        study: the study.

    Returns:
        The study itself, with its fields on a lattice of its own cells where there are coarser ones, then those with
        the cells of `estimator.coarser_cells_m`.
    """
    coarser = study.estimator.coarser_cells_m if study.estimator else None
    if not coarser:
        return (study.with_changes({"estimator": None}) if study.estimator else study,)
    tables = plain(study)
    return tuple(type(study)(**level_tables(tables, cell)) for cell in (study.discretisation.cell_m, *coarser))


def point_counts(study) -> np.ndarray:
    """Count the material points of each level, shape (levels,) [-]."""
    from rfmpm.mpm import geometry

    counts = []
    for level in studies_by_level(study):
        counts.append(len(geometry.fill_body(level, geometry.body(level))[0].volume))
    return np.array(counts)


def on_own_cells(dataset: "xr.Dataset") -> "xr.Dataset":
    """Restrict the dataset of a campaign to the study's own cells: level 0, one row for each realisation."""
    return dataset.isel(realisation=np.flatnonzero(dataset["level"].values == 0))


def with_own_bins(row: dict[str, Any], study) -> dict[str, Any]:
    """Cut the surface of a row to the bins of the study's own cells; coarser ones may reach a little further.

    Args:
        row: of one simulation.
        study: of the campaign.

    Returns:
        The row.
    """
    if study.output.surface_bin_m is None or np.ndim(row["final_surface"]) == 0:
        return row
    from rfmpm.results.row_files import bin_positions

    return row | {"final_surface": row["final_surface"][: len(bin_positions(study))]}


def run_options(prepared, level: int, index: int, xi: np.ndarray | None) -> dict[str, Any]:
    """What `realisation.run` and `simulate` need beside a prepared study and an index.

    Args:
        prepared: study of the level.
        level: on whose cells it is simulated.
        index: of the realisation.
        xi: what the plan says of its random vector, shape (n_variables,); None for the stream of its index.

    Returns:
        Keyword arguments; the vector is the same on every level.
    """
    if level == 0 and xi is None:
        return {}
    from rfmpm import realisation

    return {"level": level, "xi": realisation.draw_xi(prepared, index) if xi is None else xi}
