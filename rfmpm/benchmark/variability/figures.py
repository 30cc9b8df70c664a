"""The figures of the study."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rfmpm.benchmark.variability.summary import QUANTITIES
from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREEN, GREY, ORANGE, VERMILION, drawing, new_figure

if TYPE_CHECKING:
    import xarray as xr

COLOURS = (BLUE, ORANGE, VERMILION, GREEN)  # of the ratios of the scales
ASIDE = 0.012  # of the axis, between two lines
LABELS = {"run_out": "run-out [m]", "retrogression_distance": "retrogression [m]", "failure_volume": "volume [m³/m]"}


def draw_over_variation(found: "xr.Dataset", statistic: str, word: str, path: Path) -> None:
    """Draw a statistic of the three quantities over the coefficient of variation, a panel for each vertical scale.

    Args:
        found: dataset of the study.
        statistic: "mean", "standard_deviation" or "characteristic".
        word: what the axis calls it.
        path: the picture.
    """
    with drawing():
        figure = new_figure(9.0, 7.2)
        panels = figure.subplots(len(QUANTITIES), found.sizes["vertical_scale"], sharex=True, sharey="row")
        for row, name in zip(panels, QUANTITIES, strict=True):
            for axes, scale in zip(row, found["vertical_scale"].values, strict=True):
                _lines(axes, found.sel(vertical_scale=scale), f"{name}_{statistic}")
                if statistic != "standard_deviation":
                    level = float(found[f"{name}_uniform"].sel(strength="mean")[0])
                    axes.axhline(level, color=GREY, ls="--", lw=1.2, label="uniform slope of the mean strength")
            row[0].set(ylabel=f"{word}{LABELS[name]}", ylim=(0.0, row[0].get_ylim()[1]))
        for axes, scale in zip(panels[0], found["vertical_scale"].values, strict=True):
            axes.set_title(f"vertical scale {scale:g} m")
        for axes in panels[-1]:
            axes.set_xlabel("coefficient of variation")
        _legend(figure, panels[0][0])
        figure.savefig(path, dpi=DOTS_PER_INCH)


def _lines(axes, part: "xr.Dataset", name: str) -> None:
    places, ratios = part["coefficient_of_variation"].values, part["scale_ratio"].values
    for number, ratio in enumerate(ratios):
        cell = part.sel(scale_ratio=ratio)
        value, lower, upper = (cell[f"{name}{end}"].values for end in ("", "_lower", "_upper"))
        bars = np.where(np.isfinite(lower) & np.isfinite(upper), [value - lower, upper - value], 0.0)
        aside = ASIDE * np.ptp(places) * (number - 0.5 * (len(ratios) - 1))
        style = {"fmt": "o-", "ms": 4, "capsize": 2.5, "lw": 1.4, "color": COLOURS[number % len(COLOURS)]}
        axes.errorbar(places + aside, value, np.maximum(bars, 0.0), label=_ratio(ratio), **style)
    axes.set_xticks(places)


def _ratio(ratio: float) -> str:
    return f"horizontal scale {ratio:g} times the vertical one" if ratio != 1.0 else "horizontal scale = vertical one"


def _legend(figure, axes) -> None:
    handles, texts = axes.get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=2)


def draw_exceedance(found: "xr.Dataset", quantity: str, path: Path) -> None:
    """Draw the exceedance curves of a quantity with their bands, a panel for each variation and vertical scale.

    Args:
        found: dataset of the study.
        quantity: name of it.
        path: the picture.
    """
    with drawing():
        rows, columns = found.sizes["coefficient_of_variation"], found.sizes["vertical_scale"]
        figure = new_figure(9.0, 2.3 * rows + 0.9)
        panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        limits = found[f"{quantity}_threshold"].values
        for row, variation in zip(panels, found["coefficient_of_variation"].values, strict=True):
            for axes, scale in zip(row, found["vertical_scale"].values, strict=True):
                cell = found.sel(coefficient_of_variation=variation, vertical_scale=scale)
                for number, ratio in enumerate(found["scale_ratio"].values):
                    one, colour = cell.sel(scale_ratio=ratio), COLOURS[number % len(COLOURS)]
                    low, high = (one[f"{quantity}_exceedance_{end}"].values for end in ("lower", "upper"))
                    axes.fill_between(limits, low, high, step="post", color=colour, alpha=0.15, lw=0)
                    curve = one[f"{quantity}_exceedance"].values
                    axes.step(limits, curve, where="post", color=colour, lw=1.4, label=_ratio(ratio))
                level = float(cell[f"{quantity}_uniform"].sel(strength="mean"))
                axes.axvline(level, color=GREY, ls="--", lw=1.2, label="uniform slope of the mean strength")
                axes.set(title=f"variation {variation:g}, vertical scale {scale:g} m", ylim=(-0.02, 1.02))
            row[0].set_ylabel("P(more)")
        for axes in panels[-1]:
            axes.set(xlabel=LABELS[quantity], xlim=(limits[0], limits[-1]))
        _legend(figure, panels[0][0])
        figure.savefig(path, dpi=DOTS_PER_INCH)


def draw_maps(found: "xr.Dataset", limit: float, path: Path) -> None:
    """Draw P(run-out > limit) and the characteristic run-out of every combination as colours with their numbers.

    Args:
        found: dataset of the study.
        limit: of the run-out [m]; one of the thresholds.
        path: the picture.
    """
    maps: list[tuple[str, str, str, Callable[[float], str]]] = [
        ("run_out_exceedance", f"P(run-out > {limit:g} m)", "cividis", lambda value: f"{value:.2f}"),
        ("run_out_characteristic", "95 % quantile of the run-out [m]", "viridis", lambda value: f"{value:.1f}"),
    ]
    variations = found["coefficient_of_variation"].values
    with drawing():
        figure = new_figure(9.0, 5.4)
        panels = figure.subplots(2, len(variations), sharex=True, sharey=True, squeeze=False)
        for row, (name, title, colours, text) in zip(panels, maps, strict=True):
            part = found.sel(run_out_threshold=limit)
            low, high = float(part[name].min()), float(part[name].max())
            for axes, variation in zip(row, variations, strict=True):
                cell = part.sel(coefficient_of_variation=variation)
                picture = axes.imshow(
                    cell[name].values, cmap=colours, vmin=low, vmax=high, origin="lower", aspect="auto"
                )
                _write_numbers(axes, cell, name, text, 0.5 * (low + high))
                axes.set_title(f"variation {variation:g}")
            figure.colorbar(picture, ax=row, label=title)
            row[0].set_ylabel("vertical scale [m]")
        for axes in panels[-1]:
            axes.set_xlabel("horizontal over vertical scale")
        figure.savefig(path, dpi=DOTS_PER_INCH)


def _write_numbers(axes, cell: "xr.Dataset", name: str, text: Callable[[float], str], middle: float) -> None:
    for (row, column), value in np.ndenumerate(cell[name].values):
        ends = [float(cell[f"{name}_{end}"][row, column]) for end in ("lower", "upper")]
        words = f"{text(value)}\n" + " to ".join(text(end) if np.isfinite(end) else "?" for end in ends)
        colour = "white" if value < middle else "black"
        axes.text(column, row, words, ha="center", va="center", fontsize=7.5, color=colour)
    axes.set_xticks(range(cell.sizes["scale_ratio"]), [f"{ratio:g}" for ratio in cell["scale_ratio"].values])
    axes.set_yticks(range(cell.sizes["vertical_scale"]), [f"{scale:g}" for scale in cell["vertical_scale"].values])
    axes.grid(False)
