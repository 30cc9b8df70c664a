"""Equilibrium of a body: how far a state is from it, and the way there by damped motion.

The way is dynamic relaxation with the engine's own kernels: points, grid, walls, law and cell means are those of the
run. Stiffness is scaled so that the body moves by a thousandth of a cell: for given strength and Poisson's ratio the
stresses of slow loading do not depend on it, and the geometry stays as it is. Softening and viscosity are left out.

The damping is proportional to mass, at a quarter of the rate that is critical for a shear wave in the body: where soil
flows, velocities are what is out of balance over damping, so that less of it comes to a decision earlier, and the waves
that it lets pass have died within two of their periods.
"""

from dataclasses import replace
from math import inf, pi, sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import each_record, mapped
from rfmpm.mpm.boundary import Walls
from rfmpm.mpm.cells import make_cells
from rfmpm.mpm.energy import elastic_energy
from rfmpm.mpm.scene import Released, Scene, arguments, empty_grid
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import FORCE_X, FORCE_Y, RUNNING, Grid, Progress, start

SINKING = 1e-3  # of a cell: gamma H^2 / E with the scaled stiffness
CRITICAL_SHARE = 0.25  # of the damping that is critical
BALANCED = 1e-3  # out of balance below which a body is in equilibrium
LOOKS = 4  # within a period
FALL = 0.8  # to which the least of a period falls in the next one at least, where there is an equilibrium
LONGEST = 40.0  # periods until a body that is still not in equilibrium is taken for one that fails
RAMP, STAGES = 4.0, 40  # periods in which gravity is raised, and its stages
SETTLED = 1e-4  # out of balance to which a ramp goes on, as long as it falls


class Relaxation(NamedTuple):
    """A body on its way to equilibrium; its points, history and grid change in place."""

    scene: Scene  # with the controls of the relaxation
    own: Released
    period: float  # of the shear wave that is four times as long as the body is high [s]
    unit: float  # displacement gamma H^2 / E [m]


class Verdict(NamedTuple):
    """Where a relaxation ended."""

    stands: bool  # what is out of balance fell below the limit
    out_of_balance: float  # [-]
    displacement: float  # largest since release, E d / (gamma H^2) [-]
    step_count: int


def relaxation(scene: Scene, own: Released, factor: float = 1.0) -> Relaxation:
    """Prepare a body for its relaxation.

    Args:
        scene: the scene.
        own: what a realisation owns; its points and history will change in place, its grid and law will not.
        factor: by which cohesion and the tangents of friction and dilation are divided.

    Returns:
        The body, whose points start with the stresses and the places that they have.
    """
    points, before = scene.points, scene.controls
    height = float(np.ptp(points.position.y)) + scene.cell
    weight = before.gravity * float(points.mass.sum() / points.volume.sum())
    youngs = float(np.min(scene.shear * (3.0 * scene.lame + 2.0 * scene.shear) / (scene.lame + scene.shear)))
    unit = SINKING * scene.cell
    stiffer = weight * height**2 / (youngs * unit)
    speed = before.wave_speed * sqrt(stiffer)
    period = 4.0 * height / (speed * scene.soils.slowest_share)
    controls = before._replace(
        wave_speed=speed,
        dissipation_time=inf,
        average_interval=inf,  # nothing softens
        rest_time=inf,  # with `damped_start`, and the scale below, it is damped from the first step to the last
        energy_scale=inf,
        settling_rate=CRITICAL_SHARE * 4.0 * pi / period,
    )
    own = own._replace(
        law=mapped(lambda law: law.quasi_static(stiffer, factor), own.law),
        grid=empty_grid(scene.axes),
        cells=None if own.cells is None else make_cells(len(points.mass), scene.axes),
    )
    return Relaxation(replace(scene, controls=controls), own, period, unit)


def damped_start() -> Progress:
    """Progress of a run that is damped from its first step."""
    return start()._replace(calm_time=inf)


def follow(body: Relaxation, now: Progress, periods: float, share: float = 1.0) -> Progress:
    """Let a body move on for some periods, under a share of gravity."""
    controls = body.scene.controls
    scene = replace(body.scene, controls=controls._replace(gravity=share * controls.gravity))
    return SOLVERS["explicit"](now, now.time + periods * body.period, *arguments(scene, body.own))


def relax(body: Relaxation, now: Progress, limit: float = BALANCED) -> Verdict:
    """Let a body move until it is in equilibrium, or until what is out of balance falls no more.

    Args:
        body: the body; it moves.
        now: progress of its relaxation; `damped_start()` at the beginning.
        limit: what is out of balance in a state that counts as equilibrium [-].

    Returns:
        The verdict.
    """
    seen = []
    while True:
        now = follow(body, now, 1.0 / LOOKS)
        seen.append(out_of_balance(body.own.grid, body.scene.walls, body.scene.controls.gravity))
        stands = now.status == RUNNING and seen[-1] < limit
        falls = len(seen) < 2 * LOOKS or min(seen[-LOOKS:]) < FALL * min(seen[-2 * LOOKS : -LOOKS])
        if stands or not falls or now.status != RUNNING or len(seen) >= LONGEST * LOOKS:
            return Verdict(stands, seen[-1], _displacement(body), now.step_count)


def _displacement(body: Relaxation) -> float:
    at, first = body.own.points.position, body.scene.points.position
    return float(np.hypot(at.x - first.x, at.y - first.y).max()) / body.unit


def raise_gravity(scene: Scene, own: Released) -> Verdict:
    """Give a body the stresses that it has when gravity has been raised slowly, with the peak strength of its soil.

    Displacements, velocities and plastic strains of the way are set back to zero: the body starts in its own geometry,
    with all of its strength. Where there is no equilibrium, the stresses are those of the slow flow at full gravity.

    Args:
        scene: the scene.
        own: what the realisation owns; it gets the stresses.

    Returns:
        The verdict, of the way's end.
    """
    body, now = relaxation(scene, own), damped_start()
    for stage in range(1, STAGES + 1):
        now = follow(body, now, RAMP / STAGES, stage / STAGES)
    verdict = relax(body, now, SETTLED)
    for component, first in zip(own.points.position, scene.points.position, strict=True):
        component[:] = first
    own.points.volume[:] = scene.points.volume
    for values in own.points.velocity:
        values[:] = 0.0
    for history in each_record(own.history):
        for values in history:
            values[:] = 0.0
    return verdict


def out_of_balance(grid: Grid, walls: Walls, gravity: float) -> float:
    """Unbalanced over gravity's forces on the nodes of a body at rest: Euclidean norms over all free components.

    A wall takes of the force on its nodes what it would take of the momentum: all that is across it and, on a base with
    friction, what lies along it as far as friction reaches.

    Args:
        grid: nodes to which the points have just been taken.
        walls: of the domain.
        gravity: [m/s2].

    Returns:
        The ratio [-].
    """
    weight = gravity * grid.mass
    x, y = grid.sums[:, :, FORCE_X].copy(), grid.sums[:, :, FORCE_Y] - weight
    last = x.shape[1] - 1
    for row in np.flatnonzero(grid.mass[:, 0]):
        _, _, x[row, 0], y[row, 0] = walls.sides.constrain(0.0, 0.0, x[row, 0], y[row, 0])
    for row in np.flatnonzero(grid.mass[:, last]):
        _, _, inwards, y[row, last] = walls.sides.constrain(0.0, 0.0, -x[row, last], y[row, last])
        x[row, last] = -inwards
    for column in np.flatnonzero(grid.mass[0]):
        _, _, y[0, column], x[0, column] = walls.base.constrain(0.0, 0.0, y[0, column], x[0, column])
    return float(np.sqrt((x**2 + y**2).sum() / (weight[1:] ** 2).sum()))


def release_at_rest(scene: Scene, own: Released, now: Progress, threads: int = 1) -> tuple[Scene, Progress, float]:
    """Take a body that has not moved yet to its grid.

    Args:
        scene: the scene.
        own: what the realisation owns; stresses beyond yield return to it.
        now: progress before the first step.
        threads: that share every step.

    Returns:
        The scene with the elastic energy of this body, the progress, and what is out of balance [-].
    """
    energy = elastic_energy(own.points, scene.lame, scene.shear)
    scene = replace(scene, controls=scene.controls._replace(energy_scale=energy))
    now = SOLVERS["explicit"](now, 0.0, *arguments(scene, own, threads))
    return scene, now, out_of_balance(own.grid, scene.walls, scene.controls.gravity)
