"""The short slope of the papers as it is run here, and what its runs are judged by: the bands that cut its crest."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from rfmpm.benchmark.papers.case import simulate, study
from rfmpm.outcome import Outcome
from rfmpm.quantities.state import label_cells
from rfmpm.study import Study

STUDY = "vardon_2017_short_slope"
CELL, CREST = "discretisation.cell_m", "geometry.crest_m"
RESIDUAL, MODULUS = "material.0.residual_cohesion_kpa", "material.0.softening_modulus_kpa"
COARSE, FINER = {CELL: 0.5}, {CELL: 0.125}  # [m]
EVERY = 1_000_000  # snapshots: all looks of the run, ten in a second
PARTED = 1.0  # [m]: how far behind each other bands count as two
SMALLEST_PIECE = 0.25  # [m2]: four cells


class Cut(NamedTuple):
    """A band that cuts the crest off: points at residual strength lead from the base to the crest."""

    time: float  # [s]
    distance: float  # behind the edge of the crest, at the start [m]


class Piece(NamedTuple):
    """Connected soil above its residual strength that has a part of the crest."""

    back: float  # x of its part of the crest, at the start [m]
    front: float
    area: float  # at the start [m2]
    settlement: float  # mean of its part of the crest [m]


@dataclass(frozen=True)
class Run:
    """A run of the slope with all its looks."""

    study: Study
    outcome: Outcome

    @property
    def quantities(self) -> dict[str, Any]:
        """Of the end, by name."""
        return self.outcome.quantities

    @cached_property
    def residual_strain(self) -> np.ndarray:
        """Plastic strain at which the points come down to their residual strength, shape (n,) [-]."""
        soil, cell = self.study.material[0], self.study.discretisation.cell_m
        modulus = 1e3 * soil.softening_modulus_kpa * cell / soil.softening_reference_cell_m
        return self.outcome.points["cohesion"] * (1.0 - soil.residual_cohesion_kpa / soil.cohesion_kpa) / modulus

    @cached_property
    def cuts(self) -> list[Cut]:
        """The bands that cut the crest, each more than PARTED behind the one before."""
        crest, found = self.study.geometry.crest_m, []
        for time, points in self.outcome.frames:
            distance = crest - self.standing(points)
            if distance > PARTED + (found[-1].distance if found else 0.0):
                found.append(Cut(time, distance))
        return found

    def at(self, time: float) -> dict[str, np.ndarray]:
        """The points at the look nearest to a time [s]."""
        return min(self.outcome.frames, key=lambda frame: abs(frame[0] - time))[1]

    def standing(self, points: dict[str, np.ndarray]) -> float:
        """Where the crest ends that no band has cut off from the corner at the base behind it: initial x [m]."""
        x, y, group, top = self._whole(points)
        own = top & (group == group[np.argmin(x + y)])
        return float(x[own].max() + 0.5 * self.spacing) if own.any() else 0.0

    def pieces(self, points: dict[str, np.ndarray]) -> list[Piece]:
        """The pieces that the bands cut the crest into, from the back to the front."""
        x, _, group, top = self._whole(points)
        whole = points["plastic_strain"] < self.residual_strain
        areas = np.bincount(group) * self.spacing**2
        sunk = -points["displacement_y"][whole]
        parts = [(top & (group == number), areas[number]) for number in np.unique(group[top])]
        return sorted(
            Piece(float(x[own].min()), float(x[own].max()), float(area), float(sunk[own].mean()))
            for own, area in parts
            if area >= SMALLEST_PIECE
        )

    @property
    def spacing(self) -> float:
        """Of the points in a full cell [m]."""
        return self.study.discretisation.cell_m / np.sqrt(self.study.discretisation.points_per_cell)

    def _whole(self, points: dict[str, np.ndarray]):
        """Points above their residual strength: x and y at the start, connected group, and which lie in the crest."""
        whole = points["plastic_strain"] < self.residual_strain
        x, y = points["x_initial"][whole], points["y_initial"][whole]
        top = y > self.study.geometry.height_m - self.spacing
        return x, y, label_cells(x, y, self.spacing, diagonal=False), top


def run(changes: dict[str, Any] | None = None) -> Run:
    """Run the slope with some keys changed, keeping every look."""
    asked = study(STUDY, changes)
    return Run(asked, simulate(asked, frames=EVERY))
