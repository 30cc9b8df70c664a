"""The ground in plan: polygons of soil, what is wrong with them, and the surface with its toe and crest."""

from rfmpm.ground.faults import faults
from rfmpm.ground.regions import Region, Size, body_polygon, corners_of, end_of, is_plain, regions_of, size_of_body
from rfmpm.ground.surface import Surface, height_at, surface_of

__all__ = [
    "Region",
    "Size",
    "Surface",
    "body_polygon",
    "corners_of",
    "end_of",
    "faults",
    "height_at",
    "is_plain",
    "regions_of",
    "size_of_body",
    "surface_of",
]
