"""What a run that has ended came to: its verdict in words, and its quantities."""

from dataclasses import dataclass, field
from math import nan
from typing import Any

import numpy as np

from rfmpm.mpm import scene as scenes
from rfmpm.mpm.energy import elastic_energy, energy_shares
from rfmpm.mpm.state import AT_REST, ENERGY_GREW, LEFT_GRID, NOT_A_NUMBER, Progress
from rfmpm.observer import Observer, final_state
from rfmpm.quantities import QUANTITIES, first_minimum
from rfmpm.variables import FAILED, active_variables


@dataclass(frozen=True)
class Outcome:
    """One simulated realisation; arrays over points have shape (n,)."""

    quantities: dict[str, Any]
    status: str
    reason: str
    step_count: int
    wall_time: float  # [s]
    points: dict[str, np.ndarray]
    history: dict[str, np.ndarray]
    frames: list[tuple[float, dict[str, np.ndarray]]]
    motion: dict[str, np.ndarray] = field(default_factory=dict)  # of the named points, as `Motion.history` gives it


def verdict(now: Progress, study, scene: scenes.Scene, points: dict[str, np.ndarray]) -> tuple[str, str]:
    """Status of a run that has ended, and its reason in words."""
    speed = f"at {now.time:.3g} s; try a smaller time.step_fraction than {study.time.step_fraction:g}"
    if now.status == LEFT_GRID:
        y, vy = points["y"][now.culprit], points["velocity_y"][now.culprit]
        if y > scene.body.top - scene.cell and vy > 0.0:
            place = f"point {now.culprit} left the grid over its top at x = {points['x'][now.culprit]:.3g} m"
            return "left_grid", f"{place} {speed}, or a longer geometry.foreland_m if soil splashed up at the far wall"
        return "left_grid", f"point {now.culprit} left the grid {speed}"
    if now.status == NOT_A_NUMBER or not np.isfinite(points["stress_xx"] + points["stress_xy"]).all():
        return "diverged", f"a value is not a number {speed}"
    if now.status == ENERGY_GREW:
        return "diverged", f"energy came from nothing {speed}"
    smallest = int(np.argmin(points["volume"]))
    if points["volume"][smallest] <= 0.0:
        return "diverged", f"point {smallest} turned inside out, found {speed}"
    if now.status == AT_REST:
        return "ok", ""
    return "not_at_rest", f"still moving at time.end_s = {study.time.end_s:g} s"


def measure(study, scene: scenes.Scene, own, points, observer: Observer, now: Progress, status: str) -> dict[str, Any]:
    """Every active quantity by name; NaN for a failed run."""
    names = [variable.name for variable in active_variables(study) if variable.name in QUANTITIES]
    measured = {
        "time_at_rest": now.time if status == "ok" else nan,
        **energy_shares(now, scene.controls.energy_scale, elastic_energy(own.points, scene.lame, scene.shear)),
    }
    if study.obstacle:
        measured["impact_force_peak"] = nan if status in FAILED else max(observer.history["impact_force"])
    if status in FAILED:
        return dict.fromkeys((*names, "initial_failure_volume"), nan) | measured
    state = final_state(scene, study, points)
    end_of_first_slide = first_minimum(np.array(observer.history["kinetic_energy"]))
    measured["initial_failure_volume"] = observer.history["failed_volume"][end_of_first_slide]
    return {name: QUANTITIES[name](state) for name in names} | measured
