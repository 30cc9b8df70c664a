"""What is wrong with the regions of a body: by name, place and area."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from rfmpm.ground.regions import Region

NARROW = 1e-3  # of a cell; what is narrower of an overlap or a gap is the rounding of its corners


def faults(regions: Sequence[Region], cell: float) -> Iterator[tuple[int, str]]:
    """Find everything that is wrong with the regions of a body.

    Args:
        regions: of the body.
        cell: side of a cell [m].

    Yields:
        Number of the region that is concerned, the last one where there are several, and what is wrong with it.
    """
    import shapely

    sound = []
    for number, (_, _, polygon) in enumerate(regions):
        own = list(_of_one(polygon, cell))
        yield from ((number, text) for text in own)
        if polygon.is_valid:
            sound.append(number)
    for first, second in combinations(sound, 2):
        common = shapely.intersection(regions[first].polygon, regions[second].polygon)
        if _is_wide(common, cell):
            yield second, f'overlaps region "{regions[first].name}" {_where(common)}: they may only touch'
    if len(sound) == len(regions):
        yield from _of_all(regions, cell)


def _of_one(polygon: Any, cell: float) -> Iterator[str]:
    import shapely

    if not polygon.is_valid:
        reason = shapely.is_valid_reason(polygon)
        at = reason[reason.find("[") + 1 : reason.find("]")].split()
        place = f" at x = {float(at[0]):.4g} m, y = {float(at[1]):.4g} m" if len(at) == 2 else ""
        yield f"crosses or touches itself{place}: its corners must follow each other around it, each once"
        return
    left, low, right, high = polygon.bounds
    if left < -1e-9 * cell or low < -1e-9 * cell:
        outside = shapely.difference(polygon, shapely.box(0.0, 0.0, max(right, cell), max(high, cell)))
        yield f"lies outside the domain {_where(outside)}: x must be at least 0, the left side, y at least 0, the base"
    if shapely.buffer(polygon, -0.5 * cell * (1.0 - 1e-6), join_style="mitre").is_empty:
        yield (
            f"is thinner than a cell of {cell:g} m everywhere, {_where(polygon)}: "
            "take smaller cells, or join it to another region"
        )


def _of_all(regions: Sequence[Region], cell: float) -> Iterator[tuple[int, str]]:
    import shapely

    whole = shapely.union_all([region.polygon for region in regions])
    for piece in shapely.get_parts(whole):
        for ring in piece.interiors:
            hole = shapely.Polygon(ring)
            if _is_wide(hole, cell):
                yield from _between(regions, hole, cell, "leaves a hole", "fill it with a region")
        under = shapely.intersection(piece.exterior, shapely.LineString([(-1.0, 0.0), (piece.bounds[2] + 1.0, 0.0)]))
        if under.length < cell and not piece.bounds[1] < 0.0:
            last = max(number for number, one in enumerate(regions) if piece.covers(one.polygon.representative_point()))
            yield (
                last,
                f"does not rest on the base {_where(piece)}: y must be 0 along its underside, "
                "or it must lie on a region that does",
            )
    reach = 0.5 * cell
    wider = shapely.buffer(whole, reach, join_style="mitre")
    closed = shapely.difference(shapely.buffer(wider, -reach, join_style="mitre"), whole)
    filled = [shapely.Polygon(ring) for piece in shapely.get_parts(whole) for ring in piece.interiors]
    for gap in shapely.get_parts(shapely.difference(closed, shapely.union_all(filled))):
        if gap.geom_type == "Polygon" and _is_wide(gap, cell) and len(_touching(regions, gap, cell)) > 1:
            yield from _between(regions, gap, cell, "leaves a gap", "let them share their border")


def _between(regions: Sequence[Region], space: Any, cell: float, fault: str, remedy: str) -> Iterator[tuple[int, str]]:
    around = _touching(regions, space, cell)
    last, *others = reversed(around)
    names = " and ".join(f'"{regions[number].name}"' for number in reversed(others))
    beside = f" to region {names}" if others else ""
    yield last, f"{fault}{beside} {_where(space)}: {remedy}"


def _touching(regions: Sequence[Region], space: Any, cell: float) -> list[int]:
    """Regions that touch a space; at least one."""
    away = np.array([region.polygon.distance(space) for region in regions])
    return list(np.flatnonzero(away <= max(NARROW * cell, away.min())))


def _is_wide(space: Any, cell: float) -> bool:
    return not space.buffer(-0.5 * NARROW * cell).is_empty


def _where(space: Any) -> str:
    point = space.representative_point()
    return f"around x = {point.x:.4g} m, y = {point.y:.4g} m ({space.area:.3g} m2)"
