"""The pages: one for each case with its pictures, and one that lists what every case came to."""

import csv
import os
import time
from collections.abc import Callable, Iterable
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers import CASES
from rfmpm.benchmark.papers.case import Case, Finding, Reproduction

FINDINGS = "findings.csv"
COLUMNS = ("case", "said", "criterion", "found", "agrees", "reason", "seconds")


def write(names: Iterable[str], folder: Path, command: str, tell: Callable[[str], None], coarse: bool = False) -> Path:
    """Run cases and write their pages; those of other cases stay as they are.

    Args:
        names: of the cases, keys of CASES.
        folder: where the pages and pictures go; made if missing.
        command: that makes all pages, to be named in them; a case's name behind it makes that case's.
        tell: is told what each case comes to, line by line.
        coarse: whether to run on coarse cells, for a quick look.

    Returns:
        The path of the list.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        started = time.perf_counter()
        case = CASES[name]
        found = case.reproduce(coarse)
        seconds = time.perf_counter() - started
        _write_page(name, case, found, folder, f"{command} {name}", seconds)
        _keep(folder / FINDINGS, name, found.findings, seconds)
        tell(f"{name}: {sum(one.agrees for one in found.findings)} of {len(found.findings)} agree, {seconds:.0f} s")
    return _write_list(folder, command)


def _write_page(name: str, case: Case, found: Reproduction, folder: Path, command: str, seconds: float) -> None:
    pictures = []
    for number, figure in enumerate(found.figures, 1):
        path = folder / (f"{name}.png" if number == 1 else f"{name}_{number}.png")
        figure.draw(path)
        pictures.append(f"![{figure.caption}]({path.name})\n\n{figure.caption}\n")
    reasons = [f"- *{one.said}*: {one.reason}" for one in found.findings if not one.agrees]
    disagreement = ["## Where it disagrees, and why\n", "\n".join(reasons) + "\n"] if reasons else []
    studies = ", ".join(f"[{study}](../../configs/papers/{study}.toml)" for study in case.studies)
    parts = [
        f"# {case.title}\n",
        f"{case.document}. {case.says}\n",
        f"Made by `{command}` in {seconds:.0f} s (load {os.getloadavg()[0]:.1f}) from {studies}.\n",
        table("the paper | criterion | found | ", map(_judged, found.findings)) + "\n",
        *pictures,
        found.text,
        *disagreement,
        f"## What the paper leaves open\n\n{case.left_open}\n",
        "[All cases](index.md)\n",
    ]
    (folder / f"{name}.md").write_text("\n".join(parts), encoding="utf-8")


def _judged(one: Finding) -> str:
    return f"{one.said} | {one.criterion} | {one.found} | {'agrees' if one.agrees else '**disagrees**'}"


def _keep(path: Path, name: str, findings: list[Finding], seconds: float) -> None:
    """Put the findings of a case in the place of its earlier ones."""
    others = [row for row in _read(path) if row["case"] != name]
    rows = [one._asdict() | {"case": name, "seconds": f"{seconds:.0f}"} for one in findings]
    order = list(CASES)
    every = sorted((row for row in [*others, *rows] if row["case"] in CASES), key=lambda row: order.index(row["case"]))
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(every)


def _read(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _write_list(folder: Path, command: str) -> Path:
    rows, agreed, judged, seconds = [], 0, 0, 0.0
    for name, group in groupby(_read(folder / FINDINGS), key=itemgetter("case")):
        findings = list(group)
        agree = sum(one["agrees"] == "True" for one in findings)
        against = "; ".join(one["said"] for one in findings if one["agrees"] != "True") or "nothing"
        rows.append(
            f"[{CASES[name].title}]({name}.md) | {CASES[name].document} | {agree} of {len(findings)} | {against}"
        )
        agreed, judged, seconds = agreed + agree, judged + len(findings), seconds + float(findings[0]["seconds"])
    path = folder / "index.md"
    text = HEAD.format(command=command, agreed=agreed, judged=judged, minutes=seconds / 60.0,
                       rows=table("case | document | agrees | disagrees", rows))  # fmt: skip
    path.write_text(text, encoding="utf-8")
    return path


HEAD = """# The papers, run again

Made by `{command}`, which takes {minutes:.0f} minutes; with a case's name behind it, it makes that case again.

Every total-stress simulation of the papers that this program rests on. They show pictures and say in words what is
seen; each statement is judged here by a number or an order that is computed from the run: {agreed} of {judged} agree.
What a paper leaves open, and what was chosen, is said on each page; so is the reason of a disagreement, as far as it is
found.

{rows}

All findings: [findings.csv](findings.csv).
"""
