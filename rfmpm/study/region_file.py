"""Reads the outline of a region from a file: GeoJSON, CSV or DXF."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rfmpm.columns import ColumnsError, read_columns

HEADERS = {"x_m": ("x_m", "x"), "y_m": ("y_m", "y")}
Corners = list[list[float]]
Named = list[tuple[str, Corners]]


def read_region(path: Path, entry: Mapping[str, Any]) -> Corners:
    """Read the corners of a region.

    Args:
        path: a file whose name ends in one of READERS.
        entry: the table of the region; of several polygons in the file that of its `name` is taken: the property name
            of a GeoJSON feature, the layer of a DXF polyline.

    Returns:
        `corners_m` of the table.

    Raises:
        ColumnsError: what is wrong with the file.
        OSError: it cannot be read.
    """
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ColumnsError(path, [f"must be a file whose name ends in {', '.join(READERS)}"])
    found = reader(path)
    own = found if len(found) == 1 else [one for one in found if one[0] == entry.get("name")]
    if len(own) != 1:
        names = ", ".join(f'"{name}"' for name, _ in found) or "none"
        raise ColumnsError(path, [f"must hold one polygon, or one of the region's name; it has {names}"])
    corners = own[0][1]
    return corners[:-1] if len(corners) > 1 and corners[0] == corners[-1] else corners


def _of_csv(path: Path) -> Named:
    columns = read_columns(path, HEADERS)
    return [("", [list(corner) for corner in zip(columns["x_m"], columns["y_m"], strict=True)])]


def _of_geojson(path: Path) -> Named:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        features = content["features"] if content["type"] == "FeatureCollection" else [content]
        return [polygon for feature in features for polygon in _of_feature(path, feature)]
    except (ValueError, KeyError, TypeError, IndexError, AttributeError) as error:
        if isinstance(error, ColumnsError):
            raise
        raise ColumnsError(path, [f"is not GeoJSON with a polygon ({type(error).__name__}: {error})"]) from None


def _of_feature(path: Path, feature: Mapping[str, Any]) -> Named:
    name = str((feature.get("properties") or {}).get("name", ""))
    shape = feature["geometry"] if feature["type"] == "Feature" else feature
    if shape["type"] not in ("Polygon", "MultiPolygon"):
        return []
    found = []
    for rings in [shape["coordinates"]] if shape["type"] == "Polygon" else shape["coordinates"]:
        if len(rings) > 1:
            x, y = rings[1][0][:2]
            text = f'polygon "{name}" has a hole at x = {x:g} m, y = {y:g} m: make the soil in it a region of its own'
            raise ColumnsError(path, [text])
        found.append((name, [[float(x) for x in corner[:2]] for corner in rings[0]]))
    return found


def _of_dxf(path: Path) -> Named:
    try:
        import ezdxf
    except ImportError:
        raise ColumnsError(path, ["needs the package ezdxf: pip install 'rfmpm[dxf]'"]) from None
    try:
        lines = ezdxf.readfile(path).modelspace().query("LWPOLYLINE POLYLINE")
    except ezdxf.DXFError as error:
        raise ColumnsError(path, [f"is not a DXF drawing ({error})"]) from None
    return [(line.dxf.layer, _corners(line)) for line in lines if line.is_closed or _ends_meet(line)]


def _corners(line: Any) -> Corners:
    if line.dxftype() == "LWPOLYLINE":
        return [[float(x), float(y)] for x, y in line.get_points("xy")]
    return [[float(point.x), float(point.y)] for point in line.points()]


def _ends_meet(line: Any) -> bool:
    corners = _corners(line)
    return len(corners) > 3 and corners[0] == corners[-1]


READERS = {".geojson": _of_geojson, ".json": _of_geojson, ".csv": _of_csv, ".dxf": _of_dxf}
