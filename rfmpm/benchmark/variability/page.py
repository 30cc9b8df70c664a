"""The page of the study: random_field_study.md and its pictures, made of the dataset alone."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rfmpm.benchmark.variability.campaigns import Grid
from rfmpm.benchmark.variability.contrasts import (
    Contrast,
    against,
    correlations,
    effects,
    mean_of,
    probability_beyond,
)
from rfmpm.benchmark.variability.figures import draw_exceedance, draw_maps, draw_over_variation
from rfmpm.benchmark.variability.findings import WORDS, crest_lost, findings, standing
from rfmpm.benchmark.variability.summary import QUANTITIES, each_cell
from rfmpm.benchmark.variability.text import PAGE
from rfmpm.report import words

if TYPE_CHECKING:
    import xarray as xr

NAME = "random_field_study"
PLACE = "variation | vertical scale [m] | ratio"
PLACES = (2, 2, 2, 1)  # decimal places of the columns of differences


def write_page(found: "xr.Dataset", study, folder: Path) -> Path:
    """Write the page and its pictures.

    Args:
        found: dataset of the study, with the uniform slopes.
        study: it was made of.
        folder: where they go.

    Returns:
        The page's path.
    """
    limit = study.quantities.run_out_limit_m
    draw_over_variation(found, "mean", "mean ", folder / f"{NAME}_mean.png")
    draw_over_variation(found, "standard_deviation", "spread of the ", folder / f"{NAME}_spread.png")
    for quantity in QUANTITIES:
        draw_exceedance(found, quantity, folder / f"{NAME}_{quantity}.png")
    draw_maps(found, limit, folder / f"{NAME}_maps.png")
    path = folder / f"{NAME}.md"
    path.write_text(_text(found, study, limit), encoding="utf-8")
    return path


def _text(found: "xr.Dataset", study, limit: float) -> str:
    each, total = found.sizes["realisation"], found["run_out"].size
    lost, far = (int((found[name] == 1).sum()) for name in ("retrogression_censored", "run_out_censored"))
    first = {name: float(found[name][0]) for name in Grid._fields}
    paired = list(correlations(found, "scale_ratio", first["scale_ratio"], "run_out"))
    return PAGE.format(
        command=found.attrs["command"],
        load=found.attrs["load"],
        name=NAME,
        combinations=total // each,
        each=each,
        total=total,
        failed=int(found["failed_count"].sum()),
        cell=study.discretisation.cell_m,
        hours=words.duration(float(found["computing_time"].sum())),
        per=float(found["computing_time"].sum()) / total,
        crest=study.geometry.crest_m,
        mean=study.material[0].cohesion_kpa,
        residual=study.material[0].residual_cohesion_kpa,
        variations=_listed(found, "coefficient_of_variation"),
        scales=_listed(found, "vertical_scale"),
        ratios=_listed(found, "scale_ratio"),
        lost=f"{100.0 * lost / total:.0f} %",
        far=f"The far wall bounded the run-out of {far}." if far else "No run-out met the far wall.",
        correlation=f"{np.median(paired):.2f}" if paired else "unknown",
        limit=limit,
        findings="\n".join(f"- {finding}" for finding in findings(found, limit)),
        run_out="\n".join(_run_out(found, limit)),
        others="\n".join(_others(found)),
        effects="\n".join(_effects(found, limit)),
        anisotropy="\n".join(_contrasts(found, "scale_ratio", limit)),
        variation="\n".join(_contrasts(found, "coefficient_of_variation", limit)),
        scale="\n".join(_contrasts(found, "vertical_scale", limit)),
        **{f"first_{name}": f"{value:g}" for name, value in first.items()},
    )


def _listed(found: "xr.Dataset", name: str) -> str:
    return ", ".join(f"{value:g}" for value in found[name].values)


def _head(*columns: str) -> list[str]:
    titles = f"{PLACE} | {' | '.join(columns)}"
    return [f"| {titles} |", "|---" * (titles.count("|") + 1) + "|"]


def _row(place: Sequence[float], *entries: str) -> str:
    return f"| {' | '.join([*(f'{value:g}' for value in place), *entries])} |"


def _place(cell: "xr.Dataset") -> list[float]:
    return [float(cell[name]) for name in Grid._fields]


def _with_ends(cell: "xr.Dataset", name: str, places: int) -> str:
    value, low, high = (float(cell[f"{name}{end}"]) for end in ("", "_lower", "_upper"))
    return f"{value:.{places}f} ({_number(low, places)} to {_number(high, places)})"


def _number(value: float, places: int) -> str:
    return f"{value:.{places}f}" if np.isfinite(value) else "unbounded"


def _run_out(found: "xr.Dataset", limit: float) -> Iterator[str]:
    yield from _head("mean [m]", "standard deviation [m]", "95 % quantile [m]", f"P(> {limit:g} m)", "stand")
    for cell in each_cell(found.sel(run_out_threshold=limit)):
        statistics = [
            _with_ends(cell, f"run_out_{name}", 1) for name in ("mean", "standard_deviation", "characteristic")
        ]
        stand = f"{standing(cell)} of {cell.sizes['realisation']}"
        yield _row(_place(cell), *statistics, _with_ends(cell, "run_out_exceedance", 2), stand)


def _others(found: "xr.Dataset") -> Iterator[str]:
    titles = [f"{kind} {word}" for word in ("retrogression [m]", "volume [m³/m]") for kind in ("mean", "spread of the")]
    yield from _head(*titles, "P(whole crest lost)")
    for cell in each_cell(found):
        statistics = [
            _with_ends(cell, f"{quantity}_{name}", 1)
            for quantity in ("retrogression_distance", "failure_volume")
            for name in ("mean", "standard_deviation")
        ]
        lost = crest_lost(cell)
        yield _row(_place(cell), *statistics, f"{lost.value:.2f} ({lost.lower:.2f} to {lost.upper:.2f})")


def _contrasts(found: "xr.Dataset", dimension: str, limit: float) -> Iterator[str]:
    yield from _head("mean run-out [m]", f"P(run-out > {limit:g} m)", "mean retrogression [m]", "mean volume [m³/m]")
    compared = [mean_of("run_out"), probability_beyond("run_out", limit)]
    compared += [mean_of("retrogression_distance"), mean_of("failure_volume")]
    families = [against(found, dimension, float(found[dimension][0]), compare) for compare in compared]
    for contrasts in zip(*families, strict=True):
        entries = [_difference(contrast, places) for contrast, places in zip(contrasts, PLACES, strict=True)]
        yield _row(list(contrasts[0].here.values()), *entries)


def _effects(found: "xr.Dataset", limit: float) -> Iterator[str]:
    columns = effects(found, limit)
    yield f"| | {' | '.join(columns)} |"
    yield "|---" * (len(columns) + 1) + "|"
    for contrasts in zip(*columns.values(), strict=True):
        ((name, value),), (first,) = contrasts[0].here.items(), contrasts[0].there.values()
        entries = [_difference(contrast, places) for contrast, places in zip(contrasts, PLACES, strict=True)]
        yield f"| {WORDS[name]} {value:g} against {first:g} | {' | '.join(entries)} |"


def _difference(contrast: Contrast, places: int) -> str:
    one = contrast.estimate
    text = f"{one.value:+.{places}f} ({one.lower:+.{places}f} to {one.upper:+.{places}f})"
    return f"**{text}**" if contrast.is_secure else text
