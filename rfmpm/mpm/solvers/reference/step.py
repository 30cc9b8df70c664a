"""One explicit step, in the order of its equations."""

from math import exp, inf

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.solvers.reference.grid import add_term, clear, copy, divide, hold, hold_where_held, mix, solve
from rfmpm.mpm.solvers.reference.points import (
    map_force,
    map_interpolated,
    map_momentum,
    move,
    strain,
    update_velocities,
)
from rfmpm.mpm.solvers.reference.protocols import filter_terms
from rfmpm.mpm.solvers.reference.state import SECOND_MAPPING, STRESS_FIRST, STRESS_LAST, Clock

SENSELESS = 10.0  # times the wave speed: a point as fast as that has blown up, and would make ever smaller steps


def wind_up(points, law, history, axes, nodes):
    """Let what starts beyond its strength yield. Returns the clock of a run that has not begun; arguments as below."""
    strain(points, law, history, axes, nodes.velocity, 0.0)
    return Clock(0.0, 0, 0.0, float(np.hypot(*points.velocity).max()), -1)


@kernel
def step(now, points, carried, law, history, axes, nodes, walls, transfer, order, settings, body_force):
    """Advance everything by one time step. Returns the new clock."""
    dt = settings.courant * settings.cell / (settings.wave_speed + now.fastest)
    since, blend = now.since_filter + dt, 0.0
    nodes.mass[:] = 0.0
    clear(nodes.momentum)
    clear(nodes.force)
    map_momentum(points, carried, axes, nodes.mass, nodes.momentum, settings.cell)
    if order == STRESS_FIRST:
        divide(nodes.straining, nodes.mass, nodes.momentum)
        hold(nodes.straining, walls)
        strain(points, law, history, axes, nodes.straining, dt)
    map_force(points, axes, nodes.force, body_force, now.time)
    solve(nodes, walls, settings.gravity, dt)
    if (
        filter_terms(transfer) > 0
        and now.step_count % settings.filter_interval == 0
        and settings.dissipation_time < inf
    ):
        blend, since = 1.0, 0.0
        if settings.dissipation_time > 0.0:
            blend = 1.0 - exp(-(now.since_filter + dt) / settings.dissipation_time)
        filter_velocity(points, axes, nodes, filter_terms(transfer))
    update_velocities(points, carried, transfer, axes, nodes, blend, settings.cell)
    if order == STRESS_LAST:
        copy(nodes.straining, nodes.velocity)
    elif order == SECOND_MAPPING:
        nodes.mass[:] = 0.0
        clear(nodes.momentum)
        map_momentum(points, carried, axes, nodes.mass, nodes.momentum, settings.cell)
        divide(nodes.straining, nodes.mass, nodes.momentum)
        hold_where_held(nodes.straining, nodes.velocity)
        mix(nodes.straining, nodes.velocity, settings.own_share)
    if order != STRESS_FIRST:
        strain(points, law, history, axes, nodes.straining, dt)
    fastest, lost = move(points, axes, nodes.velocity, dt, SENSELESS * settings.wave_speed)
    return Clock(now.time + dt, now.step_count + 1, since, fastest, lost)


@kernel
def filter_velocity(points, axes, nodes, terms):
    """FMPM(k): v* = sum for l < k of (I - S+ S)^l v+ (Nairn and Hammerquist 2021, eq. 27), into `nodes.filtered`."""
    copy(nodes.term, nodes.velocity)
    copy(nodes.filtered, nodes.velocity)
    for _ in range(1, terms):
        clear(nodes.projected)
        map_interpolated(points, axes, nodes.term, nodes.projected)
        add_term(nodes)


@kernel
def advance(now, until, points, carried, law, history, axes, nodes, walls, transfer, order, settings, body_force):
    """Step until the time is `until` or later, or a point is lost.

    Args:
        now: clock; from `wind_up` at the beginning.
        until: model time [s].
        points, history: arrays, changed in place.
        carried: velocity gradients of the points, changed in place, for APIC and TPIC; None for FLIP.
        law: constitutive law.
        axes: shape functions.
        nodes: belong to this run.
        walls: what holds the domain's edges.
        transfer: how velocities come back to the points.
        order: of the stress update, a value of `ORDERS`.
        settings: numbers of the time integration.
        body_force: force per unit mass besides gravity; None for none.

    Returns:
        The clock.
    """
    while now.lost < 0 and now.time < until:
        now = step(now, points, carried, law, history, axes, nodes, walls, transfer, order, settings, body_force)
    return now
