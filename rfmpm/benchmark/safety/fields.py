"""The same random fields judged twice: by their factor of safety, and by how far they move in the simulation."""

from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rfmpm.benchmark.stability.case import SLOPE, random_strength
from rfmpm.realisation import prepare, simulate, stability
from rfmpm.study import load_study

COUNT, COUNT_OF_OTHERS = 500, 100
DISPLACEMENTS = (0.5, 2.0, 5.0)  # [m]
STUDY = {
    **SLOPE,
    "study": {"name": "factor of safety against displacement", "seed": 20160901},
    "random_field": {"cohesion": random_strength(0.25, 6.0, 1.0)},
    "time": {"end_s": 40.5},
    "quantities": {"factor_of_safety": "bishop"},
}
HOLDS = {"boundary.base": {"kind": "fixed"}}
KEEPS = {"material.0.residual_cohesion_kpa": 20.0}
SCENES = {  # what else may decide, taken away
    "as it is": {},
    "base holds": HOLDS,
    "strength stays": KEEPS,
    "base holds, strength stays": {**HOLDS, **KEEPS},
}
CHECKED = 20  # one in so many of the displacements kept from an earlier run is simulated again
COLUMNS = ("scene", "index", "factor", "displacement", "failure_volume", "run_out")


class Row(NamedTuple):
    """One field in one scene."""

    scene: str
    index: int
    factor: float  # by Bishop, of the peak strength [-]
    displacement: float  # largest of all material points [m]
    failure_volume: float  # [m3/m]
    run_out: float  # [m]


def study_of(scene: str) -> Any:
    """The study of a scene."""
    return load_study(STUDY).with_changes(SCENES[scene])


def measure(quick: bool, tell: Callable[[str], None], kept: Path | None = None) -> tuple[list[Row], int]:
    """Find factor and displacement of every field in every scene.

    Args:
        quick: a few fields only.
        tell: is told the progress, line by line.
        kept: rows of an earlier run; their displacements are taken if one in CHECKED, simulated again, is the same.

    Returns:
        The rows, and how many of the displacements are of the earlier run.
    """
    rows, taken, known = [], 0, read_rows(kept) if kept and kept.is_file() else {}
    for number, scene in enumerate(SCENES):
        count = 4 if quick else COUNT_OF_OTHERS if number else COUNT
        prepared = prepare(study_of(scene))
        old = {index: known[scene, index] for index in range(count) if (scene, index) in known}
        new = {index: _simulated(prepared, scene, index) for index in list(old)[::CHECKED]}
        if any(_told(row)[3:] != _told(old[index])[3:] for index, row in new.items()):
            old = {}
        for index in range(count):
            if index not in new and index in old:
                new[index] = old[index]._replace(factor=stability(prepared, "bishop", index)[0].factor)
                taken += 1
            elif index not in new:
                new[index] = _simulated(prepared, scene, index)
        rows += [new[index] for index in range(count)]
        tell(f"{count} fields, {scene}: done")
    return rows, taken


def _simulated(prepared: Any, scene: str, index: int) -> Row:
    outcome = simulate(prepared, index)
    moved = np.hypot(outcome.points["displacement_x"], outcome.points["displacement_y"])
    found = outcome.quantities
    numbers = (found["factor_of_safety"], moved.max(), found["failure_volume"], found["run_out"])
    return Row(scene, index, *map(float, numbers))


def write_rows(rows: list[Row], path: Path) -> None:
    """Keep the rows as a table of comma-separated values."""
    lines = [",".join(_told(row)) for row in rows]
    path.write_text("\n".join([",".join(COLUMNS), *lines]) + "\n", encoding="utf-8")


def read_rows(path: Path) -> dict[tuple[str, int], Row]:
    """Rows kept by `write_rows`, by scene and index."""
    lines = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    rows = [Row(scene.replace(";", ","), int(index), *map(float, values)) for scene, index, *values in lines]
    return {(row.scene, row.index): row for row in rows}


def _told(row: Row) -> list[str]:
    """A row in words: six digits of each number."""
    return [row.scene.replace(",", ";"), *(f"{value:.6g}" for value in row[1:])]


def shares(rows: list[Row], scene: str, least: float = inf) -> dict[str, float]:
    """Shares of the first fields of a scene: weak by the factor, moved, both ways of disagreeing; what parts them."""
    own = [row for row in rows if row.scene == scene and row.index < least]
    weak = np.array([row.factor < 1.0 for row in own])
    moved = np.array([row.displacement > DISPLACEMENTS[0] for row in own])
    return {
        "fields": len(own),
        "weak": float(weak.mean()),
        "moved": float(moved.mean()),
        "safe_but_moved": float((~weak & moved).mean()),
        "weak_but_still": float((weak & ~moved).mean()),
        "parting": parting(own),
    }


def parting(rows: list[Row]) -> float:
    """The factor below which most of those that moved lie, and above which most of those that did not."""
    factor = np.array([row.factor for row in rows])
    moved = np.array([row.displacement > DISPLACEMENTS[0] for row in rows])
    candidates = np.linspace(0.8, 1.6, 81)
    return float(candidates[np.argmin([np.sum((factor < candidate) != moved) for candidate in candidates])])
