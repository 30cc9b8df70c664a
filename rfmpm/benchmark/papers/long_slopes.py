"""Layers on inclined beds: the geometry that the papers leave open, and what a run of one shows at a moment."""

from dataclasses import dataclass
from itertools import pairwise
from math import cos, inf, radians, sin
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.papers.case import study
from rfmpm.failure_modes import MODES
from rfmpm.mpm.scene import Scene, outline
from rfmpm.observer import final_state
from rfmpm.outcome import Outcome
from rfmpm.quantities import QUANTITIES, FinalState
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import drawing, new_figure, save
from rfmpm.study import Study

STUDY = "vardon_2017_long_slope"
ALONG, TOP, STRETCH = 25.0, 8.0, 2.0  # length down the slope, horizontal stretches at its top and toe [m]
MOVED = 0.5  # displacement from which soil has failed [m]
COARSE = 0.5  # [m]
FRAMES = 1000  # more than there are: every tenth of a second


@dataclass(frozen=True)
class Slide:
    """A run with its scene; the layer's points come first, shape (n,) of them."""

    study: Study
    scene: Scene
    outcome: Outcome

    @property
    def layer(self) -> int:
        """Number of the layer's points."""
        return self.scene.soils.counts[0]

    def frame_at(self, time: float) -> tuple[float, dict[str, np.ndarray]]:
        """The snapshot nearest to a time [s]; infinite: the last."""
        last = self.outcome.frames[-1]
        return last if time == inf else min(self.outcome.frames, key=lambda frame: abs(frame[0] - time))

    def state_at(self, time: float) -> FinalState:
        """What quantities are read from at a time [s]."""
        return final_state(self.scene, self.study, self.frame_at(time)[1])

    def kind_at(self, time: float) -> str:
        """The kind of failure at a time [s]."""
        return MODES[QUANTITIES["failure_mode"](self.state_at(time))]

    def passes(self, name: str, distance: float = MOVED) -> float:
        """Time at which a point of the histories has moved so far [s]; infinite where it does not."""
        motion = self.outcome.motion
        k = list(motion["history_point"]).index(name)
        moved = np.hypot(motion["history_displacement_x"][:, k], motion["history_displacement_y"][:, k])
        return float(motion["motion_time"][np.argmax(moved >= distance)]) if moved.max() >= distance else inf

    def failed_share_at(self, time: float) -> float:
        """Share of the layer that has failed at a time [-]."""
        volume = self.scene.points.volume[: self.layer]
        return float(volume[self.state_at(time).failed[: self.layer]].sum() / volume.sum())


def geometry(angle: float, depth: float) -> dict[str, Any]:
    """Changes to the study for a layer of that depth on a bed of that inclination, cut 1:1 at its toe.

    Args:
        angle: of the bed and the ground [degrees].
        depth: of the layer, upright [m].

    Returns:
        Keys and values.
    """
    rise, knee = round(ALONG * sin(radians(angle)), 4), round(TOP + ALONG * cos(radians(angle)), 4)
    edge = round(knee + STRETCH, 4)
    toe, top = edge + depth, rise + depth
    layer = [[0.0, rise], [TOP, rise], [knee, 0.0], [toe, 0.0], [edge, depth], [knee, depth], [TOP, top], [0.0, top]]
    return {
        "geometry.region.0.corners_m": layer,
        "geometry.region.1.corners_m": [[0.0, 0.0], [knee, 0.0], [TOP, rise], [0.0, rise]],
        "geometry.toe_m": toe,
        "geometry.crest_edge_m": edge,
        "history.0.x_m": edge,
        "history.0.y_m": depth,
        "history.1.x_m": 0.5 * (TOP + knee),
        "history.1.y_m": 0.5 * rise + depth,
    }


def slide(changes: dict[str, Any], index: int = 0) -> Slide:
    """Run a realisation of the long slope with some keys changed."""
    asked = study(STUDY, changes)
    prepared = realisation.prepare(asked)
    return Slide(asked, prepared.scene, realisation.simulate(prepared, index, frames=FRAMES))


def bed_at(x: np.ndarray, angle: float) -> np.ndarray:
    """Height of the bed at some x, same shape [m]."""
    return np.interp(x, [TOP, TOP + ALONG * cos(radians(angle))], [ALONG * sin(radians(angle)), 0.0])


def fifths_fail_at(run: Slide, angle: float) -> list[float]:
    """Times at which the ground of each fifth of the slope has failed, from the toe upwards [s]; infinite: never."""
    first, right = run.state_at(0.0), TOP + ALONG * cos(radians(angle))
    times = []
    for lower, upper in pairwise(np.linspace(right, TOP, 6)):
        part = first.top_row & (first.x_initial < lower) & (first.x_initial >= upper)
        moved = ((time, np.hypot(f["displacement_x"], f["displacement_y"])[part]) for time, f in run.outcome.frames)
        times.append(next((time for time, some in moved if np.mean(some > MOVED) > 0.5), inf))
    return times


def goes_up(times: list[float]) -> bool:
    """Whether the fifths fail from the toe upwards, none before the one below it, at three moments or more."""
    return len({*times} - {inf}) >= 3 and all(lower <= upper for lower, upper in pairwise(times))


def turn_of(state: FinalState, chosen: np.ndarray) -> float:
    """Mean rotation of some points, to the left positive [degrees], weighted by volume."""
    weight = state.volume_initial[chosen]
    before = np.array([state.x_initial[chosen], state.y_initial[chosen]])
    after = np.array([state.x[chosen], state.y[chosen]])
    before, after = (at - (at @ weight)[:, None] / weight.sum() for at in (before, after))
    sine = weight @ (before[0] * after[1] - before[1] * after[0])
    return float(np.degrees(np.arctan2(sine, weight @ (before * after).sum(axis=0))))


def draw(pictures: list[tuple[str, Slide, float]], path: Path) -> None:
    """Draw the plastic strain of runs at a time each, one below the other in one frame: title, run, time [s]."""
    frames = [run.frame_at(time)[1] for _, run, time in pictures]
    frame = view([f["x"] for f in frames], [f["y"] for f in frames])
    with drawing():
        figure = new_figure(WIDTH, len(frames) * (panel_height(frame) + 0.3))
        panels = np.ravel(figure.subplots(len(frames), 1))
        for axes, (title, run, _), points in zip(panels, pictures, frames, strict=True):
            axes.set_title(title)
            strain = points["plastic_strain"]
            draw_panel(figure, axes, points, strain, outline(run.study), frame, (0.0, 1.0), "plastic strain [-]")
        save(figure, path)
