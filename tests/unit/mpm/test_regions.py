"""Points of regions of any shape: exact areas and moments, the points of a convex body, toe and crest on the ground."""

import json
from math import radians, tan
from pathlib import Path

import numpy as np
import pytest
import shapely
from ground_studies import CLAY, LOWER, ROCK, SAND, UPPER, WHOLE, region, tables
from hypothesis import given, settings
from hypothesis import strategies as st

from rfmpm.mpm.geometry import body, fill, fill_body
from rfmpm.mpm.geometry.filling import fill_polygon
from rfmpm.study import StudyError, load_study

SHORT_SLOPE = Path(__file__).parents[3] / "configs" / "short_slope.toml"
SLIVER = 1e-6  # of a full point's volume: what is smaller is left out
L_SHAPE = [(0.0, 0.0), (6.3, 0.0), (6.3, 1.7), (2.9, 1.7), (2.2, 4.1), (0.0, 3.3)]


@pytest.mark.parametrize("angle", [12.0, 33.0, 45.0, 71.3, 90.0])
@pytest.mark.parametrize("points_per_cell", [1, 4, 9])
def test_a_convex_polygon_has_the_points_of_the_convex_body(angle, points_per_cell):
    toe = 3.0 + 4.0 / tan(radians(angle))
    outline = np.array([(0.0, 0.0), (toe, 0.0), (3.0, 4.0), (0.0, 4.0)])
    expected, found = fill(outline, 0.5, points_per_cell), fill_polygon(shapely.Polygon(outline), 0.5, points_per_cell)
    np.testing.assert_allclose(found[0], expected[0], rtol=0.0, atol=1e-13 * toe)
    np.testing.assert_allclose(found[1], expected[1], rtol=0.0, atol=1e-12)


@settings(deadline=None, max_examples=60)
@given(
    angles=st.lists(st.floats(0.0, 6.28), min_size=3, max_size=9, unique=True),
    radii=st.lists(st.floats(0.4, 3.0), min_size=9, max_size=9),
    per_side=st.integers(1, 3),
)
def test_area_and_moments_of_a_star_are_exact(angles, radii, per_side):
    corners = [(4.0 + r * np.cos(a), 4.0 + r * np.sin(a)) for a, r in zip(sorted(angles), radii, strict=False)]
    polygon = shapely.Polygon(corners)
    if not polygon.is_valid:
        return
    position, volume = fill_polygon(polygon, 0.5, per_side**2)
    square = (0.5 / per_side) ** 2
    # Rounding, and slivers that are left out: no more of them than squares along the border.
    slack = 1e-12 + SLIVER * square * (4.0 * polygon.length / np.sqrt(square) + 20.0)
    assert abs(polygon.area - volume.sum()) <= slack
    for k, moment in enumerate(polygon.centroid.coords[0]):
        assert abs(polygon.area * moment - volume @ position[:, k]) <= 8.0 * slack
    assert volume.max(initial=0.0) <= square


def test_soils_of_an_area_that_is_split_fill_all_of_it():
    study = load_study(tables(region("up", UPPER), region("down", LOWER, "sand"), materials=[CLAY, SAND]))
    points, removed = fill_body(study, body(study))
    assert removed is None
    assert points.volume.sum() == pytest.approx(20.0, rel=1e-12)
    clay, sand = np.split(points.position, [points.counts[0]])
    assert clay[:, 1].min() > 2.0 > sand[:, 1].max()


def test_what_is_cut_is_filled_apart():
    study = load_study(tables(region("all", WHOLE), cut=[{"corners_m": [[4.1, -1], [9, -1], [9, 9], [4.1, 9]]}]))
    shape = body(study)
    points, removed = fill_body(study, shape)
    assert removed.volume.sum() == pytest.approx(0.5 * 2.9**2, rel=1e-9)
    assert points.volume.sum() == pytest.approx(20.0 - 0.5 * 2.9**2, rel=1e-9)
    assert (shape.crest_edge, shape.toe) == pytest.approx((3.0, 4.1), rel=1e-6)


@pytest.mark.parametrize(
    ("corners", "foreland", "crest_edge", "toe"),
    [
        (WHOLE, 6.0, 3.0, 7.0),
        ([[0, 0], [12, 0], [12, 2], [7, 2], [3, 6], [0, 6]], 0.0, 3.0, 7.0),  # on a foundation up to the wall
        ([[0, 0], [12, 0], [12, 2], [7, 2], [3, 6], [0, 6]], 6.0, 3.0, 7.0),  # on one that ends before the wall
        ([[0, 0], [9, 0], [9, 2], [7.5, 2], [3.5, 6], [0, 6]], 6.0, 3.5, 9.0),  # with a bench above an upright face
        ([[0, 0], [9, 0], [7, 2], [6, 2], [4, 4], [0, 4]], 6.0, 4.0, 9.0),  # with a bench
        ([[0, 0], [20, 0], [18, 2], [4, 6], [0, 6]], 6.0, 18.0, 20.0),  # a long slope with a steep cut at its end
        ([[0, 0], [4, 0], [4, 3], [0, 3]], 6.0, 4.0, 4.0),  # upright
    ],
)
def test_toe_and_crest_are_found_on_the_ground(corners, foreland, crest_edge, toe):
    shape = body(load_study(tables(region("all", corners), foreland_m=foreland)))
    assert (shape.crest_edge, shape.toe) == pytest.approx((crest_edge, toe), rel=1e-6)
    given = body(
        load_study(tables(region("all", corners), foreland_m=foreland, toe_m=toe - 0.5, crest_edge_m=crest_edge - 1.0))
    )
    assert (given.crest_edge, given.toe) == (crest_edge - 1.0, toe - 0.5)


def test_layers_benches_and_foundation_become_regions():
    changes = {
        "geometry.foundation_m": 2.0,
        "geometry.foundation_material": "rock",
        "geometry.layer": [{"material": "sand", "thickness_m": 1.5}],
        "geometry.bench": [{"height_m": 2.0, "width_m": 1.0}],
        "material": [CLAY, SAND, ROCK],
    }
    study = load_study(SHORT_SLOPE).with_changes(changes)
    shape = body(study)
    points, _ = fill_body(study, shape)
    assert (shape.toe, shape.crest_edge, shape.height) == pytest.approx((16.0, 10.0, 7.0), rel=1e-6)
    clay, sand, rock = (part.sum() for part in np.split(points.volume, np.cumsum(points.counts)[:-1]))
    assert rock == pytest.approx(2.0 * shape.length, rel=1e-12)
    assert sand == pytest.approx(10.0 * 1.5 + 0.5 * 1.5**2, rel=1e-12)
    assert clay + sand == pytest.approx(62.5 + 2.0, rel=1e-9)


def problems_of(*args, **more):
    with pytest.raises(StudyError) as refusal:
        load_study(tables(*args, **more))
    return refusal.value.problems


@pytest.mark.parametrize(
    ("regions", "parts"),
    [
        ([region("a", WHOLE), region("b", LOWER)], ['"b" overlaps region "a"', "(12 m2)"]),
        ([region("a", [[0, 0], [7, 0], [3, 4], [5, 4]])], ['"a" crosses or touches itself at x = ']),
        ([region("a", [[-2, 0], [7, 0], [3, 4], [0, 4]])], ['"a" lies outside the domain around x = -']),
        ([region("a", UPPER)], ['"a" does not rest on the base']),
        ([region("a", LOWER), region("b", [[0, 2.2], [5, 2.2], [3, 4], [0, 4]])], ["leaves a gap", '"b"', "m2)"]),
        ([region("a", LOWER), region("b", [[0, 2], [5, 2], [5, 2.2], [0, 2.2]])], ['"b" is thinner than a cell']),
        (
            [region("a", [[0, 0], [9, 0], [9, 1], [0, 1]]), region("b", [[0, 1], [3, 1], [3, 3], [6, 3], [6, 1], [9, 1],
             [9, 4], [0, 4]])],
            ["leaves a hole", "(6 m2)"],
        ),
        ([region("a", WHOLE), region("b", [[20, 3], [22, 3], [22, 5], [20, 5]])], ['"b" does not rest on the base']),
    ],
    ids=["overlap", "crossing", "outside", "floating", "gap", "thin", "hole", "island"],
)  # fmt: skip
def test_what_is_wrong_is_named_with_its_place_and_area(regions, parts):
    (*_, problem) = [one for one in problems_of(*regions) if "geometry.region" in one and parts[0] in one]
    assert all(part in problem for part in parts)


def test_everything_is_said_at_once():
    found = problems_of(
        region("a", UPPER), region("a", [[0, 0], [1, 0]]), region("c", LOWER, "gravel"), materials=[CLAY, SAND]
    )
    assert any("is the name of another region too" in one for one in found)
    assert any("has 2 corners" in one for one in found)
    assert any("names no material" in one for one in found)
    assert any("is the material of no soil" in one for one in found)


@pytest.mark.parametrize("kind", ["geojson", "csv", "dxf"])
def test_a_region_is_read_from_a_file(kind, tmp_path):
    path = tmp_path / f"soil.{kind}"
    if kind == "geojson":
        features = [
            {"type": "Feature", "properties": {"name": name}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
            for name, ring in (("other", [*LOWER, LOWER[0]]), ("all", [*WHOLE, WHOLE[0]]))
        ]
        path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    elif kind == "csv":
        path.write_text("x_m,y_m\n" + "\n".join(f"{x},{y}" for x, y in WHOLE))
    else:
        drawing = pytest.importorskip("ezdxf").new()
        drawing.modelspace().add_lwpolyline(WHOLE, close=True, dxfattribs={"layer": "all"})
        drawing.saveas(path)
    study = load_study(tables({"name": "all", "material": "clay", "file": str(path)}))
    assert study.geometry.region[0].corners_m == tuple(tuple(map(float, corner)) for corner in WHOLE)
    assert study.geometry.region[0].file is None
    path.write_text("nothing")
    with pytest.raises(StudyError, match=r"geometry\.region\.0\.file"):
        load_study(tables({"name": "all", "material": "clay", "file": str(path)}))
