"""What is seen of a run while it goes: the points by name, histories, and snapshots if asked."""

import numpy as np

from rfmpm.motion import Motion
from rfmpm.mpm.attachments import Obstacle
from rfmpm.mpm.scene import Scene
from rfmpm.mpm.soils import plastic_strain_of
from rfmpm.mpm.state import Points, Progress
from rfmpm.quantities import QUANTITIES, FinalState, front
from rfmpm.study import Study

SAMPLE_INTERVAL = 0.1  # [s] of model time from one entry of the histories to the next


class Observer:
    """Looks at a run from time to time: histories, and snapshots and the motion of named points if asked."""

    def __init__(
        self,
        scene: Scene,
        study: Study,
        points: Points,
        past: tuple | None,
        frames: int,
        motion: Motion | None = None,
        obstacle: Obstacle | None = None,
    ):
        self.scene, self.study, self.live, self.past, self.wanted = scene, study, points, past, frames
        names = ("time", "kinetic_energy", "failed_volume") + (("front", "crest") if frames else ())
        self.history = {name: [] for name in (*names, *(("impact_force",) if obstacle else ()))}
        self.obstacle, self.taken, self.before = obstacle, 0.0, 0.0
        self.frames = [(0.0, self.points())] if frames else []
        self.next_sample = SAMPLE_INTERVAL
        self.motion = motion

    @property
    def next_look(self) -> float:
        """Model time of the next look [s]."""
        return self.next_sample if self.motion is None else min(self.next_sample, self.motion.next_sample)

    def look(self, now: Progress, is_over: bool) -> None:
        """See what it is time for; the histories have an entry of the end."""
        if self.motion is not None:
            self.motion.look(now, is_over)
        if is_over or now.time >= self.next_sample:
            self.sample(now)

    def points(self) -> dict[str, np.ndarray]:
        """Copy the points' state, by the names of the table of variables."""
        live, first = self.live, self.scene.points
        strain = plastic_strain_of(self.past, len(live.mass))
        state = {
            "x": live.position.x,
            "y": live.position.y,
            "x_initial": first.position.x,
            "y_initial": first.position.y,
            "displacement_x": live.position.x - first.position.x,
            "displacement_y": live.position.y - first.position.y,
            "velocity_x": live.velocity.x,
            "velocity_y": live.velocity.y,
            **{f"stress_{name}": getattr(live.stress, name) for name in live.stress._fields},
            "plastic_strain": strain,
            "volume": live.volume,
        }
        return {name: values.copy() for name, values in state.items()}

    def sample(self, now: Progress) -> None:
        """Add an entry to the histories."""
        live, body, first = self.live, self.scene.body, self.scene.points
        moved = np.hypot(live.position.x - first.position.x, live.position.y - first.position.y)
        failed = moved > self.study.quantities.displacement_threshold_m
        self.history["time"].append(now.time)
        self.history["kinetic_energy"].append(now.kinetic)
        self.history["failed_volume"].append(float(first.volume[failed].sum()))
        self.next_sample = now.time + SAMPLE_INTERVAL
        if self.obstacle is not None:
            self._sample_impact(now.time)
        if self.wanted:
            state = final_state(self.scene, self.study, self.points())
            quantile = self.study.quantities.front_quantile
            self.history["front"].append(
                front(live.position.x[failed], first.volume[failed], quantile) if failed.any() else body.toe
            )
            self.history["crest"].append(body.crest_edge - QUANTITIES["retrogression_distance"](state))
            self.frames.append((now.time, self.points()))

    def _sample_impact(self, time: float) -> None:
        taken = float(self.obstacle.impulse[0])
        self.history["impact_force"].append((taken - self.taken) / max(time - self.before, 1e-12))
        self.taken, self.before = taken, time

    def kept_frames(self) -> list[tuple[float, dict[str, np.ndarray]]]:
        """Choose the snapshots, evenly spread from the first to the last."""
        if len(self.frames) <= self.wanted:
            return self.frames
        return [self.frames[i] for i in np.linspace(0, len(self.frames) - 1, self.wanted).round().astype(int)]


def final_state(scene: Scene, study: Study, points: dict[str, np.ndarray]) -> FinalState:
    """Make what quantities are read from.

    Args:
        scene: the scene the points started in.
        study: the study.
        points: state of the points by name, shape (n,) each.

    Returns:
        The state.
    """
    body, asked = scene.body, study.quantities
    return FinalState(
        **{name: points[name] for name in ("x", "y", "x_initial", "y_initial", "volume", "plastic_strain")},
        volume_initial=scene.points.volume,
        cell=scene.cell,
        spacing=scene.cell / np.sqrt(study.discretisation.points_per_cell),
        toe=body.toe,
        crest_edge=body.crest_edge,
        crest_height=body.height,
        ground=body.ground,
        length=body.length,
        displacement_threshold=asked.displacement_threshold_m,
        front_quantile=asked.front_quantile,
        block_plastic_strain=asked.block_plastic_strain,
        block_minimum_area=asked.block_minimum_area_m2,
        surface_bin=study.output.surface_bin_m,
    )
