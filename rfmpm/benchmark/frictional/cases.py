"""How the published cases are run, and what the page is made of."""

from typing import Any, NamedTuple

from rfmpm.benchmark.papers.case import simulate, study
from rfmpm.outcome import Outcome

CELL = "discretisation.cell_m"


def collapse(name: str, changes: dict[str, Any]) -> Outcome:
    """Simulate a study of `configs/papers` with some keys changed."""
    return simulate(study(name, changes))


class Section(NamedTuple):
    """A part of the page."""

    text: str
    findings: list[str]  # lines of the summary


def finding(what: str, asked: str, ours: str, is_met: bool) -> str:
    """A line of the summary."""
    return f"{what} | {asked} | {ours} | {'met' if is_met else '**not met**'}"
