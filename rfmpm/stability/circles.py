"""Circular slip surfaces of a slope on a firm base at the level of its toe: where they run, and what drives them.

A surface enters at the crest and leaves through the face or the toe. Three shares from 0 to 1 name it: `entry`, from
the side of the model to the edge of the crest; `exit`, height on the face, from the toe to the crest; `depth`, of its
half central angle, from a plane to the deepest arc that stays above the base and does not overhang at the crest.
"""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

SHALLOWEST = 1e-3  # share of the deepest arc, in place of a plane
SMALLEST = 1e-9  # half central angle [rad]
VERTICAL = 1e-9  # width of a face over its height


class Arcs(NamedTuple):
    """Arcs of circles; arrays of shape (n,) [m], angles [rad] from straight down, anticlockwise."""

    x: np.ndarray  # centre
    y: np.ndarray
    radius: np.ndarray
    start: np.ndarray  # angle at the crest, negative
    end: np.ndarray  # angle at the face


@dataclass(frozen=True)
class Profile:
    """Ground surface of a slope whose crest is on the left [m]."""

    crest_edge: float
    toe: float
    height: float

    @property
    def run(self) -> float:
        """Horizontal width of the face [m]."""
        return self.toe - self.crest_edge


def arcs(profile: Profile, shares: np.ndarray) -> Arcs:
    """Make the surfaces of given shares.

    Args:
        profile: the slope.
        shares: entry, exit and depth, shape (n, 3) [-].

    Returns:
        The arcs.
    """
    entry, leaving, depth = np.clip(shares, 0.0, 1.0).T
    x_in = entry * profile.crest_edge
    y_out = leaving * profile.height
    x_out = profile.toe - leaving * profile.run
    across, down = x_out - x_in, profile.height - y_out
    chord, dip = np.hypot(across, down), np.arctan2(down, across)
    half = np.maximum(depth, SHALLOWEST) * _deepest(chord, dip, y_out)
    radius = 0.5 * chord / np.sin(half)
    # The chord's normal points up and to the right, towards the centre.
    to_centre = radius * np.cos(half)
    x = 0.5 * (x_in + x_out) + to_centre * np.sin(dip)
    y = 0.5 * (profile.height + y_out) + to_centre * np.cos(dip)
    return Arcs(x, y, radius, -dip - half, half - dip)


def _deepest(chord: np.ndarray, dip: np.ndarray, y_out: np.ndarray) -> np.ndarray:
    """Largest half central angle [rad]: no overhang at the crest, and no point below the base.

    With a beyond the dip, the lowest point lies chord / (2 sin a) (1 - cos(a - dip)) below the exit; at the base that
    is cos a cos dip + sin a (sin dip + 2 y_out / chord) = 1.
    """
    across, up = np.cos(dip), np.sin(dip) + 2.0 * y_out / chord
    touching = np.arctan2(up, across) + np.arccos(np.minimum(1.0 / np.hypot(across, up), 1.0))
    return np.maximum(np.minimum(touching, 0.5 * pi - dip), SMALLEST)


def driving_moments(profile: Profile, given: Arcs) -> np.ndarray:
    """Moment of the soil above each arc about its centre, per unit weight and metre of width, shape (n,) [m3].

    The integral of (x_c - x) (ground - arc) over x; both parts have closed forms.
    """
    first = given.x + given.radius * np.sin(given.start)
    last = given.x + given.radius * np.sin(given.end)
    edge = np.clip(profile.crest_edge, first, last)
    slope = profile.height / profile.run if profile.run > VERTICAL * profile.height else 0.0
    on_crest = _under_line(given, first, edge, profile.height, 0.0)
    on_face = _under_line(given, edge, last, slope * (profile.toe - given.x), -slope)
    lifted = given.radius**3 * (np.cos(given.end) ** 3 - np.cos(given.start) ** 3) / 3.0
    return on_crest + on_face + lifted


def _under_line(given: Arcs, left: np.ndarray, right: np.ndarray, level, slope: float) -> np.ndarray:
    """The integral of -u (level + slope u - y_c) from left to right, u being the distance from the centre."""
    a, b = left - given.x, right - given.x
    return -0.5 * (level - given.y) * (b**2 - a**2) - slope * (b**3 - a**3) / 3.0
