"""What the plain solver keeps beside points, law and history."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Vector
from rfmpm.mpm.state import Axes

ORDERS = {"usl": 0, "musl": 1, "usf": 2}
STRESS_LAST, SECOND_MAPPING, STRESS_FIRST = ORDERS.values()


class Gradient(NamedTuple):
    """A velocity gradient [1/s], first index the velocity's component; of one point, or arrays over points."""

    xx: float
    xy: float
    yx: float
    yy: float


class Nodes(NamedTuple):
    """Sums and velocities on the nodes, arrays of shape (rows, columns); rows from the base up."""

    mass: np.ndarray  # [kg/m]
    momentum: Vector  # [N s/m]
    force: Vector  # [N/m]
    velocity: Vector  # after the step [m/s]
    change: Vector  # of the velocity over the step, walls included [m/s]
    straining: Vector  # what strains the points [m/s]
    filtered: Vector  # FMPM's sum [m/s]
    term: Vector  # FMPM's last term [m/s]
    projected: Vector  # that term, to the points and back: momentum [N s/m]


class Settings(NamedTuple):
    """Numbers that steer the time integration; meanings as in the engine's `Controls`."""

    gravity: float  # [m/s2]
    cell: float  # [m]
    wave_speed: float  # [m/s]
    courant: float  # [-]
    dissipation_time: float  # time in which velocities relax to the filtered ones; 0: at once, inf: never [s]
    filter_interval: int  # steps
    own_share: float  # [-]


class Clock(NamedTuple):
    """How far a run has come."""

    time: float  # [s]
    step_count: int
    since_filter: float  # time since the filter last acted [s]
    fastest: float  # largest point speed [m/s]
    lost: int  # point that left the grid, is no number or blew up, or -1


def empty_nodes(axes: Axes) -> Nodes:
    """Make the nodes of a grid, all zero."""
    shape = axes.y.cells + 1, axes.x.cells + 1
    return Nodes(np.zeros(shape), *(Vector(np.zeros(shape), np.zeros(shape)) for _ in range(8)))


def still_gradient(count: int) -> Gradient:
    """Make the velocity gradients of points at rest, arrays of shape (count,) [1/s]."""
    return Gradient(*(np.zeros(count) for _ in range(4)))
