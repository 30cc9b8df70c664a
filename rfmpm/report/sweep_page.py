"""The picture and the table of a sweep."""

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREY, ORANGE, VERMILION, drawing, new_figure

COLOURS = (BLUE, VERMILION, ORANGE, GREY, "#009E73", "#CC79A7", "#56B4E9")
ASIDE = 0.008  # of the axis, between two lines
PANELS = {"mean_run_out": "mean run-out [m]", "exceedance_probability": "P(run-out > {limit:g} m) [-]"}


def draw_sweep(sweep, axes: list[str], limit: float, path: Path) -> None:
    """Draw mean run-out and exceedance probability with their intervals over the last axis, a line for each other cell.

    Args:
        sweep: the dataset of a sweep.
        axes: names of its swept dimensions.
        limit: of the run-out [m].
        path: the picture.
    """
    *others, last = axes
    with drawing():
        figure = new_figure(10.0, 3.6)
        for axis, (name, label) in zip(figure.subplots(1, 2), PANELS.items(), strict=True):
            lines = list(_lines(sweep, others))
            for number, (text, cell) in enumerate(lines):
                _draw_line(axis, cell, name, last, number, text, ASIDE * (number - 0.5 * (len(lines) - 1)))
            axis.set_xlabel(_label(sweep, last))
            axis.set_ylabel(label.format(limit=limit))
            axis.set_ylim(bottom=0.0)
        if others:
            handles, texts = axis.get_legend_handles_labels()
            title = ",\n".join(_label(sweep, name) for name in others)
            figure.legend(handles, texts, title=title, loc="outside right upper")
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def _lines(sweep, others: list[str]) -> Iterator[tuple[str, Any]]:
    for place in product(*(range(sweep.sizes[name]) for name in others)):
        cell = sweep.isel(dict(zip(others, place, strict=True)))
        yield ", ".join(_text(cell[name].values) for name in others), cell


def _draw_line(axis, cell, name: str, last: str, number: int, text: str, aside: float) -> None:
    value, lower, upper = (cell[f"{name}{end}"].values for end in ("", "_lower", "_upper"))
    is_known = np.isfinite(value) & np.isfinite(lower) & np.isfinite(upper)
    places = cell[last].values if cell[last].dtype.kind in "if" else np.arange(len(value))
    spread = np.where(is_known, [value - lower, upper - value], 0.0)
    colour = COLOURS[number % len(COLOURS)]
    places = places + aside * np.ptp(places)  # so that bars of equal places can be told apart
    axis.errorbar(places, value, spread, fmt="o-", capsize=3, color=colour, label=text)
    if cell[last].dtype.kind not in "if":
        axis.set_xticks(places, [_text(entry) for entry in cell[last].values])


def _label(sweep, name: str) -> str:
    unit = sweep[name].attrs.get("units", "")
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")


def _text(value: Any) -> str:
    return f"{value:g}" if np.asarray(value).dtype.kind in "if" else str(value)


def table_lines(sweep, axes: list[str], limit: float) -> list[str]:
    """Write mean run-out, exceedance probability with interval and failures of every cell as a table.

    Args:
        sweep: the dataset of a sweep.
        axes: names of its swept dimensions.
        limit: of the run-out [m].

    Returns:
        Lines of Markdown.
    """
    heads = [*(_label(sweep, name) for name in axes), "mean run-out [m]", f"P(run-out > {limit:g} m)", "failed"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for place in product(*(range(sweep.sizes[name]) for name in axes)):
        cell = sweep.isel(dict(zip(axes, place, strict=True)))
        numbers = [
            f"{_number(cell[name])} ({_number(cell[f'{name}_lower'])} to {_number(cell[f'{name}_upper'])})"
            for name in PANELS
        ]
        entries = [*(_text(cell[name].values) for name in axes), *numbers, str(int(cell["failed_count"]))]
        lines.append("| " + " | ".join(entries) + " |")
    return lines


def _number(value: Any) -> str:
    value = float(value)
    return f"{value:.3g}" if np.isfinite(value) else "unknown"
