"""The report: run_time_against_error.md with its pictures and a table of all measurements."""

import csv
import time
from collections.abc import Callable, Iterable
from math import exp, isfinite, log
from pathlib import Path

from rfmpm.benchmark.engine import bar, column, figures, plan, slopes, speed, vortex
from rfmpm.benchmark.engine.runs import Measurement
from rfmpm.benchmark.engine.schemes import ENGINES, Scheme
from rfmpm.benchmark.engine.verdict import HEAD, SPEED, VERDICT

SCENES = {
    "column": (column.TITLE, column.ERRORS),
    "bar": (bar.TITLE, bar.ERRORS),
    "vortex": (vortex.TITLE, vortex.ERRORS),
    "slope": (slopes.TITLES["slope"], slopes.ERRORS["slope"]),
    "bars": (slopes.TITLES["bars"], slopes.ERRORS["bars"]),
}
NAME = "run_time_against_error"


def run(out: Path, quick: bool, say: Callable[[str], None]) -> Path:
    """Measure, draw and write.

    Args:
        out: folder of the report; made if missing.
        quick: a few coarse runs only: a look at the machinery, whose figures mean nothing.
        say: told of each scene that is done.

    Returns:
        The report.
    """
    out.mkdir(parents=True, exist_ok=True)
    started, sections, everything = time.perf_counter(), [], []
    for name, (title, errors) in SCENES.items():
        try:
            measured, words = _measure(name, quick)
        except slopes.Missing as missing:
            sections.append(f"## {title}\n\nNot run: {missing}.\n")
            say(f"{name}: not run, {missing}")
            continue
        picture = out / f"{NAME}_{name}.png"
        figures.draw(measured, title, errors, picture)
        sections.append(_section(title, errors, measured, words, picture.name))
        everything += measured
        say(f"{name}: {len(measured)} runs, {time.perf_counter() - started:.0f} s so far")
    if quick:
        speeds = speed.measure(0.5, 1, shapes=["quadratic_bspline"])
    else:
        speeds = [one for cell in (0.25, 0.0625) for one in speed.measure(cell, 8)]
    _write_table(everything, out / f"{NAME}.csv")
    text = [HEAD.format(table=f"{NAME}.csv"), VERDICT, _ranking(everything), *sections, _speed_table(speeds)]
    path = out / f"{NAME}.md"
    path.write_text("\n".join(text), encoding="utf-8")
    return path


def _measure(name: str, quick: bool) -> tuple[list[Measurement], str]:
    if name == "slope":
        return plan.slope_runs(quick)
    runs = {"column": plan.column_runs, "bar": plan.bar_runs, "vortex": plan.vortex_runs, "bars": plan.bars_runs}
    return list(runs[name](quick)), ""


def _section(title: str, errors: dict[str, str], measured: list[Measurement], words: str, picture: str) -> str:
    lines = [f"## {title}", "", words, "", f"![{title}: error against CPU time]({picture})", ""]
    for name, label in errors.items():
        lines += [
            f"Pareto front, {label}:",
            "",
            "| code | scheme | cell [m] | error | CPU time [s] |",
            "|---|---|---|---|---|",
        ]
        for engine, text in ENGINES.items():
            lines += [
                f"| {text} | {one.scheme.label} | {one.cell:.4g} | {one.errors[name]:.3g} | {one.cpu_time:.3g} |"
                for one in figures.front([one for one in measured if one.scheme.engine == engine], name)
            ]
        lines.append("")
    broken = sorted({one.scheme.label for one in measured if not all(map(isfinite, one.errors.values()))})
    if broken:
        lines += ["Broken on at least one grid (a point left the domain): " + "; ".join(broken) + ".", ""]
    return "\n".join(lines)


def _ranking(measured: Iterable[Measurement]) -> str:
    """Errors and costs of the plain solver's schemes over those of quadratic B-splines with the default transfer."""
    kept = [one for one in measured if one.scheme.engine == "plain"]
    names = list(dict.fromkeys((one.scene, error) for one in kept for error in one.errors))
    basis = {(one.scene, one.cell): one for one in kept if one.scheme == Scheme("quadratic_bspline")}
    schemes = list(dict.fromkeys(one.scheme for one in kept))
    lines = [
        "| scheme | " + " | ".join(f"{scene}: {error}" for scene, error in names) + " | CPU time |",
        "|---" * (len(names) + 2) + "|",
    ]
    for scheme in schemes:
        own = [one for one in kept if one.scheme == scheme and (one.scene, one.cell) in basis]
        entries = [
            _mean(
                one.errors[error] / basis[one.scene, one.cell].errors[error]
                for one in own
                if one.scene == scene and basis[one.scene, one.cell].errors[error] > 0.0
            )
            for scene, error in names
        ]
        cost = _mean(one.cpu_time / basis[one.scene, one.cell].cpu_time for one in own)
        lines.append(f"| {scheme.label} | {' | '.join(entries)} | {cost} |")
    return "\n".join(lines) + "\n"


def _mean(ratios: Iterable[float]) -> str:
    """Geometric mean in words."""
    ratios = list(ratios)
    if not ratios:
        return ""
    if not all(isfinite(ratio) and ratio > 0.0 for ratio in ratios):
        return "broken"
    return f"{exp(sum(map(log, ratios)) / len(ratios)):.2g}"


def _speed_table(speeds: list[speed.Speed]) -> str:
    yardstick = {one.points: one.nanoseconds for one in speeds if one.label.startswith("three plain loops")}
    counts = list(yardstick)
    lines = [
        SPEED,
        "| code | " + " | ".join(f"{count:,} points: ns, ratio" for count in counts) + " |",
        "|---" * (len(counts) + 1) + "|",
    ]
    for label in dict.fromkeys(one.label for one in speeds):
        entries = {one.points: one.nanoseconds for one in speeds if one.label == label}
        lines.append(
            f"| {label} | "
            + " | ".join(f"{entries[count]:.1f}, {entries[count] / yardstick[count]:.2f}" for count in counts)
            + " |"
        )
    return "\n".join(lines) + "\n"


def _write_table(measured: list[Measurement], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["scene", *Scheme.__dataclass_fields__, "cell_m", "cpu_time_s", "error", "value"])
        for one in measured:
            scheme = [getattr(one.scheme, name) for name in Scheme.__dataclass_fields__]
            for name, value in one.errors.items():
                table.writerow([one.scene, *scheme, one.cell, f"{one.cpu_time:.4g}", name, f"{value:.6g}"])
