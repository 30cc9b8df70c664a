"""The studies behind the published cases, and what the page is made of."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from rfmpm import realisation
from rfmpm.outcome import Outcome
from rfmpm.study import Study, load_study

REPOSITORY = Path(__file__).parents[3]
PAPERS = REPOSITORY / "configs" / "papers"
CELL = "discretisation.cell_m"


def study(name: str, changes: dict[str, Any]) -> Study:
    """Load a study of `configs/papers` with some keys changed."""
    return load_study(PAPERS / f"{name}.toml").with_changes(changes)


def collapse(name: str, changes: dict[str, Any]) -> Outcome:
    """Simulate a study of `configs/papers` with some keys changed."""
    return realisation.simulate(realisation.prepare(study(name, changes)))


class Section(NamedTuple):
    """A part of the page."""

    text: str
    findings: list[str]  # lines of the summary


def table(head: str, rows: Iterable[str]) -> str:
    """A table of Markdown; its cells are told apart by |."""
    return "\n".join([f"| {head} |", "|" + "---|" * (head.count("|") + 1), *(f"| {row} |" for row in rows)])


def finding(what: str, asked: str, ours: str, is_met: bool) -> str:
    """A line of the summary."""
    return f"{what} | {asked} | {ours} | {'met' if is_met else '**not met**'}"
