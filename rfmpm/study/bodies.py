"""The body of a study as far as its checks need it: its size, its outline, and the regions it consists of."""

from functools import lru_cache
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from rfmpm.ground import Region, Size, body_polygon, is_plain, regions_of, size_of_body, surface_of
from rfmpm.study.geometry_models import Geometry
from rfmpm.study.known import Known, Unknown

Place = tuple[float, float]  # x, y [m]
GEOMETRY = TypeAdapter(Geometry)


def geometry_of(known: Known) -> Any:
    """The geometry of a study; Unknown where some of it is wrong in itself."""
    if any(path[:1] == ("geometry",) for path in known.doubtful):
        raise Unknown("geometry")
    geometry = GEOMETRY.validate_python(known["geometry"])
    polygons = [one.corners_m for key in ("region", "cut") for one in getattr(geometry, key, None) or ()]
    if any(corners is None or len(corners) < 3 for corners in polygons) or getattr(geometry, "region", None) == ():
        raise Unknown("geometry")
    return geometry


def regions_in(known: Known) -> list[Region]:
    """The regions of a study, sound or not; Unknown where they cannot be told."""
    return _regions(geometry_of(known), known["material.0.name"], known["discretisation.cell_m"])


def sound_regions_in(known: Known) -> list[Region]:
    """The regions of a study; Unknown where one of them, or of the cuts, crosses itself."""
    import shapely

    regions = regions_in(known)
    cuts = [shapely.Polygon(cut.corners_m) for cut in getattr(geometry_of(known), "cut", None) or ()]
    if not all(polygon.is_valid for polygon in (*(region.polygon for region in regions), *cuts)):
        raise Unknown("geometry")
    return regions


@lru_cache(maxsize=64)
def _regions(geometry: Any, soil: str, cell: float) -> list[Region]:
    return regions_of(geometry, soil, cell)


def is_plain_body(known: Known) -> bool:
    """Whether the body is convex and of one soil."""
    return is_plain(geometry_of(known))


def size_of(known: Known) -> Size:
    """Size of the body; Unknown where it cannot be told."""
    geometry = geometry_of(known)
    if is_plain(geometry):
        return size_of_body(geometry)
    return size_of_body(geometry, sound_regions_in(known))


def ground_of(known: Known) -> np.ndarray:
    """Corners of the ground surface from left to right, shape (k, 2) [m]."""
    geometry, size = geometry_of(known), size_of(known)
    if not is_plain(geometry):
        return surface_of(body_polygon(geometry, sound_regions_in(known)), size.length).line
    crest = geometry.crest_m if geometry.kind == "slope" else geometry.width_m
    return np.array([(0.0, size.height), (crest, size.height), (size.length, 0.0)])


def height_of(known: Known) -> float:
    """Height of the highest ground above the base, from which depths are measured [m]."""
    return size_of(known).height


def hull_of(known: Known, material: str | None = None) -> list[Place]:
    """Corners of the convex hull of the body, or of the regions of one material, anticlockwise [m]."""
    import shapely

    polygons = [region.polygon for region in sound_regions_in(known) if material in (None, region.material)]
    hull = shapely.orient_polygons(shapely.union_all(polygons).convex_hull)
    return [(float(x), float(y)) for x, y in shapely.get_coordinates(hull)[:-1]]
