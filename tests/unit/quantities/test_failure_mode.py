"""The kind of failure: one state made by hand for each, and every number that parts two of them from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from rfmpm import failure_modes as limits
from rfmpm.quantities import FinalState
from rfmpm.quantities.failure_mode import MODES, Shape, failure_mode, kind_of, shape

HEIGHT = 5.0  # [m]
BAND = 0.5  # thickness of the sheared soil [m]
CELLS = (0.5, 0.25)  # [m]


def made(cell, surface, moved, height=HEIGHT):
    """State of the soil below a surface, y of x, after `moved(x, y)`: x, y and plastic strain."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0.25 * cell, 45.0, 0.5 * cell),
                                                 np.arange(0.25 * cell, 16.0, 0.5 * cell)))  # fmt: skip
    inside = y < surface(x)
    x, y = x[inside], y[inside]
    volume = np.full(len(x), 0.25 * cell**2)
    after_x, after_y, strain = moved(x, y)
    return FinalState(
        after_x, after_y, x, y, volume, volume, strain,
        cell=cell, spacing=0.5 * cell, toe=15.0, crest_edge=10.0, crest_height=height, length=80.0,
        displacement_threshold=0.5, front_quantile=0.995, block_plastic_strain=0.2, block_minimum_area=0.5,
        surface_bin=0.5,
    )  # fmt: skip


def cutting(x):
    """A slope of 45 degrees and 5 m whose toe is at 15 m."""
    return np.clip(15.0 - x, 0.0, HEIGHT)


def no_failure(cell):
    return made(cell, cutting, lambda x, y: (x + 0.4, y, np.zeros(len(x))))


def rotational(cell):
    """What lies within a circle through crest and toe turns by 15 degrees."""
    centre, radius, turn = np.array([13.53, 7.95]), 8.09, np.radians(15.0)

    def moved(x, y):
        off = x - centre[0], y - centre[1]
        distance, angle = np.hypot(*off), np.arctan2(off[1], off[0])
        slides = distance < radius
        angle = angle + turn * slides
        strain = np.where(slides & (distance > radius - BAND), 0.6, 0.0)
        return centre[0] + distance * np.cos(angle), centre[1] + distance * np.sin(angle), strain

    return made(cell, cutting, moved)


def down_a_plane(cell, thickness, end):
    """A layer slides 3 m down a plane of 15 degrees, from a scarp of 45 degrees."""
    slope = np.radians(15.0)

    def plane(x):
        return 1.0 + np.maximum(end - x, 0.0) * np.tan(slope)

    def moved(x, y):
        slides = (y > plane(x)) & (x + y > 5.0 + plane(5.0) + thickness)
        strain = np.where(slides & (y < plane(x) + 0.2 * thickness), 0.8, 0.0)
        return x + 3.0 * np.cos(slope) * slides, y - 3.0 * np.sin(slope) * slides, strain

    return made(cell, lambda x: np.where(x < end, plane(x) + thickness, 0.0), moved, height=15.7)


def translational(cell):
    return down_a_plane(cell, thickness=4.0, end=40.0)


def superficial(cell):
    return down_a_plane(cell, thickness=1.0, end=40.0)


def earthflow(cell):
    """All but the lowest half metre flows out to twice its length."""
    return made(
        cell, cutting, lambda x, y: (x * np.where(y > 0.5, 2.0, 1.0), np.where(y > 0.5, 0.5 * y, y), 2.0 * (y > 0.3))
    )


def in_blocks(cell, subsided):
    """Blocks over a level band, the further the nearer to the toe; by so much the ground between them is lower."""
    edges = np.array([0.0, 2.0, 3.5, 6.0, 7.5, 10.0, 11.5, 14.0, 15.5, 18.0])  # blocks and what is sheared between
    along = np.array([0.0, 0.0, 1.0, 1.0, 2.5, 2.5, 4.0, 4.0, 5.5, 5.5])
    down = np.array([0.0, 0.0, 0.6, 0.6, 1.2, 1.2, 1.8, 1.8, 2.4, 2.4])
    middles = 0.5 * (edges[1:-1:2] + edges[2:-1:2])

    def moved(x, y):
        between = np.any([np.abs(x - middle) < 0.75 for middle in middles], axis=0)
        hollow = np.max([(1.0 - np.abs(x - middle) / 0.75).clip(0.0) for middle in middles], axis=0)
        sinks = np.interp(x, edges, down) + subsided * hollow
        u = np.interp(x, edges, along)
        return x + u, y * (1.0 - sinks / HEIGHT), np.where((u > 0.0) & (between | (y < BAND)), 0.7, 0.0)

    return made(cell, lambda x: np.clip(20.0 - x, 0.0, HEIGHT), moved)


def retrogressive(cell):
    return in_blocks(cell, subsided=0.0)


def spread(cell):
    return in_blocks(cell, subsided=1.5)


TOYS = (no_failure, rotational, translational, superficial, earthflow, retrogressive, spread)


def name_of(state):
    return MODES[failure_mode(state)]


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("toy", TOYS)
def test_each_kind_on_cells_of_two_sizes(toy, cell):
    assert name_of(toy(cell)) == toy.__name__


def test_a_definition_has_the_numbers_that_decide():
    assert [kind for kind in limits.ORDER[1:] if not any(sign.isdigit() for sign in limits.DEFINITIONS[kind])] == []


def test_every_kind_has_a_toy_a_definition_and_a_place_in_the_order():
    assert {toy.__name__ for toy in TOYS} == set(MODES) == set(limits.DEFINITIONS) == set(limits.ORDER)


@pytest.mark.parametrize("toy", TOYS)
def test_where_the_slope_lies_has_no_say(toy):
    state = toy(0.5)
    along = ("x", "x_initial", "toe", "crest_edge", "length")
    assert name_of(replace(state, **{field: getattr(state, field) + 3.5 for field in along})) == name_of(state)


def test_measures_of_an_arc_are_those_of_the_circle():
    found = shape(rotational(0.25))
    assert found.depth / found.length == pytest.approx(1.85 / 10.3, abs=0.02)  # points resolve 0.125 m of 10 m
    assert found.straight < 0.61
    assert found.main_block == 1.0


def test_measures_of_a_layer_are_those_of_its_plane():
    found = shape(translational(0.25))
    assert found.slope == pytest.approx(15.0, abs=0.5)  # of the staircase that cells make of the plane
    assert found.together == pytest.approx(1.0)
    fall = np.tan(np.radians(15.0))
    volume = 4.0 * 35.0 - 0.5 * 4.0**2 / (1.0 - fall)  # less the corner that the scarp leaves behind
    assert found.thickness == pytest.approx(
        volume / np.hypot(35.0, 35.0 * fall + 4.0), rel=0.01
    )  # points: 0.125 of 4 m


def test_a_cell_without_points_is_no_gap_in_the_ground():
    state = retrogressive(0.5)
    kept = np.floor(state.x / state.cell) != 16
    per_point = ("x", "y", "x_initial", "y_initial", "volume", "volume_initial", "plastic_strain")
    assert not kept.all()
    assert shape(replace(state, **{name: getattr(state, name)[kept] for name in per_point})).ridges == 0


ARC = Shape(0.3, 0.7, 1, 1.0, 0.8, length=10.0, depth=2.0, thickness=2.0, straight=0.5, slope=30.0, ridges=1)
PLANE = ARC._replace(depth=0.5, straight=0.9)
RIDGED = ARC._replace(blocks=3, main_block=0.5, slope=5.0, ridges=3)


@pytest.mark.parametrize(
    ("found", "changes", "kinds"),
    [
        (ARC, {"flowed": (0.79, 0.8)}, ("rotational", "earthflow")),
        (ARC._replace(kept=0.12), {"flowed": (0.49, 0.5)}, ("rotational", "earthflow")),
        (ARC._replace(flowed=0.7), {"kept": (0.125, 0.124)}, ("rotational", "earthflow")),
        (PLANE, {"straight": (0.69, 0.7)}, ("rotational", "translational")),
        (PLANE, {"depth": (1.5, 1.49)}, ("rotational", "translational")),
        (PLANE, {"together": (0.49, 0.5)}, ("rotational", "translational")),
        (PLANE, {"thickness": (0.5, 0.49)}, ("translational", "superficial")),
        (PLANE._replace(length=20.0), {"thickness": (1.0, 0.99)}, ("translational", "superficial")),
        (ARC, {"main_block": (0.74, 0.75)}, ("retrogressive", "rotational")),
        (RIDGED, {"ridges": (2, 3)}, ("retrogressive", "spread")),
        (RIDGED, {"blocks": (2, 3)}, ("retrogressive", "spread")),
        (RIDGED, {"slope": (8.1, 8.0)}, ("retrogressive", "spread")),
    ],
)
def test_each_number_parts_two_kinds(found, changes, kinds):
    ((name, values),) = changes.items()
    assert tuple(kind_of(found._replace(**{name: value}), HEIGHT) for value in values) == kinds
