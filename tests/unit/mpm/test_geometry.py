"""Filling a body with points keeps its area and first moments; the closed forms of clipping and centroids."""

from math import radians, tan
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rfmpm.mpm.geometry import body, centroid, clip, fill
from rfmpm.study import load_study

SHORT_SLOPE = Path(__file__).parents[3] / "configs" / "short_slope.toml"
IDENTITY = 1e-12
SLIVER = 1e-6  # of a full point's volume: `fill` leaves out what is smaller
UNIT_SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])


def slope_outline(crest, height, angle):
    toe = crest + height / tan(radians(angle))
    return np.array([(0.0, 0.0), (toe, 0.0), (crest, height), (0.0, height)])


def moments_of_slope(crest, height, angle):
    """Area and first moments of a rectangle and a triangle."""
    face = height / tan(radians(angle))
    rectangle, triangle = crest * height, 0.5 * face * height
    return (
        rectangle + triangle,
        rectangle * 0.5 * crest + triangle * (crest + face / 3.0),
        rectangle * 0.5 * height + triangle * height / 3.0,
    )


@pytest.fixture(scope="module")
def short_slope():
    study = load_study(SHORT_SLOPE)
    return study, body(study)


def test_short_slope_is_the_published_scene(short_slope):
    study, shape = short_slope
    assert (shape.toe, shape.crest_edge, shape.height) == (15.0, 10.0, 5.0)
    assert (shape.length, shape.top) == (40.0, 7.5)
    position, volume = fill(shape.outline, study.discretisation.cell_m, study.discretisation.points_per_cell)
    # 20 x 40 cells below the crest of 4 points; in the triangle 190 whole cells of 4 and 20 half cells of 3.
    assert len(position) == len(volume) == 4 * (800 + 190) + 3 * 20 == 4020
    # Exact: spacings and volumes are powers of two.
    assert volume.sum() == 62.5
    spacing = 0.125
    assert set(volume.tolist()) == {spacing**2, 0.5 * spacing**2}
    assert np.count_nonzero(volume == 0.5 * spacing**2) == 40


def test_domain_is_whole_cells_with_room_to_heave():
    study = load_study(SHORT_SLOPE).with_changes({"geometry.angle_deg": 40.0, "geometry.foreland_m": 3.0})
    shape = body(study)
    toe = 10.0 + 5.0 / tan(radians(40.0))
    assert shape.toe == pytest.approx(toe, rel=IDENTITY)
    assert shape.length / 0.25 == round(shape.length / 0.25)
    assert toe + 3.0 <= shape.length < toe + 3.0 + 0.25
    assert shape.top > shape.height


def test_block_stands_upright():
    geometry = {"kind": "block", "width_m": 3.0, "height_m": 2.0, "foreland_m": 4.0}
    shape = body(load_study(SHORT_SLOPE).with_changes({"geometry": geometry}))
    assert shape.outline.tolist() == [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]
    assert (shape.toe, shape.crest_edge, shape.length) == (3.0, 3.0, 7.0)
    position, volume = fill(shape.outline, 0.25, 4)
    assert len(position) == 12 * 8 * 4
    assert set(volume.tolist()) == {0.125**2}


@settings(deadline=None, max_examples=60)
@given(
    angle=st.floats(10.0, 90.0) | st.integers(10, 90),
    per_side=st.integers(1, 4),
    cell=st.sampled_from([0.2, 0.25, 0.3, 1.0]),
    crest_cells=st.integers(1, 6),
    height_cells=st.integers(1, 6),
)
def test_area_and_first_moments_are_exact(angle, per_side, cell, crest_cells, height_cells):
    crest, height = crest_cells * cell, height_cells * cell
    outline = slope_outline(crest, height, angle)
    position, volume = fill(outline, cell, per_side**2)
    area, moment_x, moment_y = moments_of_slope(crest, height, angle)
    extent = outline.max()
    # Rounding, and what is left out: the face ends each row of squares with one triangle, which may be a sliver.
    left_out = SLIVER * (cell / per_side) ** 2 * per_side * height_cells
    rounding = 1e-10 * area
    assert -rounding <= area - volume.sum() <= left_out + rounding
    assert -rounding * extent <= moment_x - volume @ position[:, 0] <= (left_out + rounding) * extent
    assert -rounding * extent <= moment_y - volume @ position[:, 1] <= (left_out + rounding) * extent


@settings(deadline=None, max_examples=60)
@given(angle=st.floats(10.0, 90.0), per_side=st.integers(1, 4), cell=st.sampled_from([0.2, 0.25, 0.3, 1.0]))
def test_every_point_is_inside_and_no_larger_than_its_square(angle, per_side, cell):
    crest, height = 3 * cell, 5 * cell
    position, volume = fill(slope_outline(crest, height, angle), cell, per_side**2)
    face = crest + (height - position[:, 1]) / tan(radians(angle))
    # Rounding: a centroid in a sliver's corner
    inside = 1e-12 * face.max()
    assert np.all(position > 0.0)
    assert np.all(position[:, 1] < height)
    assert np.all(position[:, 0] < face + inside)
    spacing = cell / per_side
    assert np.all(volume > 0.0)
    assert np.all(volume <= spacing**2 * (1.0 + IDENTITY))
    # One point to a square.
    squares = np.floor(position / spacing + 1e-9)
    assert len(np.unique(squares, axis=0)) == len(position)


@pytest.mark.parametrize("points_per_cell", [1, 4, 9, 16])
def test_points_come_row_by_row_of_cells_from_the_base(points_per_cell):
    position, _ = fill(slope_outline(2.0, 3.0, 50.0), 0.5, points_per_cell)
    column, row = np.floor(position / 0.5 + 1e-9).T
    assert np.all(np.diff(row * 1000.0 + column) >= 0.0)


@pytest.mark.parametrize(
    ("polygon", "area", "centre"),
    [
        (UNIT_SQUARE, 1.0, (0.5, 0.5)),
        (UNIT_SQUARE + np.array((0.5, 0.25)), 0.375, (0.75, 0.625)),
        (0.5 * UNIT_SQUARE + (0.25, 0.25), 0.25, (0.5, 0.5)),  # inside: kept whole
        (4.0 * UNIT_SQUARE - (1.0, 1.0), 1.0, (0.5, 0.5)),  # around: the outline itself
        (np.array([(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)]), 1.0, (0.5, 0.5)),  # the corner (1, 1) on its edge
        (np.array([(0.5, 0.0), (1.5, 0.0), (0.5, 1.0)]), 0.375, (13.0 / 18.0, 7.0 / 18.0)),
    ],
)
def test_clip_keeps_what_is_inside(polygon, area, centre):
    kept = clip(polygon, UNIT_SQUARE)
    found_centre, found_area = centroid(kept)
    assert found_area == pytest.approx(area, rel=IDENTITY)
    assert found_centre == pytest.approx(centre, rel=IDENTITY)
    assert np.all((kept >= 0.0) & (kept <= 1.0))


@pytest.mark.parametrize("shift", [(2.0, 0.0), (0.0, -1.5), (-3.0, 3.0)])
def test_clip_leaves_nothing_of_what_is_outside(shift):
    kept = clip(UNIT_SQUARE + shift, UNIT_SQUARE)
    assert kept.shape == (0, 2)
    assert centroid(kept) == ((0.0, 0.0), 0.0)


@pytest.mark.parametrize("shift", [(1.0, 0.0), (1.0, 1.0)])
def test_what_only_touches_has_no_area(shift):
    assert centroid(clip(UNIT_SQUARE + shift, UNIT_SQUARE))[1] == 0.0


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize(
    ("polygon", "area", "centre"),
    [
        (((0, 0), (3, 0), (0, 3)), 4.5, (1.0, 1.0)),
        (((0, 0), (4, 0), (4, 2), (0, 2)), 8.0, (2.0, 1.0)),
        (((0, 0), (6, 0), (3, 3), (0, 3)), 13.5, (7.0 / 3.0, 4.0 / 3.0)),
    ],
)
def test_centroid_closed_forms(polygon, area, centre, offset):
    found, found_area = centroid(np.array(polygon, dtype=float) + offset)
    assert found_area == pytest.approx(area, rel=IDENTITY)
    assert found == pytest.approx(np.array(centre) + offset, rel=IDENTITY)
