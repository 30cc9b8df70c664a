"""Factor of safety of an undrained slope: circular surfaces, equilibrium of moments (phi = 0, Fellenius 1922).

factor = radius * integral of c along the arc / moment of the weight above it, smallest over all surfaces. With phi = 0
moment equilibrium is exact for a circle: slices and their side forces do not enter (Duncan, Wright and Brandon 2014,
section 6.3). The strength of a place is that of the material point whose square it lies in. What the base and the sides
resist is left out: a surface stays above the base and within the model.
"""

from itertools import product
from typing import Any, NamedTuple

import numpy as np

from rfmpm.mpm.geometry import Body
from rfmpm.stability.circles import Arcs, Profile, arcs, driving_moments

ENTRIES, EXITS, DEPTHS = 41, 21, 16  # of the surfaces tried for every realisation
LAST_ENTRY = 0.98  # next to the edge of the crest a surface is a crumb
LAST_EXIT = 0.75
PER_SQUARE = 2.0  # pieces of an arc per square of a material point
REFINEMENTS, STEPS = 5, (-0.5, 0.0, 0.5)  # rounds around the best surface, each of half the width


class Surfaces(NamedTuple):
    """What the surfaces of a slope need for every realisation.

    Attributes:
        profile: the slope.
        shares: that name the surfaces, shape (m, 3) [-].
        lengths: sparse matrix (m, points): radius times length of the arc in the square of each point [m2].
        moments: of the weight, per unit weight, shape (m,) [m3].
        point_of: number of the material point of each square, shape (rows, columns).
        square: side of a square [m].
    """

    profile: Profile
    shares: np.ndarray
    lengths: Any
    moments: np.ndarray
    point_of: np.ndarray
    square: float


def prepare_surfaces(body: Body, points: np.ndarray, square: float) -> Surfaces:
    """Lay surfaces through the material points of a slope, for all strengths that these may have.

    Args:
        body: the slope.
        points: material points, shape (n, 2) [m].
        square: side of the square that a material point stands for [m].

    Returns:
        The surfaces.
    """
    profile = Profile(body.crest_edge, body.toe, body.height)
    axes = (
        np.linspace(0.0, LAST_ENTRY, ENTRIES),
        np.linspace(0.0, LAST_EXIT, EXITS) ** 1.5,
        np.linspace(1.0 / DEPTHS, 1.0, DEPTHS),
    )
    shares = np.array(list(product(*axes)))
    point_of = _points_of_squares(points, square)
    through = arcs(profile, shares)
    return Surfaces(
        profile,
        shares,
        _lengths(through, point_of, square, len(points)),
        driving_moments(profile, through),
        point_of,
        square,
    )


def factor_of_safety(surfaces: Surfaces, strength: np.ndarray, unit_weight: float) -> float:
    """Find the smallest factor of safety over circular surfaces.

    Args:
        surfaces: of the slope.
        strength: undrained shear strength at the material points, shape (n,) [Pa].
        unit_weight: of the soil [N/m3].

    Returns:
        The factor [-].
    """
    factors = surfaces.lengths @ strength / surfaces.moments
    best = int(np.argmin(factors))
    factor, around = float(factors[best]), surfaces.shares[best]
    width = np.array([LAST_ENTRY / (ENTRIES - 1), LAST_EXIT / (EXITS - 1), 1.0 / DEPTHS])
    steps = np.array(list(product(STEPS, repeat=3)))
    for _ in range(REFINEMENTS):
        shares = np.clip(around + steps * width, 0.0, [LAST_ENTRY, 1.0, 1.0])
        tried = _resisting(surfaces, arcs(surfaces.profile, shares), strength)
        best = int(np.argmin(tried))
        if tried[best] < factor:
            factor, around = float(tried[best]), shares[best]
        width = 0.5 * width
    return factor / unit_weight


def _resisting(surfaces: Surfaces, through: Arcs, strength: np.ndarray) -> np.ndarray:
    """Resisting over driving moment per unit weight, shape (m,) [N/m3]."""
    point, length = _pieces(through, surfaces.point_of, surfaces.square)
    resisting = through.radius * length * strength[point].sum(axis=1)
    return resisting / driving_moments(surfaces.profile, through)


def _lengths(through: Arcs, point_of: np.ndarray, square: float, count: int) -> Any:
    from scipy.sparse import csr_matrix

    point, length = _pieces(through, point_of, square)
    each = np.repeat(through.radius * length, point.shape[1])
    row = np.repeat(np.arange(len(point)), point.shape[1])
    return csr_matrix((each, (row, point.ravel())), shape=(len(point), count))


def _pieces(through: Arcs, point_of: np.ndarray, square: float) -> tuple[np.ndarray, np.ndarray]:
    """Points in whose squares the pieces of each arc lie, shape (m, k), and the length of a piece, shape (m,) [m]."""
    turn = through.end - through.start
    count = int(np.ceil(PER_SQUARE * np.max(through.radius * turn) / square))
    angle = through.start[:, None] + turn[:, None] * (np.arange(count) + 0.5) / count
    x = through.x[:, None] + through.radius[:, None] * np.sin(angle)
    y = through.y[:, None] - through.radius[:, None] * np.cos(angle)
    rows, columns = point_of.shape
    row = np.clip((y / square).astype(int), 0, rows - 1)
    column = np.clip((x / square).astype(int), 0, columns - 1)
    return point_of[row, column], through.radius * turn / count


def _points_of_squares(points: np.ndarray, square: float) -> np.ndarray:
    """Number of the point in each square of the rectangle around them, the nearest one where there is none."""
    from scipy.spatial import cKDTree

    column, row = np.floor(points / square + 1e-9).astype(int).T
    rows, columns = row.max() + 1, column.max() + 1
    middle_x, middle_y = np.meshgrid((np.arange(columns) + 0.5) * square, (np.arange(rows) + 0.5) * square)
    _, nearest = cKDTree(points).query(np.column_stack([middle_x.ravel(), middle_y.ravel()]))
    point_of = nearest.reshape(rows, columns)
    point_of[row, column] = np.arange(len(points))
    return point_of
