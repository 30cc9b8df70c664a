"""Stresses of a body before it is released, by name.

What a scene cannot know, because it depends on the strength of a realisation, is found at release: `SETTLES` names the
ways that start from these stresses and go on by damped motion (`rfmpm.mpm.equilibrium`).
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor
from rfmpm.mpm.boundary import Walls
from rfmpm.mpm.initial_stress.at_rest import k0_stress, lateral_coefficients, no_stress, weight_above
from rfmpm.mpm.initial_stress.elastic import elastic_gravity_stress, interpolation
from rfmpm.mpm.state import Axes


class Unreleased(NamedTuple):
    """A body before it has stresses."""

    outline: np.ndarray  # (k, 2) corners [m]
    soil: np.ndarray  # (n,) number of each point's material
    position: np.ndarray  # (n, 2) [m]
    mass: np.ndarray  # (n,) [kg/m]
    volume: np.ndarray  # (n,) [m3/m]
    axes: Axes
    walls: Walls
    lame: float | np.ndarray  # one value or shape (n,) [Pa]
    shear: float | np.ndarray  # the same [Pa]
    gravity: float  # [m/s2]
    cell_means: bool  # volumetric strain and pressure are means over the points of a cell


def elastic(body: Unreleased, study) -> Tensor:
    """One elastic static solve on the grid."""
    return elastic_gravity_stress(*body[2:])


def k0(body: Unreleased, study) -> Tensor:
    """Level ground: weight above, and a share of it sideways."""
    overburden = weight_above(study, body.outline, body.position)
    return k0_stress(overburden, lateral_coefficients(study)[body.soil])


def gravity_ramp(body: Unreleased, study) -> Tensor:
    """None yet: gravity is raised at release."""
    return no_stress(len(body.mass))


INITIAL_STRESSES = {"elastic": elastic, "k0": k0, "gravity_ramp": gravity_ramp}
SETTLES = frozenset({"gravity_ramp"})

__all__ = ["INITIAL_STRESSES", "SETTLES", "Unreleased", "elastic_gravity_stress", "interpolation", "k0_stress"]
