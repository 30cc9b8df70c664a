"""Error against CPU time, one figure per scene."""

from collections import defaultdict
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from rfmpm.benchmark.engine.runs import Measurement
from rfmpm.benchmark.engine.schemes import ENGINES, SHAPE_LABELS, TRANSFER_LABELS
from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREY, ORANGE, VERMILION, drawing, new_figure

COLOURS = dict(zip(SHAPE_LABELS, (GREY, ORANGE, BLUE, VERMILION), strict=True))
MARKERS = dict(zip(TRANSFER_LABELS, "oDsPXv^", strict=True))
WIDTH, PANEL, LEGEND = 11.0, 5.2, 1.1  # inches
WORTH_A_NAME = 0.9  # a point of the front gets one where its error is below this share of the last one named


def shown(measured: Sequence[Measurement], error: str) -> list[Measurement]:
    """The measurements whose run ended with an error that a logarithmic axis can show."""
    return [one for one in measured if isfinite(one.errors[error]) and one.errors[error] > 0.0]


def front(measured: Sequence[Measurement], error: str) -> list[Measurement]:
    """The Pareto front: what nothing else beats in both CPU time and error, from fast to exact."""
    best, least = [], float("inf")
    for one in sorted(shown(measured, error), key=lambda one: (one.cpu_time, one.errors[error])):
        if one.errors[error] < least:
            least = one.errors[error]
            best.append(one)
    return best


def draw(measured: Sequence[Measurement], title: str, errors: dict[str, str], path: Path) -> None:
    """Draw a scene's measurements, a panel per error, and write the figure.

    Args:
        measured: the measurements.
        title: of the figure.
        errors: label of the axis by name of the error.
        path: PNG file.
    """
    with drawing():
        figure = new_figure(WIDTH, PANEL * len(errors) + LEGEND)
        panels = figure.subplots(len(errors), 2, squeeze=False, width_ratios=(1.9, 1.0))
        for (name, label), (axes, side) in zip(errors.items(), panels, strict=True):
            lines = _panel(axes, measured, name, label)
            side.axis("off")
            side.text(0.0, 1.0, "\n".join(lines), fontsize=7.0, va="top", transform=side.transAxes)
        _legend(figure, {one.scheme.transfer for one in measured})
        panels[0][0].set_title(title)
        figure.savefig(path, dpi=DOTS_PER_INCH)


def _panel(axes, measured, name, label) -> list[str]:
    """Draw one error. Returns what the marks on its fronts stand for."""
    series = defaultdict(list)
    for one in shown(measured, name):
        series[one.scheme].append(one)
    for scheme, ones in series.items():
        ones.sort(key=lambda one: -one.cell)
        is_fast = scheme.engine == "fast"
        colour = COLOURS[scheme.shape]
        axes.plot(
            [one.cpu_time for one in ones], [one.errors[name] for one in ones],
            color=colour, marker=MARKERS[scheme.transfer], markersize=5.5, linewidth=1.4 if is_fast else 0.6,
            alpha=1.0 if is_fast else 0.75, markerfacecolor=colour if is_fast else "white", markeredgewidth=0.9,
            linestyle="-" if scheme.points_per_cell == 4 else ":",
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="CPU time [s]", ylabel=label)
    lines = []
    for engine, text in ENGINES.items():
        best = front([one for one in measured if one.scheme.engine == engine], name)
        if not best:
            continue
        lines.append(f"Front, {text}:")
        axes.step(
            [one.cpu_time for one in best], [one.errors[name] for one in best],
            where="post", color="black", linewidth=0.9, linestyle="-" if engine == "fast" else "--",
        )  # fmt: skip
        for number, one in enumerate(_named(best, name), start=1):
            mark = f"{number}" if engine == "plain" else "abcdefghijklmnopq"[number - 1]
            axes.annotate(
                mark, (one.cpu_time, one.errors[name]), xytext=(-4, -11), textcoords="offset points",
                fontsize=8.5, fontweight="bold",
            )  # fmt: skip
            lines.append(f"{mark}  {one.scheme.label}, h = {one.cell:.3g} m")
    return lines


def _named(best, name):
    """The points of a front that differ enough to be told apart."""
    kept = []
    for one in best:
        if not kept or one.errors[name] < WORTH_A_NAME * kept[-1].errors[name]:
            kept.append(one)
    return kept


def _legend(figure, transfers) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color=colour, label=SHAPE_LABELS[shape]) for shape, colour in COLOURS.items()]
    handles += [
        Line2D([], [], color="black", marker=MARKERS[name], linestyle="", markerfacecolor="white", label=label)
        for name, label in TRANSFER_LABELS.items()
        if name in transfers
    ]
    handles += [
        Line2D([], [], color="black", marker="o", markerfacecolor="black", label=ENGINES["fast"]),
        Line2D([], [], color="black", marker="o", markerfacecolor="white", linewidth=0.6, label=ENGINES["plain"]),
        Line2D([], [], color="black", linestyle=":", label="more than 4 points per cell"),
        Line2D([], [], color="black", linestyle="--", label="front of the plain solver"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=8.0)
