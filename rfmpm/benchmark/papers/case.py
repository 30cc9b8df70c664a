"""What a published simulation is made of here: what it says, what is run, how agreement is judged."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from rfmpm import realisation
from rfmpm.outcome import Outcome
from rfmpm.study import Study, load_study

REPOSITORY = Path(__file__).parents[3]
STUDIES = REPOSITORY / "configs" / "papers"


class Finding(NamedTuple):
    """One statement of a paper, judged by a run."""

    said: str  # by the paper, in its words or nearly
    criterion: str  # what has to be so in the run for it to agree
    found: str
    agrees: bool
    reason: str = ""  # of a disagreement, as far as it is found; empty where they agree


class Figure(NamedTuple):
    """A picture of a page."""

    caption: str
    draw: Callable[[Path], None]  # writes a PNG


class Reproduction(NamedTuple):
    """What the runs of a case came to."""

    findings: list[Finding]
    figures: list[Figure]
    text: str  # Markdown: numbers, and why the pictures look as they do


@dataclass(frozen=True)
class Case:
    """A published simulation."""

    title: str
    document: str  # that it is from
    says: str  # a sentence
    studies: tuple[str, ...]  # of configs/papers, without .toml
    left_open: str  # by the paper, and what is chosen here
    reproduce: Callable[[bool], Reproduction]  # True: on coarse cells, for a quick look


def study(name: str, changes: Mapping[str, Any] | None = None) -> Study:
    """Load a study of `configs/papers` with some keys changed."""
    return load_study(STUDIES / f"{name}.toml").with_changes(changes or {})


def simulate(asked: Study, index: int = 0, frames: int = 0) -> Outcome:
    """Simulate one realisation of a study; with so many snapshots, evenly spread over the time up to rest."""
    return realisation.simulate(realisation.prepare(asked), index, frames=frames)
