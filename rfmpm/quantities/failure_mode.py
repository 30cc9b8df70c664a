"""The kind of failure, told from where the soil lay, where it came to and how far it was sheared."""

from typing import NamedTuple

import numpy as np

from rfmpm import failure_modes as limits
from rfmpm.failure_modes import MODES
from rfmpm.quantities.blocks import block_areas
from rfmpm.quantities.state import FinalState, label_cells

CUTS = 11  # points of a slip surface, evenly spread over its length, through which lines are laid


class Shape(NamedTuple):
    """What a failed mass looks like."""

    flowed: float  # share of it that lost its shape [-]
    kept: float  # share of it that is in blocks [-]
    blocks: int
    main_block: float  # area of the largest over that of all; 1 without any [-]
    together: float  # least over largest displacement of its blocks, as quartiles of their volume; 1 without any [-]
    length: float  # of the slip surface, from the ground at its head to its toe, straight [m]
    depth: float  # of the slip surface below that line [m]
    thickness: float  # mean: volume over length [m]
    straight: float  # share of the slip surface that lies along one line [-]
    slope: float  # of that line, descending to the right [degrees]
    ridges: int  # of the ground over the failed mass


def failure_mode(state: FinalState) -> int:
    """Classify a state by how it failed.

    Args:
        state: at the end of a run, or at any other moment.

    Returns:
        Place of the kind in `failure_modes.MODES`.
    """
    return MODES.index(kind_of(shape(state), state.crest_height) if state.failed.any() else "no_failure")


def kind_of(found: Shape, height: float) -> str:
    """Name the kind of failure: the first that fits.

    Args:
        found: what the failed mass looks like.
        height: of the ground above the base [m].

    Returns:
        One of `failure_modes.MODES`, but for `no_failure`.

    Source: Hungr, Leroueil and Picarelli (2014); depth over length: Skempton and Hutchinson (1969), Cruden and Varnes
    (1996); horsts and grabens of spreads: Locat et al. (2011).
    """
    is_crumbs = found.kept < limits.KEPT_SHARE and found.flowed >= limits.FLOWED_AMONG_CRUMBS
    if found.flowed >= limits.FLOWED_SHARE or is_crumbs:
        return "earthflow"
    is_plane = found.straight >= limits.STRAIGHT_SHARE and found.depth < limits.PLANE_DEPTH * found.length
    if is_plane and found.together >= limits.TOGETHER:
        thin = max(limits.THIN_FOR_LENGTH * found.length, limits.THIN_FOR_HEIGHT * height)
        return "superficial" if found.thickness < thin else "translational"
    if found.main_block >= limits.MAIN_BLOCK:
        return "rotational"
    has_horsts = found.blocks >= limits.SPREAD_BLOCKS and found.ridges >= limits.SPREAD_RIDGES
    return "spread" if has_horsts and found.slope <= limits.SPREAD_SLOPE else "retrogressive"


def shape(state: FinalState) -> Shape:
    """Measure what a failed mass looks like; its slip surface is that of its largest part before it moved."""
    failed, volume = np.flatnonzero(state.failed), state.volume_initial
    areas = block_areas(state)
    part = label_cells(state.x_initial[failed], state.y_initial[failed], state.cell, diagonal=True)
    largest = failed[part == np.bincount(part, weights=volume[failed]).argmax()]
    x, y = _slip_surface(state, largest)
    chord = np.array([x[-1], y[-1] - y[0]])
    length = float(np.hypot(*chord))
    thickness = float(volume[largest].sum()) / length
    straight, slope = _straightest(x, y, limits.STRAIGHT_WIDTH * length)
    sheared = failed[state.plastic_strain[failed] >= limits.FLOW_STRAIN]
    return Shape(
        flowed=float(volume[sheared].sum() / volume[failed].sum()),
        kept=float(areas.sum() / volume[failed].sum()),
        blocks=len(areas),
        main_block=float(areas.max() / areas.sum()) if len(areas) else 1.0,
        together=_together(state, failed[state.plastic_strain[failed] < state.block_plastic_strain]),
        length=length,
        depth=float(np.max(x * chord[1] - (y - y[0]) * chord[0])) / length,
        thickness=thickness,
        straight=straight,
        slope=slope,
        ridges=_ridges(_ground(state, failed, slope), limits.RIDGE_HEIGHT * thickness),
    )


def _slip_surface(state: FinalState, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower border of some points at the start, from the ground at their left end; x from there [m], y [m]."""
    column = np.floor(state.x_initial / state.cell).astype(int)
    first, last = column[points].min(), column[points].max()
    low = np.full(last - first + 1, np.inf)
    np.minimum.at(low, column[points] - first, state.y_initial[points])
    top = state.y_initial[points[column[points] == first]].max() + 0.5 * state.spacing
    filled = np.flatnonzero(np.isfinite(low))
    y = low[filled] - 0.5 * state.spacing
    x = np.concatenate([[0.0], filled + 0.5, [filled[-1] + 1.0]]) * state.cell
    return x, np.concatenate([[top], y, y[-1:]])


def _straightest(x: np.ndarray, y: np.ndarray, width: float) -> tuple[float, float]:
    """Share of a curve that lies so near to a line through two of its points [-], and how that descends [degrees]."""
    pieces = np.hypot(np.diff(x), np.diff(y))
    along = np.concatenate([[0.0], np.cumsum(pieces)])
    weights = 0.5 * (np.append(pieces, 0.0) + np.append(0.0, pieces)) / along[-1]
    at = np.linspace(0.0, along[-1], CUTS)
    px, py = np.interp(at, along, x), np.interp(at, along, y)
    start, end = np.triu_indices(CUTS, 2)
    dx, dy = px[end] - px[start], py[end] - py[start]
    away = np.abs(dx[:, None] * (y - py[start, None]) - dy[:, None] * (x - px[start, None]))
    shares = (away <= width * np.hypot(dx, dy)[:, None]) @ weights
    best = shares.argmax()
    return float(shares[best]), float(np.degrees(np.arctan2(-dy[best], dx[best])))


def _together(state: FinalState, whole: np.ndarray) -> float:
    if not len(whole):
        return 1.0
    moved = np.hypot(state.x - state.x_initial, state.y - state.y_initial)[whole]
    order = np.argsort(moved, kind="stable")
    share = np.cumsum(state.volume_initial[whole][order])
    least, most = moved[order[np.searchsorted(share, np.array([0.25, 0.75]) * share[-1])]]
    return float(least / most)


def _ground(state: FinalState, failed: np.ndarray, slope: float) -> list[float]:
    """Height of the ground, from behind the failed mass to before it, above a slope [m]; one for two cells, moving."""
    column = np.floor(state.x / state.cell).astype(int)
    first, last = column[failed].min() - 1, column[failed].max() + 2
    height = np.zeros(last - first + 1)
    inside = (column >= first) & (column <= last)
    np.maximum.at(height, column[inside] - first, (state.y + 0.5 * np.sqrt(state.volume))[inside])
    height = np.maximum(height[:-1], height[1:])  # a single cell without points is no gap in the ground
    rise = np.tan(np.radians(max(slope, 0.0))) * state.cell
    return np.where(height > 0.0, height + rise * np.arange(len(height)), 0.0).tolist()


def _ridges(ground: list[float], least: float) -> int:
    """Count the rises and falls of so much that follow each other from left to right, a rise first."""
    count, is_up, turn = 0, False, ground[0]
    for height in ground:
        turn = max(turn, height) if is_up else min(turn, height)
        if abs(height - turn) >= least:
            count, is_up, turn = count + (not is_up), not is_up, height
    return count
