"""The body before it moves: its outline, and the material points that fill it."""

from math import ceil, radians, sqrt, tan
from typing import NamedTuple

import numpy as np


class Body(NamedTuple):
    """A convex body on the base, against the left side of the domain."""

    outline: np.ndarray  # (k, 2) corners, anticlockwise from the lower left [m]
    toe: float  # x of the toe [m]
    crest_edge: float  # x of the edge of the crest [m]
    height: float  # [m]
    length: float  # of the domain, a whole number of cells [m]
    top: float  # of the domain, a whole number of cells [m]


def body(study) -> Body:
    """Describe the body of a study.

    Args:
        study: the study; its `geometry` and `discretisation` are read.

    Returns:
        The body, with the domain around it: as long as asked, rounded up to whole cells, and with room to heave.
    """
    geometry, cell = study.geometry, study.discretisation.cell_m
    if geometry.kind == "slope":
        crest = geometry.crest_m
        toe = crest + geometry.height_m / tan(radians(geometry.angle_deg))
    else:
        crest = toe = geometry.width_m
    height = geometry.height_m
    outline = np.array([(0.0, 0.0), (toe, 0.0), (crest, height), (0.0, height)])
    length = _whole_cells(toe + geometry.foreland_m, cell)
    return Body(outline, toe, crest, height, length, _whole_cells(height + max(0.5 * height, 4.0 * cell), cell))


def fill(outline: np.ndarray, cell: float, points_per_cell: int) -> tuple[np.ndarray, np.ndarray]:
    """Fill a convex outline with material points.

    Each cell is divided into equal squares, one point each; a square cut by the outline gives a point at the centroid
    of what is inside, with that volume, so that volume and first moments are exact but for slivers below a millionth of
    a square.

    Args:
        outline: corners of a convex polygon, anticlockwise, shape (k, 2) [m].
        cell: side of a cell [m].
        points_per_cell: points in a full cell, a square number.

    Returns:
        Positions, shape (n, 2) [m], and volumes per metre of width, shape (n,) [m2]; row by row of cells from the base.
    """
    side = round(sqrt(points_per_cell))
    spacing = cell / side
    columns, rows = (ceil(extent / spacing - 1e-9) for extent in outline.max(axis=0))
    corners = np.stack(np.meshgrid(np.arange(columns + 1), np.arange(rows + 1)), axis=-1) * spacing
    inside = np.all(_distances(outline, corners) >= -1e-9 * spacing, axis=-1)
    whole = inside[:-1, :-1] & inside[:-1, 1:] & inside[1:, :-1] & inside[1:, 1:]
    positions, volumes = [], []
    for row, column in np.argwhere(np.ones_like(whole)):
        x, y = column * spacing, row * spacing
        if whole[row, column]:
            centre, volume = (x + 0.5 * spacing, y + 0.5 * spacing), spacing * spacing
        else:
            square = np.array([(x, y), (x + spacing, y), (x + spacing, y + spacing), (x, y + spacing)])
            centre, volume = centroid(clip(square, outline))
        if volume > 1e-6 * spacing * spacing:
            positions.append(centre)
            volumes.append(volume)
    positions, volumes = np.array(positions), np.array(volumes)
    cells = np.floor(positions / cell + 1e-9).astype(int)
    order = np.lexsort((cells[:, 0], cells[:, 1]))
    return positions[order], volumes[order]


def clip(polygon: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Cut a polygon to the inside of a convex outline (Sutherland and Hodgman 1974).

    Args:
        polygon: corners, shape (m, 2) [m].
        outline: corners of the convex outline, anticlockwise, shape (k, 2) [m].

    Returns:
        The corners of the intersection, shape (j, 2) [m]; j is 0 where there is none.
    """
    for start, end in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        along = end - start
        kept = []
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            left_a = along[0] * (a[1] - start[1]) - along[1] * (a[0] - start[0])
            left_b = along[0] * (b[1] - start[1]) - along[1] * (b[0] - start[0])
            if left_a >= 0.0:
                kept.append(a)
            if left_a * left_b < 0.0:
                kept.append(a + (b - a) * (left_a / (left_a - left_b)))
        polygon = np.array(kept).reshape(-1, 2)
    return polygon


def centroid(polygon: np.ndarray) -> tuple[tuple[float, float], float]:
    """Centroid (x, y) [m] and area [m2] of a polygon with corners of shape (m, 2), anticlockwise; area 0 if empty."""
    if len(polygon) < 3:
        return (0.0, 0.0), 0.0
    origin = polygon[0]
    x, y = (polygon - origin).T
    x_next, y_next = np.roll(x, -1), np.roll(y, -1)
    cross = x * y_next - x_next * y
    area = 0.5 * cross.sum()
    if area <= 0.0:
        return (0.0, 0.0), 0.0
    mean_x = ((x + x_next) * cross).sum() / (6.0 * area)
    mean_y = ((y + y_next) * cross).sum() / (6.0 * area)
    return (float(origin[0] + mean_x), float(origin[1] + mean_y)), float(area)


def _distances(outline: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Signed distance [m] of places (..., 2) to each edge's line, positive inside; shape (..., k)."""
    along = np.roll(outline, -1, axis=0) - outline
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    offset = places[..., None, :] - outline
    return along[:, 0] * offset[..., 1] - along[:, 1] * offset[..., 0]


def _whole_cells(extent: float, cell: float) -> float:
    return ceil(extent / cell - 1e-9) * cell
