"""Material points of a convex outline, by clipping squares with its edges."""

from math import ceil, sqrt

import numpy as np


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
    beside = _distances(outline, corners)
    inside = np.all(beside >= -1e-9 * spacing, axis=-1)
    whole = _each_corner(inside).all(axis=0).ravel()
    # What has all corners beyond one edge is outside, and need not be cut.
    cut = ~whole & ~_each_corner(beside < 0.0).all(axis=0).any(axis=-1).ravel()
    row, column = np.divmod(np.arange(len(whole)), columns)
    positions = np.stack([column * spacing + 0.5 * spacing, row * spacing + 0.5 * spacing], axis=-1)
    volumes = np.where(whole, spacing * spacing, 0.0)
    for k in np.flatnonzero(cut):
        x, y = column[k] * spacing, row[k] * spacing
        square = np.array([(x, y), (x + spacing, y), (x + spacing, y + spacing), (x, y + spacing)])
        positions[k], volumes[k] = centroid(clip(square, outline))
    return in_order(positions, volumes, cell, spacing)


def in_order(positions: np.ndarray, volumes: np.ndarray, cell: float, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Order points row by row of cells from the base, without slivers, which are below a millionth of a square."""
    kept = volumes > 1e-6 * spacing * spacing
    positions, volumes = positions[kept], volumes[kept]
    cells = np.floor(positions / cell + 1e-9).astype(int)
    order = np.lexsort((cells[:, 0], cells[:, 1]))
    return positions[order], volumes[order]


def _each_corner(values: np.ndarray) -> np.ndarray:
    """Values at the four corners of each square, shape (4, rows, columns, ...), from those at all corners."""
    return np.stack([values[:-1, :-1], values[:-1, 1:], values[1:, :-1], values[1:, 1:]])


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
