"""The report of what is saved by each thing that a scene does not need and the program skips: savings.md."""

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from rfmpm.benchmark import skips


def run(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Measure every saving and write the report.

    Args:
        folder: where savings.md goes; made if missing.
        quick: coarser cells, a shorter time and one repeat.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    bench = skips.Bench(0.5, 2.0, 1) if quick else skips.Bench(0.25, 40.5, 3)
    lines = []
    for saving in _all(bench):
        ratio = saving.done / saving.skipped
        lines.append(f"| {saving.what} | {saving.skipped:.3g} | {saving.done:.3g} | {ratio:.2f} | {saving.remark} |")
        tell(f"{saving.what}: {ratio:.2f}")
    points, cell = len(bench.plain.scene.points.mass), bench.study.discretisation.cell_m
    path = folder / "savings.md"
    path.write_text(
        REPORT.format(cell=cell, points=points, rows="\n".join(lines), quiet=skips.quiet_regions(bench)),
        encoding="utf-8",
    )
    return path


def _all(bench: skips.Bench) -> Iterator[skips.Saving]:
    yield skips.untouched_cells(bench)
    yield skips.shared_stress(bench)
    yield skips.shared_factor(bench)
    yield skips.no_field(bench)
    for residual in (4.0, 8.0, 12.0):
        yield skips.stop_at_rest(bench, residual)
    for residual in (4.0, 8.0, 12.0):
        yield skips.damp_what_swings(bench, residual)
    yield skips.step_of_the_moment(bench)
    yield skips.filter_at_intervals(bench)
    yield skips.no_snapshots(bench)
    yield skips.no_history(bench)
    yield skips.light_command(bench, ["--help"])
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.toml"
        study.write_text(bench.study.to_toml(), encoding="utf-8")
        yield skips.light_command(bench, ["check", str(study)])


REPORT = """\
# What is saved by skipping what a scene does not need

Made by `rfmpm benchmark savings`: the short slope, residual cohesion 4 kPa, cells of {cell:g} m, {points} points. Each
line is measured in the same run with and without the needless work, which take turns (least of several repeats, in
seconds); a ratio of 1 means that skipping it brings nothing.

| skipped | with the skip [s] | without [s] | ratio | |
|---|---|---|---|---|
{rows}

Not skipped: regions that neither move nor yield. Points that moved less than 1 mm and have no plastic strain at the
end: {quiet}. That is the
most that leaving them out could save of the work on points.
"""
