"""From a study to who answers it: its question, its estimator and its levels; and from rows to what these see."""

from collections.abc import Mapping
from dataclasses import replace
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm.estimators.monte_carlo import Estimate, MonteCarlo
from rfmpm.estimators.protocol import Estimator
from rfmpm.estimators.question import Question
from rfmpm.estimators.rows import Rows
from rfmpm.study.question_checks import level_tables
from rfmpm.study.study import plain
from rfmpm.variables import VARIABLES

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

NOT_DIVISIBLE = (
    "only a study with a fixed number of independent realisations can be run in parts: one with study.realisations, "
    'without study.until and with estimator.sampling = "random"'
)
NOT_AGAIN = (
    "later realisations of subset_simulation follow from those that failed, as they failed; run the campaign anew with "
    "--fresh"
)


def question_of(study) -> Question:
    """What a study asks; with a fixed number of realisations, P(run-out > quantities.run_out_limit_m).

    Args:
        study: the study.

    Returns:
        The question.
    """
    asked = study.study.until
    if asked is None:
        limit = study.quantities.run_out_limit_m
        return Question("run_out", "exceedance", limit=limit, at_most=study.study.realisations)
    kind = "exceedance" if asked.limit is not None else "mean" if asked.quantile is None else "quantile"
    return Question(
        asked.quantity,
        kind,
        limit=asked.limit,
        probability=asked.quantile,
        half_width=asked.width,
        relative_half_width=asked.relative_half_width,
        at_most=asked.at_most,
    )


def answer(study, rows: Rows) -> Estimate:
    """Answer a study's question.

    Args:
        study: the study.
        rows: of its campaign.

    Returns:
        The estimate with its interval.
    """
    return estimator_of(study).estimate(rows)


def answer_lines(study, found: Estimate) -> list[str]:
    """Say an answer in words: the estimate and its interval; how near that is to what was wanted; what to know of it.

    Args:
        study: the study.
        found: the answer to its question.

    Returns:
        Lines of text.
    """
    question = question_of(study)
    plain_question = replace(question, half_width=None, relative_half_width=None)
    interval = f"{100.0 * found.confidence:.0f} % interval {found.lower:.4g} to {found.upper:.4g}"
    unit = "" if question.kind == "exceedance" else f" {_unit(question.quantity)}"
    value = "unknown" if isnan(found.value) else f"= {found.value:.4g}{unit}"
    basis = f"{found.n} realisations on the study's own cells"
    lines = [f"{in_words(plain_question)} {value}, {interval}{unit} ({found.method}; {basis})"]
    if question.is_open_ended and question.excess(found) > 1.0:
        half = 0.5 * (found.upper - found.lower)
        wanted = in_words(question).removeprefix(f"{in_words(plain_question)} ")
        lines.append(f"not known {wanted}, as was asked, but {half:.3g}{unit}: study.until.at_most ended it")
    return lines + ([found.note] if found.note else [])


def in_words(question: Question) -> str:
    """Say a question in words: "P(run-out > 5 m) to within 0.05"."""
    name, unit = _name(question.quantity), _unit(question.quantity)
    if question.kind == "exceedance":
        words, unit = f"P({name} > {question.limit:g} {unit})", ""
    elif question.kind == "quantile":
        words = f"{100.0 * question.probability:g} % quantile of the {name}"
    else:
        words = f"mean {name}"
    if question.half_width is not None:
        return f"{words} to within {question.half_width:g} {unit}".rstrip()
    if question.relative_half_width is not None:
        return f"{words} to within {100.0 * question.relative_half_width:g} %"
    return words


def _name(quantity: str) -> str:
    return {"run_out": "run-out"}.get(quantity, quantity.replace("_", " "))


def _unit(quantity: str) -> str:
    unit = VARIABLES[quantity].unit
    return {"m3 m-1": "m3/m"}.get(unit, unit)


def estimator_of(study) -> Estimator:
    """Make the estimator that plans a study's campaign and answers its question.

    Args:
        study: the study.

    Returns:
        The estimator.
    """
    question = question_of(study)
    number = None if question.is_open_ended else question.at_most
    return MonteCarlo(question, number)


def is_random(study) -> bool:
    """Whether the random vector of a realisation follows from seed and index alone, by its stream."""
    table = study.estimator
    return table is None or (table.sampling == "random" and not has_chains(study))


def has_chains(study) -> bool:
    """Whether realisations follow from others before them."""
    return study.estimator is not None and study.estimator.method == "subset_simulation"


def is_divisible(study) -> bool:
    """Whether the campaign can be run in parts."""
    return study.study.until is None and is_random(study)


def sampler_of(study, prepared):
    """Make what says the random vectors of a study for which `is_random` is false.

    Args:
        study: the study.
        prepared: it, on its own cells.

    Returns:
        The sampler.
    """
    raise NotImplementedError


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
        return (study,)
    tables = plain(study)
    return tuple(type(study)(**level_tables(tables, cell)) for cell in (study.discretisation.cell_m, *coarser))


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


def point_counts(study) -> np.ndarray:
    """Count the material points of each level, shape (levels,) [-]."""
    from rfmpm.mpm import geometry

    counts = []
    for level in studies_by_level(study):
        cells, shape = level.discretisation, geometry.body(level)
        counts.append(len(geometry.fill(shape.outline, cells.cell_m, cells.points_per_cell)[1]))
    return np.array(counts)


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
