"""The body of a study: its outline, its toe and crest, and the domain around it."""

from math import ceil, radians, tan
from typing import NamedTuple

import numpy as np

from rfmpm.ground import body_polygon, corners_of, end_of, is_plain, regions_of, surface_of


class Body(NamedTuple):
    """A body on the base, after what is cut from it is gone."""

    outline: np.ndarray  # (k, 2) corners, anticlockwise; of a slope or block from the lower left [m]
    toe: float  # x of the toe [m]
    crest_edge: float  # x of the edge of the crest [m]
    height: float  # of the highest ground above the base [m]
    length: float  # of the domain, a whole number of cells [m]
    top: float  # of the domain, a whole number of cells [m]
    reach: tuple[float, float]  # length and height from the origin that squares of any cell size may touch [m]
    ground: np.ndarray | None = None  # (j, 2) corners of the ground surface from left to right; None: convex [m]


def body(study) -> Body:
    """Describe the body of a study.

    Args:
        study: the study; its `geometry`, `discretisation` and first material's name are read.

    Returns:
        The body, with the domain around it: as long as asked, rounded up to whole cells, and with room to heave.
    """
    geometry, cell = study.geometry, study.discretisation.cell_m
    if not is_plain(geometry):
        return _of_regions(study)
    if geometry.kind == "slope":
        crest = geometry.crest_m
        toe = crest + geometry.height_m / tan(radians(geometry.angle_deg))
    else:
        crest = toe = geometry.width_m
    height = geometry.height_m
    outline = np.array([(0.0, 0.0), (toe, 0.0), (crest, height), (0.0, height)])
    length = _whole_cells(toe + geometry.foreland_m, cell)
    # A slope is at least four cells high, so no square reaches further than a quarter of its height.
    reach = toe + (0.25 * height if toe > crest else 0.0), height
    return Body(outline, toe, crest, height, length, _whole_cells(height + _headroom(height, cell), cell), reach)


def _of_regions(study) -> Body:
    geometry, cell = study.geometry, study.discretisation.cell_m
    regions = regions_of(geometry, study.material[0].name, cell)
    polygon, end = body_polygon(geometry, regions), end_of(geometry, regions)
    length = _whole_cells(end, cell)
    highest = max(region.polygon.bounds[3] for region in regions)
    surface = surface_of(polygon, length, getattr(geometry, "toe_m", None), getattr(geometry, "crest_edge_m", None))
    height = float(surface.line[:, 1].max())
    headroom = getattr(geometry, "headroom_m", None) or _headroom(highest, cell)
    # At least four cells high: no square reaches further than a quarter of its height.
    reach = end + 0.25 * highest, 1.25 * highest
    return Body(
        corners_of(polygon),
        surface.toe,
        surface.crest_edge,
        height,
        length,
        _whole_cells(highest + headroom, cell),
        reach,
        surface.line,
    )


def _headroom(height: float, cell: float) -> float:
    return max(0.5 * height, 4.0 * cell)


def _whole_cells(extent: float, cell: float) -> float:
    return ceil(extent / cell - 1e-9) * cell
