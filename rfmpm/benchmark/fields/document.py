"""The report: fields.md and its picture."""

from collections.abc import Callable
from pathlib import Path

from rfmpm.benchmark.fields.cases import CASES, QUICK_CASES, Case
from rfmpm.benchmark.fields.labels import place_names
from rfmpm.benchmark.fields.measure import Measurement, measure
from rfmpm.benchmark.fields.peers import PEERS, installed

SMALLEST_SHOWN = 1e-13  # errors of rounding alone are drawn there
HEAD = """# Random fields: run time against error

`rfmpm benchmark fields` wrote this. Scales of fluctuation 6 m and 0.5 m, points 0.125 m apart. Times are CPU
milliseconds of one process for one realisation, the least of many repeats. *Field* is from xi to the field at the
points; *numbers* is what numpy takes to draw xi, which our methods take as given; a peer draws its own numbers within
its time, so ratios are of a peer's time to the sum of both of ours. The error of our methods is the largest difference
between the covariance of the field and the asked one, from the linear map or the eigenvalues, over all lags; that of a
peer is the largest found in a sample at lags up to two theta along both axes, with its standard error, so that it is
never below about that. Peers found: {peers}.
"""


def run(out: Path, quick: bool, say: Callable[[str], None]) -> Path:
    """Measure, draw and write.

    Args:
        out: folder of the report; made if missing.
        quick: two small cases: a look at the machinery.
        say: told of each case that is done.

    Returns:
        the report.
    """
    out.mkdir(parents=True, exist_ok=True)
    sections, everything = [], []
    for case in QUICK_CASES if quick else CASES:
        measured = list(measure(case, quick))
        sections.append(_section(case, measured))
        everything.append((case, measured))
        say(f"{case.name}: {len(measured)} measured")
    draw(everything, out / "fields.png")
    picture = "![Covariance error against CPU time of one realisation](fields.png)\n"
    path = out / "fields.md"
    head = HEAD.format(peers=", ".join(installed()) or f"none of {', '.join(PEERS)}")
    path.write_text("\n".join([head, picture, *sections]), encoding="utf-8")
    return path


def _section(case: Case, measured: list[Measurement]) -> str:
    lines = [
        f"## {case.name[0].upper()}{case.name[1:]}",
        "",
        "| | prepare | field | numbers | covariance error | memory [MB] | |",
        "|---|---|---|---|---|---|---|",
    ]
    for one in measured:
        noise = f" +- {one.noise:.1g}" if one.noise else ""
        numbers = f"{one.numbers:.3g}" if one.numbers else "within"
        error = f"{one.error:.2g}" if one.error == one.error else ""
        memory = f"{one.memory:.3g}" if one.memory == one.memory else ""
        lines.append(
            f"| {one.name} | {one.preparing:.3g} | {one.drawing:.3g} | {numbers} | {error}{noise} | {memory} | "
            f"{one.remark} |"
        )
    return "\n".join([*lines, "", *_verdicts(case, measured), ""])


def _verdicts(case: Case, measured: list[Measurement]) -> list[str]:
    """What was asked of the first method, and what was found."""
    ours, found = measured[0], {one.name: one for one in measured}
    words = []
    for name, asked in case.targets.items():
        if name == "ms":
            met = "met" if ours.drawing <= asked else "not met"
            words.append(
                f"- Asked: at most {asked:g} ms. Found: {ours.drawing:.3g} ms, with random numbers {ours.total:.3g} ms"
                f" ({met} for the field alone)."
            )
        elif name in found:
            whole, alone = found[name].drawing / ours.total, found[name].drawing / ours.drawing
            met = "met" if whole >= asked else "met for the field alone" if alone >= asked else "not met"
            words.append(
                f"- Asked: {asked:g} times {name}. Found: {whole:.3g} times, {alone:.3g} for the field alone: {met}."
            )
    return words


def draw(everything: list[tuple[Case, list[Measurement]]], path: Path) -> None:
    """Draw covariance error against CPU time, a panel per case, and write the figure."""
    from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREY, VERMILION, drawing, new_figure

    rows = (len(everything) + 1) // 2
    with drawing():
        figure = new_figure(11.0, 3.4 * rows)
        panels = figure.subplots(rows, 2, squeeze=False).ravel()
        labelled = []
        for axes, (case, measured) in zip(panels, everything, strict=False):
            shown = [one for one in measured if one.error == one.error]
            places = [(one.total, max(one.error, SMALLEST_SHOWN)) for one in shown]
            for one, place in zip(shown, places, strict=True):
                marker, colour = ("s", VERMILION) if one.name in PEERS else ("o", BLUE)
                axes.plot(*place, marker=marker, linestyle="", color=colour)
            axes.set(xscale="log", yscale="log", title=case.name, xlabel="CPU time of one realisation [ms]")
            axes.set_ylabel("largest covariance error")
            axes.set_ylim(1e-14, 10.0)
            axes.margins(x=0.35)
            labelled.append((axes, places, [one.name.replace("local_average_subdivision", "LAS") for one in shown]))
        for axes in panels[len(everything) :]:
            axes.set_axis_off()
        figure.set_dpi(DOTS_PER_INCH)
        figure.draw_without_rendering()  # settles the layout: names have their final extents only then
        for axes, places, names in labelled:
            place_names(axes, places, names, fontsize=7.5, color=GREY)
        figure.savefig(path, dpi=DOTS_PER_INCH)
