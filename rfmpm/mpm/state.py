"""What changes in time: points, grid and the progress of a run."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor, Vector


class Points(NamedTuple):
    """Material points, one array entry each (structure of arrays)."""

    position: Vector  # [m]
    velocity: Vector  # [m/s]
    mass: np.ndarray  # [kg per m of width]
    volume: np.ndarray  # [m3 per m of width]
    stress: Tensor  # Cauchy stress, tension positive [Pa]


class Grid(NamedTuple):
    """Nodes, row by row from the base up; but for the mass, four values of one node lie side by side."""

    mass: np.ndarray  # (rows, columns) [kg/m]
    sums: np.ndarray  # (rows, columns, 4): momentum x y [N s/m], internal force x y [N/m]
    flow: np.ndarray  # (rows, columns, 4): velocity x y, its change over the step x y [m/s]
    filtered: np.ndarray  # (rows, columns, 4): momentum of the second projection x y, then FMPM's velocity x y [m/s]
    parts: np.ndarray  # (rows, columns, 4): mass [kg/m] of the nodes i, i + 1, ... from points whose first is i
    straining: np.ndarray  # (rows, columns, 4): momentum of the updated points; then their velocity x y, the grid's x y


X, Y, FORCE_X, FORCE_Y = range(4)
CHANGE_X, CHANGE_Y = 2, 3
MOVING_X, MOVING_Y = 2, 3


class Axes(NamedTuple):
    """Shape function of each axis."""

    x: tuple
    y: tuple


class Progress(NamedTuple):
    """How far a run has come, its work so far, and what the next step needs; one is made per step."""

    status: int
    time: float  # [s]
    step_count: int
    kinetic: float  # kinetic energy of the points [J/m]
    peak_kinetic: float  # the largest so far [J/m]
    quiet_time: float  # how long the kinetic energy has been small [s]
    calm_time: float  # how long next to nothing has flowed, slid or flown [s]
    flow_before: float  # plastic work and work of friction when that began [J/m]
    since_filter: float  # time since the filter last acted [s]
    since_average: float  # time since the softening was last averaged [s]
    fastest: float  # largest point speed [m/s]
    gravity_work: float  # [J/m]
    stress_work: float  # elastic and plastic [J/m]
    plastic_work: float  # the part of it that is not stored [J/m]
    friction_work: float  # taken by friction on walls [J/m]
    first_column: int  # the nodes that points touch
    last_column: int
    first_row: int
    last_row: int
    culprit: int  # point that left the grid, or -1


RUNNING, AT_REST, LEFT_GRID, NOT_A_NUMBER, ENERGY_GREW = range(5)


def start() -> Progress:
    """Make the progress of a run that has not begun."""
    return Progress(
        status=RUNNING,
        time=0.0,
        step_count=0,
        kinetic=0.0,
        peak_kinetic=0.0,
        quiet_time=0.0,
        calm_time=0.0,
        flow_before=0.0,
        since_filter=0.0,
        since_average=0.0,
        fastest=0.0,
        gravity_work=0.0,
        stress_work=0.0,
        plastic_work=0.0,
        friction_work=0.0,
        first_column=0,
        last_column=-1,
        first_row=0,
        last_row=-1,
        culprit=-1,
    )


def copy_points(points: Points) -> Points:
    """Copy every array of the points, so that a run can change them."""
    return Points(
        Vector(*(a.copy() for a in points.position)),
        Vector(*(a.copy() for a in points.velocity)),
        points.mass.copy(),
        points.volume.copy(),
        Tensor(*(a.copy() for a in points.stress)),
    )
