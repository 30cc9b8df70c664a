"""Factor of safety by limit equilibrium: the slip surface of least factor through the soil of a realisation."""

from typing import NamedTuple

import numpy as np

from rfmpm.stability.arcs import Line, arc, draw, refine, survey
from rfmpm.stability.equilibrium import BISHOP, MORGENSTERN_PRICE, SPENCER, factor
from rfmpm.stability.polygons import fill_in, improve, set_corners, survey_clipped
from rfmpm.stability.section import Side, Soil, soil_of
from rfmpm.stability.slices import Slices, cut, make_slices

ASSUMPTIONS = {"bishop": BISHOP, "spencer": SPENCER, "morgenstern_price": MORGENSTERN_PRICE}
WAYS, DEPTHS = 56, 12  # arcs surveyed: ways along the ground, beside its corners, and depths
DEPTHS_CUT_OFF = 6  # of arcs that the base cuts off
COARSE, FINE = 32, 96  # slices of an arc that is surveyed, and of one that is judged
STARTS = 4  # best arcs of the survey, apart from each other, that are refined
ROUNDS = 24  # of refinement
CORNERS = 12  # of a surface that is no circle
LEVELS = 12  # at which arcs are cut off to start from
FIRST_STEP, LAST_STEP = 0.1, 0.5  # of a corner: in widths of the surface, and in squares
NEXT_BEST = 2000  # entries of a survey among which starts that lie apart are sought
ROOM = 4 * FINE


class Critical(NamedTuple):
    """The slip surface of least factor.

    Attributes:
        factor: of safety [-]; infinite where the method has no solution on any surface.
        kind: "circle", cut off at a base with friction, or "polygon"; empty where there is none.
        surface: from its upper end, on the ground or at the foot of the tension crack, to the lower, shape (k, 2) [m].
    """

    factor: float
    kind: str
    surface: np.ndarray


NOWHERE = Critical(np.inf, "", np.empty((0, 2)))
Ends = tuple[float, float]  # where a surface enters and leaves, as ways along the ground [m]


class _Bench(NamedTuple):
    """Room that all surfaces tried share."""

    line: Line
    slices: Slices


def critical_surface(
    sides: tuple[Side, ...],
    cohesion: np.ndarray,
    friction_angle: np.ndarray,
    unit_weight: np.ndarray,
    method: str = "bishop",
    circles_only: bool = False,
) -> Critical:
    """Find the slip surface of least factor.

    Bishop's method is for circles; the others go on from the best circle to surfaces of any shape.

    Args:
        sides: of the section, as from `sides_of`.
        cohesion: at the material points, shape (n,) [Pa].
        friction_angle: at the material points, shape (n,) [rad].
        unit_weight: at the material points, shape (n,) [N/m3].
        method: "bishop", "spencer" or "morgenstern_price".
        circles_only: leave surfaces of other shapes out.

    Returns:
        The surface and its factor.

    Raises:
        KeyError: there is no such method.
    """
    assumption = ASSUMPTIONS[method]
    found = NOWHERE
    for side in sides:
        soil = soil_of(side, cohesion, friction_angle, unit_weight)
        bench = _Bench(Line(np.empty(ROOM), np.empty(ROOM)), make_slices(ROOM))
        ways = _ways(side)
        best, ends = _best_circle(side, soil, ways, assumption, bench)
        if assumption != BISHOP and not circles_only:
            best = min(best, _best_polygon(side, soil, ways, best, ends, assumption, bench), key=_factor)
        if best.factor < found.factor:
            found = best._replace(surface=best.surface * [side.sign, 1.0])
    return found


def factor_along(
    side: Side,
    cohesion: np.ndarray,
    friction_angle: np.ndarray,
    unit_weight: np.ndarray,
    surface: np.ndarray,
    method: str = "morgenstern_price",
) -> float:
    """Factor of safety of a given slip surface.

    Args:
        side: of the section, on which the soil slides to the right.
        cohesion: at the material points, shape (n,) [Pa].
        friction_angle: at the material points, shape (n,) [rad].
        unit_weight: at the material points, shape (n,) [N/m3].
        surface: corners from the upper end to the lower one, shape (k, 2) [m].
        method: "bishop" (a circle, then), "spencer" or "morgenstern_price".

    Returns:
        The factor [-]; infinite where the surface leaves the ground or the method has no solution.
    """
    soil = soil_of(side, cohesion, friction_angle, unit_weight)
    corners = Line(*np.ascontiguousarray(surface.T, dtype=float))
    line, slices = Line(np.empty(ROOM + len(surface)), np.empty(ROOM + len(surface))), make_slices(ROOM + len(surface))
    pieces = fill_in(corners, len(surface), FINE, line)
    if cut(side.ground, soil, line.x, line.y, pieces, slices) < 0.0:
        return np.inf
    return factor(slices, pieces, ASSUMPTIONS[method])


def _factor(critical: Critical) -> float:
    return critical.factor


def _ways(side: Side) -> np.ndarray:
    """Places along the ground between which surfaces are surveyed [m]."""
    along = side.ground.along
    return np.unique(np.concatenate([np.linspace(0.0, along[-1], WAYS), along]))


def _best_circle(side: Side, soil: Soil, ways: np.ndarray, assumption: int, bench: _Bench) -> tuple[Critical, Ends]:
    ground, depths = side.ground, np.linspace(1.0 / DEPTHS, 1.0, DEPTHS)
    if ground.base_friction < np.inf:
        depths = np.append(depths, 1.0 + np.arange(1.0, DEPTHS_CUT_OFF + 1.0) / DEPTHS_CUT_OFF)
    found = np.empty((len(ways), len(ways), len(depths)))
    survey(ground, soil, ways, depths, COARSE, assumption, *bench, found)
    steps = (ways[-1] / (WAYS - 1), 1.0 / DEPTHS)
    best, names = np.inf, (0.0, 0.0, 0.0)
    for i, j, k in _apart(found, STARTS):
        start = (ways[i], ways[j], depths[k])
        tried, *at = refine(ground, soil, *start, steps, ROUNDS, FINE, assumption, *bench)
        if tried < best:
            best, names = tried, tuple(at)
    if best == np.inf:
        return NOWHERE, names[:2]
    draw(ground, arc(ground, *names), FINE, bench.line)
    return Critical(best, "circle", np.column_stack(bench.line)[: FINE + 1]), names[:2]


def _best_polygon(
    side: Side, soil: Soil, ways: np.ndarray, circle: Critical, ends: Ends, assumption: int, bench: _Bench
) -> Critical:
    ground, corners = side.ground, Line(np.empty(CORNERS), np.empty(CORNERS))
    starts = []
    if circle.kind:
        starts.append((circle.surface[np.linspace(0, FINE, CORNERS).astype(int)], *ends))
    some, depths = ways[::3], np.array([0.5, 1.0])
    levels = np.linspace(ground.base, ground.y.max(), LEVELS, endpoint=False)
    found = np.empty((len(some), len(some), len(depths), LEVELS))
    deep = ground._replace(base=ground.base - ways[-1])
    survey_clipped(ground, deep, soil, some, depths, levels, CORNERS, COARSE, assumption, corners, *bench, found)
    for i, j, k, m in _apart(found, STARTS):
        set_corners(ground, levels[m], arc(deep, some[i], some[j], depths[k]), corners, CORNERS)
        starts.append((np.column_stack(corners), some[i], some[j]))
    best = NOWHERE
    for start, entry, leaving in starts:
        corners.x[:], corners.y[:] = start.T
        if ground.crack > 0.0:  # the surface enters the ground above the foot of its crack
            entry = np.interp(start[0, 0], ground.x, ground.along)
        step = FIRST_STEP * (start[-1, 0] - start[0, 0])
        tried = improve(
            ground, soil, corners, CORNERS, entry, leaving, step, LAST_STEP * side.square, FINE, assumption, *bench
        )
        if tried < best.factor:
            best = Critical(tried, "polygon", np.column_stack(corners))
    return best


def _apart(found: np.ndarray, count: int) -> list[tuple[int, ...]]:
    """Places of the smallest finite entries of a survey, each more than two steps from the others along some axis."""
    kept: list[tuple[int, ...]] = []
    for flat in np.argsort(found, axis=None)[:NEXT_BEST]:
        place = tuple(int(index) for index in np.unravel_index(flat, found.shape))
        if found[place] == np.inf or len(kept) == count:
            break
        if all(max(abs(a - b) for a, b in zip(place, other, strict=True)) > 2 for other in kept):
            kept.append(place)
    return kept
