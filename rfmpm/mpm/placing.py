"""Where the loads and obstacles of a study act: points of the surface, nodes of the grid."""

from math import sqrt

import numpy as np

from rfmpm.mpm.attachments import Load, Obstacle
from rfmpm.mpm.geometry import Body


def load_of(study, position: np.ndarray) -> Load | None:
    """Put the loads of a study on the highest point of each column of squares below them.

    Args:
        study: the study.
        position: of the points, shape (n, 2) [m].

    Returns:
        The load; None where there is none.
    """
    if not study.load:
        return None
    square = study.discretisation.cell_m / sqrt(study.discretisation.points_per_cell)
    column = np.floor(position[:, 0] / square + 1e-9).astype(int)
    order = np.lexsort((position[:, 1], column))
    highest = order[np.append(np.diff(column[order]) > 0, True)]
    left = column[highest] * square
    force = np.zeros(len(highest))
    for load in study.load:
        width = np.minimum(load.to_m, left + square) - np.maximum(load.from_m, left)
        force += load.pressure_kpa * 1e3 * np.maximum(width, 0.0)
    chosen = force > 0.0
    return Load(highest[chosen], force[chosen], position[highest[chosen], 1].copy())


def obstacle_of(study, shape: Body) -> Obstacle | None:
    """Find the nodes of the obstacles of a study; None where there are none."""
    if not study.obstacle:
        return None
    import shapely

    cell, found = study.discretisation.cell_m, []
    columns, rows = np.meshgrid(np.arange(round(shape.length / cell) + 1), np.arange(round(shape.top / cell) + 1))
    nodes = shapely.points(columns.ravel() * cell, rows.ravel() * cell)
    for obstacle in study.obstacle:
        polygon = shapely.orient_polygons(shapely.Polygon(obstacle.corners_m))
        corners = shapely.get_coordinates(polygon.exterior)
        along = np.diff(corners, axis=0)
        normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
        # What stands on the base is not met from below.
        met = ~((corners[:-1, 1] <= 1e-9 * cell) & (corners[1:, 1] <= 1e-9 * cell))
        sides = shapely.linestrings(np.stack([corners[:-1], corners[1:]], axis=1))[met]
        inside = np.flatnonzero(shapely.distance(polygon, nodes) <= 1e-9 * cell)
        nearest = np.argmin(shapely.distance(sides[:, None], nodes[inside][None, :]), axis=0)
        normal = normals[met][nearest]
        found.append(
            (rows.ravel()[inside], columns.ravel()[inside], *normal.T, np.full(len(inside), obstacle.friction))
        )
    return Obstacle(*(np.concatenate(values) for values in zip(*found, strict=True)), np.zeros(2))
