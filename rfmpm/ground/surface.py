"""The ground surface of a body, and the toe and the edge of the crest on it."""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

STEEP = 0.5  # of the steepest descent; what descends as steeply as that, or more steeply, is the face of a slope


class Surface(NamedTuple):
    """The ground from left to right, and where its face begins and ends.

    Attributes:
        line: corners, shape (k, 2) [m]; x does not fall, and stays where the ground drops upright.
        crest_edge: x of the upper end of the face [m].
        toe: x of its lower end [m].
    """

    line: np.ndarray
    crest_edge: float
    toe: float


def surface_of(polygon: Any, length: float, toe: float | None = None, crest_edge: float | None = None) -> Surface:
    """Find the ground surface of a body, seen from above.

    The face is what descends to the right at least half as steeply as the steepest stretch does, by angle: from the
    first such stretch to the last. Soil that ends upright after ground that is level for longer than this end is high
    is cut off there, which is no face if there is another. A body without a face has toe and crest at its right end.

    Args:
        polygon: of the body, one or several [m].
        length: of the domain, whose right side is a wall and no face [m].
        toe, crest_edge: their x where they are known [m].

    Returns:
        The surface.
    """
    line = _from_above(polygon)
    if line[-1, 0] < length * (1.0 - 1e-9):
        line = _without_repeats(np.vstack([line, [(line[-1, 0], 0.0), (length, 0.0)]]), 1e-7 * length)
    run, fall = np.diff(line[:, 0]), -np.diff(line[:, 1])
    angle = np.arctan2(fall, run)
    descends = angle > 1e-9
    end = np.flatnonzero(descends)[-1:]
    if descends.sum() > 1 and run[end] == 0.0 and angle[end - 1] == 0.0 and run[end - 1] > fall[end]:
        angle[end], descends[end] = 0.0, False
    found_crest = found_toe = float(line[-1, 0])
    if descends.any():
        face = np.flatnonzero(angle >= STEEP * angle.max() - 1e-9)
        found_crest, found_toe = float(line[face[0], 0]), float(line[face[-1] + 1, 0])
    return Surface(line, found_crest if crest_edge is None else crest_edge, found_toe if toe is None else toe)


def height_at(line: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Height of the ground [m] at some x, same shape [m]; where it drops upright, the upper end; 0 beside it."""
    x = np.asarray(x, dtype=float)
    before = np.interp(x, line[:, 0], line[:, 1], left=0.0, right=0.0)
    upright = np.flatnonzero(np.diff(line[:, 0]) == 0.0)
    for k in upright:
        before = np.where(x == line[k, 0], np.maximum(before, max(line[k, 1], line[k + 1, 1])), before)
    return before


def _from_above(polygon: Any) -> np.ndarray:
    """Upper border of a polygon, shape (k, 2) [m], from its left end to its right end."""
    import shapely

    left, _, right, top = polygon.bounds
    corners = np.unique(shapely.get_coordinates(polygon)[:, 0])
    line = []
    for start, end in pairwise(corners):
        # Between two corners' x the border consists of straight pieces that do not cross: its ends tell the highest.
        inner = start + (end - start) * np.array([1e-6, 1.0 - 1e-6])
        rays = shapely.linestrings([[(x, -1.0), (x, top + 1.0)] for x in inner])
        high = shapely.bounds(shapely.intersection(polygon, rays))[:, 3]
        high = np.where(np.isnan(high), 0.0, high)
        rise = (high[1] - high[0]) / (inner[1] - inner[0])
        line += [(start, high[0] - rise * (inner[0] - start)), (end, high[1] + rise * (end - inner[1]))]
    return _without_repeats(np.array(line), 1e-7 * max(right - left, top))


def _without_repeats(line: np.ndarray, tolerance: float) -> np.ndarray:
    """Leave out corners that are there twice, or that the ground passes straight."""
    kept = [line[0]]
    for corner in line[1:]:
        if np.abs(corner - kept[-1]).max() > tolerance:
            kept.append(corner)
    straight = [kept[0]]
    for here, after in pairwise(kept[1:]):
        along, whole = here - straight[-1], after - straight[-1]
        if abs(along[0] * whole[1] - along[1] * whole[0]) > tolerance * np.hypot(*whole):
            straight.append(here)
    return np.array([*straight, kept[-1]] if len(kept) > 1 else straight)
