"""The material points of a body of one or several soils."""

from collections.abc import Sequence
from math import ceil, floor, sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm.ground import is_plain, regions_of
from rfmpm.mpm.geometry.body import Body
from rfmpm.mpm.geometry.convex import fill, in_order

WHOLE = 1.0 - 1e-9  # of a square; a larger part of it counts as all


class Filling(NamedTuple):
    """Material points, material by material in the order of the study, each row by row of cells from the base."""

    position: np.ndarray  # (n, 2) [m]
    volume: np.ndarray  # (n,) [m3/m]
    counts: tuple[int, ...]  # points of each material


def fill_body(study, shape: Body) -> tuple[Filling, Filling | None]:
    """Fill the body of a study.

    Args:
        study: the study.
        shape: its body.

    Returns:
        Its points, and those of what is cut from it when the run begins; None where nothing is.
    """
    cell, per_cell = study.discretisation.cell_m, study.discretisation.points_per_cell
    if is_plain(study.geometry):
        position, volume = fill(shape.outline, cell, per_cell)
        return Filling(position, volume, (len(volume),)), None
    import shapely

    regions = regions_of(study.geometry, study.material[0].name, cell)
    soils = [
        shapely.union_all([region.polygon for region in regions if region.material == material.name])
        for material in study.material
    ]
    cuts = study.geometry.cut
    if not cuts:
        return _filled(soils, cell, per_cell), None
    cut = shapely.union_all([shapely.Polygon(one.corners_m) for one in cuts])
    kept, gone = (
        _filled([take(soil, cut) for soil in soils], cell, per_cell)
        for take in (shapely.difference, shapely.intersection)
    )
    return kept, gone


def _filled(soils: Sequence[Any], cell: float, per_cell: int) -> Filling:
    filled = [fill_polygon(soil, cell, per_cell) for soil in soils]
    position, volume = (np.concatenate(arrays) for arrays in zip(*filled, strict=True))
    return Filling(position, volume, tuple(len(own) for _, own in filled))


def fill_polygon(polygon: Any, cell: float, points_per_cell: int) -> tuple[np.ndarray, np.ndarray]:
    """Fill any polygon with material points, as `fill` does a convex one.

    Args:
        polygon: one or several polygons, with or without holes [m].
        cell: side of a cell [m].
        points_per_cell: points in a full cell, a square number.

    Returns:
        Positions, shape (n, 2) [m], and volumes per metre of width, shape (n,) [m2]; at most one point to a square.
    """
    import shapely

    if polygon.is_empty:
        return np.empty((0, 2)), np.empty(0)
    spacing = cell / round(sqrt(points_per_cell))
    left, low, right, high = (bound / spacing for bound in polygon.bounds)
    columns, rows = (
        np.arange(max(floor(first + 1e-9), 0), ceil(last - 1e-9)) for first, last in ((left, right), (low, high))
    )
    column, row = (places.ravel() for places in np.meshgrid(columns, rows))
    squares = shapely.box(column * spacing, row * spacing, (column + 1) * spacing, (row + 1) * spacing)
    shapely.prepare(polygon)
    whole = shapely.contains(polygon, squares)
    cut = np.flatnonzero(~whole & shapely.intersects(polygon, squares))
    pieces = shapely.intersection(polygon, squares[cut])
    area, centre = shapely.area(pieces), shapely.centroid(pieces)
    positions = np.stack([column * spacing + 0.5 * spacing, row * spacing + 0.5 * spacing], axis=-1)
    volumes = np.where(whole, spacing * spacing, 0.0)
    part = area < WHOLE * spacing * spacing
    positions[cut[part]] = np.stack([shapely.get_x(centre[part]), shapely.get_y(centre[part])], axis=-1)
    volumes[cut] = np.where(part, area, spacing * spacing)
    return in_order(positions, volumes, cell, spacing)
