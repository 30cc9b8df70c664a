"""From rows on record to what estimators see of them."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm.estimators.rows import Rows
from rfmpm.planning.levels import point_counts

if TYPE_CHECKING:
    import xarray as xr

# Flags by which a value is only a lower bound.
BOUNDED_BY = {
    "run_out": ("run_out_censored",),
    "retrogression_distance": ("retrogression_censored",),
    "influence_distance": ("run_out_censored", "retrogression_censored"),
    "failure_volume": ("retrogression_censored",),
    "initial_failure_volume": (),
}


def outcomes(study, columns: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Read what rows say about the quantity in question.

    Args:
        study: the study.
        columns: variables by name, shape (n,) each; integers missing as NaN or negative.

    Returns:
        The values, NaN where the simulation failed, and whether they are lower bounds; shape (n,) each.
    """
    quantity = study.study.until.quantity if study.study.until else "run_out"
    value = np.array(columns[quantity], float)
    is_censored = np.zeros(value.shape, bool)
    for name in BOUNDED_BY[quantity]:
        is_censored |= np.asarray(columns[name], float) == 1.0
    return value, is_censored & ~np.isnan(value)


def as_rows(level, index, value, is_censored, step_count, points: np.ndarray) -> Rows:
    """Make what estimators see; a simulation whose steps are unknown counts with the mean of its level.

    Args:
        level: of each row, shape (n,).
        index: of its realisation, shape (n,).
        value: the quantity in question, NaN where it failed, shape (n,).
        is_censored: whether that is a lower bound, shape (n,).
        step_count: time steps, negative or NaN where unknown, shape (n,).
        points: material points of each level, shape (levels,).

    Returns:
        The rows, sorted by level and index.
    """
    level, steps = np.asarray(level, int), np.array(step_count, float)
    is_known = steps >= 0.0
    for number in np.unique(level[~is_known]):
        known = steps[is_known & (level == number)]
        steps[~is_known & (level == number)] = known.mean() if known.size else 1.0
    columns = level, np.asarray(index), np.asarray(value), np.asarray(is_censored), steps * points[level]
    order = np.lexsort((columns[1], level))
    return Rows(*(column[order] for column in columns))


def rows_of(study, dataset: "xr.Dataset") -> Rows:
    """Make of the dataset of a campaign what estimators see.

    Args:
        study: of the campaign.
        dataset: of all its rows.

    Returns:
        The rows.
    """
    columns = {name: dataset[name].values for name in dataset.variables if dataset[name].ndim == 1}
    return as_rows(
        columns["level"], columns["realisation"], *outcomes(study, columns), columns["step_count"], point_counts(study)
    )
