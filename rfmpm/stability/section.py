"""A slope as limit equilibrium sees it: a ground surface, a firm base, and material points that carry the soil.

Kernels see every slope as one whose soil slides to the right: a section in which it may slide to the left, too, is
looked at from both sides. The soil of a place is that of the material point whose square it lies in.
"""

from typing import NamedTuple

import numpy as np


class Section(NamedTuple):
    """A section through a slope; no material in it yet.

    Attributes:
        ground: surface from left to right, shape (k, 2) [m]; x never falls, a vertical face is two points of one x.
        base: level of the firm base, which no slip surface crosses [m].
        points: material points, shape (n, 2) [m].
        square: side of the square that a material point stands for [m].
        crack: depth of the tension crack in which every slip surface begins [m].
        load: pressures downwards on the ground, none over another: from x, to x [m] and pressure [Pa], shape (m, 3).
        base_friction: coefficient of friction of the base [-]; infinite where soil holds to it by its own strength.
    """

    ground: np.ndarray
    base: float
    points: np.ndarray
    square: float
    crack: float = 0.0
    load: np.ndarray = np.empty((0, 3))
    base_friction: float = np.inf


class Ground(NamedTuple):
    """Ground surface of a slope whose soil slides to the right; arrays of shape (k,)."""

    x: np.ndarray  # [m]
    y: np.ndarray  # [m]
    along: np.ndarray  # way along the surface from its left end [m]
    area: np.ndarray  # integral of y over x from the left end [m2]
    base: float  # [m]
    crack: float  # [m]
    load_x: np.ndarray  # ends of the loads on it from left to right; empty where there is none, shape (2 m,) [m]
    load: np.ndarray  # force of what lies to the left of each, shape (2 m,) [N/m]
    base_friction: float  # [-]; infinite where no surface slides along the base


class Soil(NamedTuple):
    """What the soil is in each square of a raster, shape (rows, columns) from the lower left."""

    left: float  # [m]
    bottom: float  # [m]
    square: float  # [m]
    cohesion: np.ndarray  # [Pa]
    friction: np.ndarray  # tangent of the angle [-]
    weight: np.ndarray  # of the column below each square's lower side, shape (rows + 1, columns) [Pa]


class Side(NamedTuple):
    """A section seen from the side from which its soil slides to the right."""

    ground: Ground
    left: float  # of the raster [m]
    bottom: float
    square: float
    point_of: np.ndarray  # number of the material point of each square, shape (rows, columns)
    sign: float  # of x: -1 where the section is mirrored


def sides_of(section: Section) -> tuple[Side, ...]:
    """Look at a section from each side from which its ground falls.

    Args:
        section: the section.

    Returns:
        One side or two.

    Raises:
        ValueError: the ground runs back, lies below the base, or is level.
    """
    ground = np.asarray(section.ground, dtype=float)
    if np.any(np.diff(ground[:, 0]) < 0.0):
        raise ValueError("the ground surface runs back: x must never fall from left to right, no overhang")
    if np.any(ground[:, 1] < section.base):
        raise ValueError(f"the ground surface lies below the firm base, y = {section.base:g} m")
    falls = np.diff(ground[:, 1])
    signs = [sign for sign, is_there in ((1.0, np.any(falls < 0.0)), (-1.0, np.any(falls > 0.0))) if is_there]
    if not signs:
        raise ValueError("the ground surface is level: nothing can slide")
    return tuple(_side(section, ground, sign) for sign in signs)


def soil_of(side: Side, cohesion: np.ndarray, friction_angle: np.ndarray, unit_weight: np.ndarray) -> Soil:
    """Lay the soil of material points into the squares of a side.

    Args:
        side: of the section.
        cohesion: at the material points, shape (n,) [Pa].
        friction_angle: at the material points, shape (n,) [rad].
        unit_weight: at the material points, shape (n,) [N/m3].

    Returns:
        The soil.
    """
    rows, columns = side.point_of.shape
    weight = np.zeros((rows + 1, columns))
    np.cumsum(unit_weight[side.point_of] * side.square, axis=0, out=weight[1:])
    friction = np.tan(friction_angle)[side.point_of]
    return Soil(side.left, side.bottom, side.square, cohesion[side.point_of], friction, weight)


def _side(section: Section, ground: np.ndarray, sign: float) -> Side:
    x, y = ground[:: int(sign)].T * np.array([[sign], [1.0]])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    area = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])
    levels, loads = (float(section.base), float(section.crack)), _loads(section.load, sign)
    profile = Ground(x.copy(), y.copy(), along, area, *levels, *loads, float(section.base_friction))
    left, bottom, point_of = _points_of_squares(section.points * [sign, 1.0], section.square)
    return Side(profile, left, bottom, section.square, point_of, sign)


def _loads(load: np.ndarray, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the loads of a section from left to right, and the force of what lies to the left of each."""
    ends = np.sort(sign * load[:, :2], axis=1)
    order = np.argsort(ends[:, 0])
    force = np.zeros(ends.shape)
    force[:, 1] = load[order, 2] * np.ptp(ends[order], axis=1)
    return ends[order].ravel(), np.cumsum(force)


def _points_of_squares(points: np.ndarray, square: float) -> tuple[float, float, np.ndarray]:
    """Lower left corner of the rectangle around the points, and the point in each square: the nearest if none is."""
    from scipy.spatial import cKDTree

    places = np.floor(points / square + 1e-9).astype(int)
    first = places.min(axis=0)
    column, row = (places - first).T
    rows, columns = row.max() + 1, column.max() + 1
    left, bottom = (float(edge) for edge in first * square)
    middle_x, middle_y = np.meshgrid(
        left + (np.arange(columns) + 0.5) * square, bottom + (np.arange(rows) + 0.5) * square
    )
    _, nearest = cKDTree(points).query(np.column_stack([middle_x.ravel(), middle_y.ravel()]))
    point_of = nearest.reshape(rows, columns)
    point_of[row, column] = np.arange(len(points))
    return left, bottom, point_of
