"""The regions of soil of a geometry, as polygons; those of a slope with layers are made from its numbers."""

from math import ceil, radians, tan
from typing import Any, NamedTuple

import numpy as np


class Region(NamedTuple):
    """A region of one soil."""

    name: str
    material: str
    polygon: Any  # shapely polygon [m]


def is_plain(geometry: Any) -> bool:
    """Whether the body is convex and of one soil: a block, or a slope on its base alone."""
    if geometry.kind == "regions":
        return False
    extras = ("layer", "bench", "foundation_m", "cut")
    return geometry.kind == "block" or all(getattr(geometry, key) is None for key in extras)


def regions_of(geometry: Any, soil: str, cell: float) -> list[Region]:
    """Make the regions of a geometry, before anything is cut from them.

    Args:
        geometry: of a study, right in itself.
        soil: name of the material that a slope or block consists of where nothing else is said.
        cell: side of a cell [m]; a foundation reaches to the end of the domain, a whole number of them.

    Returns:
        The regions. A foundation lies below the slope and its layers; layers follow each other from the crest down.
    """
    import shapely

    if geometry.kind == "regions":
        return [Region(one.name, one.material, shapely.Polygon(one.corners_m)) for one in geometry.region]
    if geometry.kind == "block":
        return [Region("block", soil, shapely.box(0.0, 0.0, geometry.width_m, geometry.height_m))]
    depth = geometry.foundation_m or 0.0
    face = _face(geometry)
    slope = shapely.Polygon([(0.0, depth), *((x, depth + y) for x, y in face), (0.0, depth + geometry.height_m)])
    made, level = [], depth + geometry.height_m
    for number, layer in enumerate(geometry.layer or ()):
        below = level - layer.thickness_m
        strip = shapely.intersection(slope, shapely.box(0.0, below, face[0][0] + 1.0, level))
        made.append(Region(f"layer.{number}", layer.material, strip))
        level = below
    if level > depth + 1e-9 * geometry.height_m:
        rest = shapely.intersection(slope, shapely.box(0.0, depth, face[0][0] + 1.0, level)) if made else slope
        made.append(Region("slope", soil, rest))
    if depth:
        length = ceil((face[0][0] + geometry.foreland_m) / cell - 1e-9) * cell
        material = geometry.foundation_material or soil
        made.append(Region("foundation", material, shapely.box(0.0, 0.0, length, depth)))
    return made


def end_of(geometry: Any, regions: list[Region]) -> float:
    """Where the domain of a geometry ends at the right, before it is rounded up to whole cells [m]."""
    if geometry.kind == "regions":
        return max(region.polygon.bounds[2] for region in regions) + geometry.foreland_m
    return _face(geometry)[0][0] + geometry.foreland_m


def _face(geometry: Any) -> list[tuple[float, float]]:
    """Corners of the face of a slope from toe to crest [m], the toe at height 0."""
    per_metre = 1.0 / tan(radians(geometry.angle_deg))
    benches = sorted((bench.height_m, bench.width_m) for bench in geometry.bench or ())
    x = geometry.crest_m + geometry.height_m * per_metre + sum(width for _, width in benches)
    corners, below = [(x, 0.0)], 0.0
    for height, width in benches:
        x -= (height - below) * per_metre
        corners += [(x, height), (x - width, height)]
        x, below = x - width, height
    return [*corners, (geometry.crest_m, geometry.height_m)]


class Size(NamedTuple):
    """How large a body is."""

    area: float  # [m2]
    length: float  # from the left side to its right end [m]
    height: float  # of its highest ground above the base [m]


def size_of_body(geometry: Any, regions: list[Region] | None = None) -> Size:
    """Size of a body, whose regions are needed unless it is plain."""
    if not is_plain(geometry):
        whole = body_polygon(geometry, regions)
        _, _, right, top = whole.bounds
        return Size(whole.area, right, top)
    if geometry.kind == "block":
        return Size(geometry.width_m * geometry.height_m, geometry.width_m, geometry.height_m)
    face = geometry.height_m / tan(radians(geometry.angle_deg))
    return Size((geometry.crest_m + 0.5 * face) * geometry.height_m, geometry.crest_m + face, geometry.height_m)


def body_polygon(geometry: Any, regions: list[Region]) -> Any:
    """The regions as one polygon, or several where they do not touch, without what is cut from them."""
    import shapely

    whole = shapely.union_all([region.polygon for region in regions])
    for cut in getattr(geometry, "cut", None) or ():
        whole = shapely.difference(whole, shapely.Polygon(cut.corners_m))
    return whole


def corners_of(polygon: Any) -> np.ndarray:
    """Corners of the outer border of a polygon, of the largest one of several, shape (k, 2) [m], anticlockwise."""
    import shapely

    pieces = shapely.get_parts(polygon)
    largest = pieces[np.argmax(shapely.area(pieces))]
    simple = shapely.simplify(largest, 1e-9 * max(largest.bounds))
    return shapely.get_coordinates(shapely.orient_polygons(simple).exterior)[:-1]
