"""The verdicts as pictures: one table of colours for each sweep, and one that shows all sweeps."""

from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from rfmpm.benchmark.stability.case import Sweep
from rfmpm.benchmark.stability.verdict import (
    CLOSED,
    DONE,
    FAIL,
    FAILURES,
    KINDS,
    OPEN,
    REFUSED,
    STOPPED,
    TOO_FAR_OPEN,
    UNBALANCED,
    Verdict,
)
from rfmpm.report.style import DOTS_PER_INCH, drawing, new_figure

COLOURS = {
    DONE: "#7fc79f",
    OPEN: "#d9ecb2",
    STOPPED: "#9ecae9",
    REFUSED: "#d0d0d0",
    UNBALANCED: "#e8862e",
    FAIL: "#c01f2e",
}
MEANINGS = {
    DONE: f"done, energy closed to {100 * CLOSED:g} %",
    OPEN: f"done, energy open by up to {100 * TOO_FAR_OPEN:g} %",
    STOPPED: "stopped for the right reason",
    REFUSED: "refused in the right words",
    UNBALANCED: f"FAILED: energy open by more than {100 * TOO_FAR_OPEN:g} %",
    FAIL: "FAILED otherwise",
}
PLACE = (0.72, 0.34)  # inches of one place of a table
LETTERS_PER_INCH = 13


def places(sweep: Sweep, verdicts: Sequence[Verdict]) -> dict[tuple[str, str], list[Verdict]]:
    """The verdicts of each place (row, column) of a sweep's table."""
    found: dict[tuple[str, str], list[Verdict]] = {}
    for case, verdict in zip(sweep.cases, verdicts, strict=True):
        found.setdefault((case.row, case.column), []).append(verdict)
    return found


def worst(verdicts: Sequence[Verdict]) -> str:
    """The worst kind among the verdicts of one place."""
    return max((verdict.kind for verdict in verdicts), key=KINDS.index)


def draw_sweep(sweep: Sweep, verdicts: Sequence[Verdict], path: Path) -> None:
    """Draw a sweep as a table: the colour is the verdict, the number the error of the energy balance in per cent."""
    rows, columns = (list(dict.fromkeys(getattr(case, name) for case in sweep.cases)) for name in ("row", "column"))
    width = PLACE[0] * len(columns) + max(len(row) for row in rows) / LETTERS_PER_INCH + 0.6
    with drawing():
        figure = new_figure(max(width, 7.0), PLACE[1] * len(rows) + 1.5)
        axes = figure.add_subplot()
        for (row, column), found in places(sweep, verdicts).items():
            _draw_place(axes, columns.index(column), rows.index(row), found)
        axes.set_xticks(range(len(columns)), columns)
        axes.set_yticks(range(len(rows)), rows)
        axes.set(xlim=(-0.5, len(columns) - 0.5), ylim=(len(rows) - 0.5, -0.5), xlabel=sweep.columns, ylabel=sweep.rows)
        axes.set_title(f"{sweep.title}: energy not accounted for [%]")
        axes.grid(False)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        _legend(figure)
        figure.savefig(path, dpi=DOTS_PER_INCH)


def _draw_place(axes, column: int, row: int, verdicts: Sequence[Verdict]) -> None:
    from matplotlib.patches import Rectangle

    kind = worst(verdicts)
    axes.add_patch(Rectangle((column - 0.48, row - 0.46), 0.96, 0.92, color=COLOURS[kind], linewidth=0))
    style = {"color": "white", "weight": "bold"} if kind in FAILURES else {"color": "#222222"}
    axes.text(column, row, _label(kind, verdicts), ha="center", va="center", fontsize=8.5, **style)


def _label(kind: str, verdicts: Sequence[Verdict]) -> str:
    if kind in (STOPPED, REFUSED):
        return kind
    errors = [100.0 * abs(v.balance_error) for v in verdicts if v.kind == kind]
    largest = max(errors, default=float("nan"))
    if not isfinite(largest):
        return "NaN"
    if largest >= 1000.0:
        return "> 999"
    return f"{largest:.0f}" if largest >= 9.95 else f"{largest:.1f}" if largest >= 0.095 else "< 0.1"


def draw_overview(found: Sequence[tuple[Sweep, Sequence[Verdict]]], path: Path) -> None:
    """Draw all sweeps as bars: how many runs got which verdict."""
    with drawing():
        figure = new_figure(8.5, 0.36 * len(found) + 1.6)
        axes = figure.add_subplot()
        for row, (_, verdicts) in enumerate(found):
            left, kinds = 0.0, [verdict.kind for verdict in verdicts]
            for kind in KINDS:
                share = 100.0 * kinds.count(kind) / len(kinds)
                axes.barh(row, share, 0.8, left, color=COLOURS[kind])
                if share > 3.0:
                    text = {"color": "white", "weight": "bold"} if kind in FAILURES else {"color": "#222222"}
                    axes.text(
                        left + 0.5 * share, row, kinds.count(kind), ha="center", va="center", fontsize=8.5, **text
                    )
                left += share
        axes.set_yticks(range(len(found)), [sweep.title for sweep, _ in found])
        axes.set(xlim=(0, 100), ylim=(len(found) - 0.5, -0.5), xlabel="share of the runs [%]")
        axes.set_title("What came of every run (number of runs)")
        axes.grid(False)
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
        _legend(figure)
        figure.savefig(path, dpi=DOTS_PER_INCH)


def _legend(figure) -> None:
    from matplotlib.patches import Patch

    handles = [Patch(color=COLOURS[kind], label=MEANINGS[kind]) for kind in KINDS]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, handlelength=1.0)
