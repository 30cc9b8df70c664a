"""The report of the factors of safety: safety.md, its pictures and its rows."""

import time
from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.safety.cases import SLIDE_BY_XSLOPE, Case, all_cases, short_slope
from rfmpm.benchmark.safety.fields import CHECKED, DISPLACEMENTS, SCENES, Row, measure, shares, write_rows
from rfmpm.benchmark.safety.peer import Peer, compare
from rfmpm.benchmark.safety.pictures import draw_fields
from rfmpm.benchmark.safety.text import REPORT
from rfmpm.stability import critical_surface, factor_along, sides_of

HOLDING = "base holds"  # the scene in which the factor is proportional to strength
RATIO = 4.0 / 20.0  # residual over peak strength in the study
REPEATS = 3  # of which the fastest counts


class Answer(NamedTuple):
    """What a method found for a case."""

    circle: float
    best: float  # of any shape
    kind: str
    seconds: float  # processor time of the search


def run(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Find the factors of all cases, judge random fields both ways and write the report.

    Args:
        folder: where safety.md, its pictures and rows go; made if missing.
        quick: a few cases and fields only.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    cases = all_cases()[:: 6 if quick else 1]
    lines = []
    for case in cases:
        lines += [_line(case, method, solve(case, method)) for method in case.methods]
        tell(f"{case.name}: done")
    rows, taken = measure(quick, tell, folder / "safety_rows.csv")
    write_rows(rows, folder / "safety_rows.csv")
    examples = draw_fields(rows, folder / "safety.png", folder / "safety_examples.png")
    path = folder / "safety.md"
    path.write_text(in_words(lines, peer_in_words(compare()), rows, examples, taken), encoding="utf-8")
    return path


def in_words(lines: list[str], peer: str, rows: list[Row], examples: str, taken: int) -> str:
    """Make the text of the report from the lines of its first table, the second, and the rows of the fields."""
    origin = "All were simulated in this run."
    if taken:
        origin = (
            f"The displacements of {taken} of the {len(rows)} rows were kept from an earlier run; one in {CHECKED} "
            "was simulated again in this one and is the same to six digits. All factors are of this run."
        )
    return REPORT.format(
        source=SLIDE_BY_XSLOPE,
        origin=origin,
        bases="\n".join(_base_line(friction, known) for friction, known in BASES),
        cases="\n".join(lines),
        peer=peer,
        scenes="\n".join(_scene_line(rows, scene) for scene in SCENES),
        strengths="\n".join(_strength_line(rows, name, factor) for name, factor in STRENGTHS.items()),
        displacements="\n".join(_displacement_line(rows, limit) for limit in DISPLACEMENTS),
        examples=examples,
        **_headline(rows),
    )


BASES = ((inf, 1.224), (0.3, 1.10))  # friction, and factor of the short slope by limit analysis
STRENGTHS = {"peak": 1.0, "mean of peak and residual": 0.5 * (1.0 + RATIO), "residual": RATIO}


def solve(case: Case, method: str) -> Answer:
    """Find the factor of a case by a method, on circles and on surfaces of any shape.

    Args:
        case: the case.
        method: one of its methods.

    Returns:
        The answer.
    """
    sides, took = sides_of(case.section), []
    if case.surface is not None:
        found = factor_along(sides[0], *case.soil, case.surface, method)
        return Answer(inf, found, "given", 0.0)
    circle = critical_surface(sides, *case.soil, method, circles_only=True)
    for _ in range(REPEATS):
        started = time.process_time()
        found = critical_surface(sides, *case.soil, method)
        took.append(time.process_time() - started)
    return Answer(circle.factor, found.factor, found.kind, min(took))


def error_of(case: Case, factor: float) -> float:
    """Relative distance of a factor from the known one, or from the nearer end of the known range."""
    if factor > case.most:
        return factor / case.most - 1.0
    return min(factor / case.least - 1.0, 0.0)


def _line(case: Case, method: str, answer: Answer) -> str:
    known = f"{case.least:.3f}" if case.least == case.most else f"{case.least:.3f} to {case.most:.3f}"
    cells = [case.name, case.source, known, method.replace("_", "-")]
    cells += [_found(case, answer.circle), _found(case, answer.best) if method != "bishop" else ""]
    return f"| {' | '.join([*cells, f'{1e3 * answer.seconds:.0f}' if answer.seconds else ''])} |"


def _found(case: Case, factor: float) -> str:
    return "" if factor == inf else f"{factor:.3f} ({100.0 * error_of(case, factor):+.1f} %)"


def _scene_line(rows: list[Row], scene: str) -> str:
    first = min(sum(row.scene == name for row in rows) for name in SCENES)
    found = shares(rows, scene, first)
    return (
        f"| {scene} | {found['fields']} | {found['weak']:.2f} | {found['moved']:.2f} | {found['safe_but_moved']:.2f} "
        f"| {found['weak_but_still']:.2f} | {found['parting']:.2f} |"
    )


def _base_line(friction: float, known: float) -> str:
    section, soil = short_slope()
    found = critical_surface(sides_of(section._replace(base_friction=friction)), *soil).factor
    name = "holds" if friction == inf else f"{friction:g}"
    return f"| {name} | {known:.3f} | {found:.3f} ({100.0 * (found / known - 1.0):+.1f} %) |"


def _strength_line(rows: list[Row], name: str, factor: float) -> str:
    own = [row.factor * factor for row in rows if row.scene == HOLDING]
    return f"| {name} | {sum(own) / len(own):.3f} | {sum(value < 1.0 for value in own) / len(own):.3f} |"


def _displacement_line(rows: list[Row], limit: float) -> str:
    own = [row.displacement > limit for row in rows if row.scene == "as it is"]
    return f"| {limit:g} | {sum(own) / len(own):.3f} |"


def _headline(rows: list[Row]) -> dict[str, str]:
    found = shares(rows, "as it is")
    own = [row for row in rows if row.scene == "as it is" and row.displacement > DISPLACEMENTS[0]]
    still = [row.factor for row in rows if row.scene == "as it is" and row.displacement <= DISPLACEMENTS[0]]
    held = shares(rows, HOLDING)["moved"]
    equal = float(np.quantile([row.factor for row in rows if row.scene == HOLDING], held))
    both = [row for row in rows if row.scene == list(SCENES)[-1]]
    stood = [row.factor for row in both if row.factor < 1.0 and row.displacement <= DISPLACEMENTS[0]]
    return {
        "share": f"{100.0 / equal:.0f}",
        "lowest_that_stopped": f"{min(stood, default=1.0):.2f}",
        "count": str(found["fields"]),
        "weak": f"{found['weak']:.2f}",
        "moved": f"{found['moved']:.2f}",
        "safe_but_moved": f"{found['safe_but_moved']:.2f}",
        "weak_but_still": f"{found['weak_but_still']:.2f}",
        "highest_that_moved": f"{max((row.factor for row in own), default=0.0):.2f}",
        "lowest_that_stood": f"{min(still, default=inf):.2f}",
    }


def peer_in_words(peers: list[Peer]) -> str:
    if not peers:
        return "No other package is installed here (`pip install pyslope` for the comparison)."
    lines = ["| case | rfmpm, bishop | ms | pyslope, bishop | ms | times as long |", "|---|---|---|---|---|---|"]
    for peer in peers:
        lines.append(
            f"| {peer.name} | {peer.own:.3f} | {1e3 * peer.own_seconds:.0f} | {peer.other:.3f} | "
            f"{1e3 * peer.other_seconds:.0f} | {peer.other_seconds / peer.own_seconds:.1f} |"
        )
    return "\n".join(lines)
