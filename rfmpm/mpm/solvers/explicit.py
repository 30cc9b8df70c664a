"""Explicit time integration: velocities, then stress by the velocities mapped again (MUSL)."""

from math import exp, inf
from typing import NamedTuple

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.attachments import hold_off, press
from rfmpm.mpm.protocols import average, carry, filter_nodes, update_nodes, update_points
from rfmpm.mpm.state import AT_REST, ENERGY_GREW, LEFT_GRID, NOT_A_NUMBER, RUNNING, Progress

RESOLVED_SHARE = 0.2  # of the square of the Courant number: a node's share of the mass at a wall that a step resolves
CALM_FLOW = 1e-4  # share of the energy in play that plastic flow and friction may take in a time that counts as calm
CALM_MOTION = 1e-2  # share of it that may be kinetic


class Controls(NamedTuple):
    """Numbers that steer the time integration."""

    gravity: float  # [m/s2]
    cell: float  # [m]
    wave_speed: float  # of compression, the largest of the scene [m/s]
    courant: float  # wave speed plus point speed, times time step, over cell [-]
    dissipation_time: float  # time in which velocities relax to the filtered grid velocity [s]
    filter_interval: int  # steps from one application of the filter to the next
    average_interval: float  # time from one average of the softening to the next [s]
    rest_fraction: float  # of the largest kinetic energy, below which a scene counts as quiet [-]
    rest_time: float  # quiet this long is at rest; calm this long is left with elastic swinging alone [s]
    own_share: float  # of the grid's own velocity in what strains the points; the rest is theirs, mapped (MUSL) [-]
    settling_rate: float  # at which that swinging is then damped [1/s]
    energy_scale: float  # elastic energy at the start, when all points are still [J/m]
    growth_limit: float  # energy out of nothing that ends a run, as a share of the scale and of gravity's work [-]


@kernel
def step(now, points, law, history, axes, grid, cells, averaging, walls, controls, load, obstacle, passes):
    """Advance everything by one time step; a first call with no nodes touched only fills the grid.

    Returns the new progress.
    """
    box = now.first_column, now.last_column, now.first_row, now.last_row
    dt, since_filter, friction = 0.0, 0.0, 0.0
    if now.last_row >= 0:
        dt = controls.courant * controls.cell / (controls.wave_speed + now.fastest)
        settling = controls.settling_rate if now.calm_time >= controls.rest_time else 0.0
        share = RESOLVED_SHARE * controls.courant**2
        update_nodes(passes, grid, walls, box, controls.gravity, settling, dt, share)
        if obstacle is not None:
            hold_off(obstacle, grid, box)
        rate = 1.0 / controls.dissipation_time + settling
        since_filter = now.since_filter + dt
        if now.step_count % controls.filter_interval == 0 and rate > 0.0:
            blend = 1.0 - exp(-since_filter * rate)
            since_filter = 0.0
            filter_nodes(passes, points, axes, grid, box)
            friction = update_points(passes, points, axes, grid, grid.filtered, blend, box, controls.own_share)
        else:
            friction = update_points(passes, points, axes, grid, None, 0.0, box, controls.own_share)
    moved = carry(passes, points, law, history, axes, grid, cells, box, dt)
    kinetic, fall, work, plastic, fastest, touched, culprit = moved
    pressed = 0.0
    if load is not None:  # noqa: SIM102  (an argument that is None is pruned here, not within a condition)
        if culprit < 0:
            pressed = press(points, load, axes, grid)
    since_average = now.since_average + dt
    if averaging is not None:  # noqa: SIM102  (an argument that is None is pruned here, not within a condition)
        if since_average >= controls.average_interval and culprit < 0:
            average(passes, points, averaging.history, axes, averaging, touched)
            since_average = 0.0
    peak = max(now.peak_kinetic, kinetic)
    quiet = now.quiet_time + dt if kinetic < controls.rest_fraction * peak else 0.0
    calm, flow_before = time_of_calm(now, kinetic, plastic + friction, dt, controls)
    after = Progress(
        now.status, now.time + dt, now.step_count + (dt > 0.0), kinetic, peak, quiet, calm, flow_before, since_filter,
        since_average, fastest**0.5,
        now.gravity_work + controls.gravity * fall + pressed, now.stress_work + work, now.plastic_work + plastic,
        now.friction_work + friction, touched[0], touched[1], touched[2], touched[3], culprit,
    )  # fmt: skip
    return judge(after, points, controls)


@kernel
def time_of_calm(now, kinetic, dissipated, dt, controls):
    """How long next to nothing has flowed, slid or flown [s], and what had been dissipated when that began [J/m]."""
    flow = now.plastic_work + now.friction_work + dissipated
    in_play = controls.energy_scale + abs(now.gravity_work)
    if flow - now.flow_before > CALM_FLOW * in_play or kinetic > CALM_MOTION * in_play:
        return 0.0, flow
    return now.calm_time + dt, now.flow_before


@kernel
def judge(now, points, controls):
    """Decide whether the run goes on. Returns the progress with its status."""
    status = RUNNING
    spent = now.kinetic + now.stress_work + now.friction_work
    scale = controls.energy_scale + abs(now.gravity_work)
    if now.culprit >= 0:
        x, y = points.position.x[now.culprit], points.position.y[now.culprit]
        gone = points.velocity.x[now.culprit] + points.velocity.y[now.culprit] + x + y
        status = LEFT_GRID if abs(gone) < inf else NOT_A_NUMBER
    elif not now.kinetic < inf:
        status = NOT_A_NUMBER
    elif spent - now.gravity_work > controls.growth_limit * scale:
        status = ENERGY_GREW
    elif now.quiet_time >= controls.rest_time:
        status = AT_REST
    return Progress(
        status, now.time, now.step_count, now.kinetic, now.peak_kinetic, now.quiet_time, now.calm_time,
        now.flow_before, now.since_filter, now.since_average, now.fastest,
        now.gravity_work, now.stress_work, now.plastic_work, now.friction_work,
        now.first_column, now.last_column, now.first_row, now.last_row, now.culprit,
    )  # fmt: skip


@kernel
def advance(now, until, points, law, history, axes, grid, cells, averaging, walls, controls, load, obstacle, passes):
    """Step until the time is `until` or later, or the run ends.

    Args:
        now: progress so far; `start()` at the beginning.
        until: model time [s].
        points, history: arrays, changed in place.
        law: constitutive law.
        axes: shape functions.
        grid: nodes; belongs to this run.
        cells: sums over the points of a cell, of this run; None: each point has its own volumetric strain.
        averaging: how softening is averaged, of this run; None: each point softens by itself.
        walls: what holds the domain's edges.
        controls: numbers of the time integration.
        load: on the surface, of this run; None: none. Its work counts as gravity's.
        obstacle: in the way, of this run; None: none.
        passes: who takes the passes over points and nodes; `Alone()`, or a team of threads.

    Returns:
        The progress, with its status.
    """
    while now.status == RUNNING and (now.time < until or now.last_row < 0):
        now = step(now, points, law, history, axes, grid, cells, averaging, walls, controls, load, obstacle, passes)
    return now
