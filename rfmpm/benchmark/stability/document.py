"""The stress test from the first case to the report."""

from collections.abc import Callable, Sequence
from pathlib import Path

from rfmpm.benchmark.stability.case import Sweep
from rfmpm.benchmark.stability.guard import Guard
from rfmpm.benchmark.stability.pictures import MEANINGS, draw_overview, draw_sweep
from rfmpm.benchmark.stability.sweeps import all_sweeps, few
from rfmpm.benchmark.stability.verdict import CLOSED, FAIL, KINDS, REFUSED, STOPPED, TOO_FAR_OPEN, UNBALANCED, Verdict

PATIENCE = 600.0  # [s] of computing for one case: a minute of compiling at most, then a million steps in some seconds
EXAMPLES = 4  # of each reason in the report's table

Found = list[tuple[Sweep, list[Verdict]]]

CRITERIA = f"""\
A run is *done* when it came to rest or to its end and a look at its points finds nothing wrong: every value finite,
every volume positive, every point inside the domain and slower than twice a fall from its top, every stress inside the
yield surface (the law answers no strain with no change of stress). The number is the energy that does not close, and
what the numerics added if they added any, as a share of gravity's work, or of the elastic energy at the start where
that is more: closed is up to {100 * CLOSED:g} %, and more than {100 * TOO_FAR_OPEN:g} % is a failure. A run is
*stopped for the right reason* when the engine ended it itself and a run that follows its advice (a quarter of the step,
or a longer foreland) ends well. It is *refused in the right words* when the study is not accepted and the message names
the key. Everything else, a crash of the process and a run without end included, is a failure. Every run goes on in a
process of its own.
"""


def run(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Run the stress test and write its report.

    Args:
        folder: where stability.md and its pictures go; made if missing.
        quick: two cases of each sweep only.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    guard, found = Guard(PATIENCE), []
    try:
        for sweep in few(all_sweeps()) if quick else all_sweeps():
            verdicts = [guard.judge(case) for case in sweep.cases]
            found.append((sweep, verdicts))
            tell(f"{sweep.title}: {_counts(verdicts)}")
    finally:
        guard.close()
    for sweep, verdicts in found:
        draw_sweep(sweep, verdicts, folder / f"stability_{sweep.name}.png")
    draw_overview(found, folder / "stability.png")
    path = folder / "stability.md"
    path.write_text(write_report(found), encoding="utf-8")
    return path


def write_report(found: Found) -> str:
    """The report as Markdown."""
    everything = [verdict for _, verdicts in found for verdict in verdicts]
    lines = [
        "# Will an odd soil break it?",
        "",
        f"Made by `rfmpm benchmark stability`: {len(everything)} runs, {_counts(everything)}.",
        "",
        "![Verdicts of all sweeps](stability.png)",
        "",
        CRITERIA,
        "",
        *_failures(found),
        "## How runs were stopped and refused",
        "",
        *_reasons(found, STOPPED),
        *_reasons(found, REFUSED),
    ]
    for sweep, _ in found:
        lines += ["", f"## {sweep.title}", "", f"![{sweep.title}](stability_{sweep.name}.png)"]
    return "\n".join(lines) + "\n"


def _counts(verdicts: Sequence[Verdict]) -> str:
    kinds = [verdict.kind for verdict in verdicts]
    return ", ".join(f"{kinds.count(kind)} {MEANINGS[kind]}" for kind in KINDS if kind in kinds)


def _failures(found: Found) -> list[str]:
    worst = [*_reasons(found, FAIL), *_reasons(found, UNBALANCED)]
    return ["## What failed", "", *(worst or ["Nothing.", ""])]


def _reasons(found: Found, kind: str) -> list[str]:
    lines = _table(found, kind)
    return [f"{MEANINGS[kind][0].upper()}{MEANINGS[kind][1:]}:", "", *lines, ""] if lines else []


def _table(found: Found, kind: str) -> list[str]:
    """Up to EXAMPLES runs of a kind for each sweep, and how many more there are."""
    lines = []
    for sweep, verdicts in found:
        hits = [(c, v) for c, v in zip(sweep.cases, verdicts, strict=True) if v.kind == kind]
        for case, verdict in hits[:EXAMPLES]:
            words = " ".join(verdict.words.split())
            lines.append(f"| {sweep.title} | {case.row}; {case.column} | {words} |")
        if len(hits) > EXAMPLES:
            lines.append(f"| {sweep.title} | {len(hits) - EXAMPLES} more | |")
    return ["| sweep | run | what came of it |", "|---|---|---|", *lines] if lines else []
