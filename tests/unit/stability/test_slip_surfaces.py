"""Slip surfaces: where they may run, what lies above them, and what their factors must satisfy."""

from math import pi, radians, tan

import numpy as np
import pytest

from rfmpm.stability import Section, critical_surface, factor_along, ground_of, sides_of
from rfmpm.stability.arcs import Line, arc, draw, place_on_ground
from rfmpm.stability.equilibrium import LARGEST_PULL, bishop, pull
from rfmpm.stability.polygons import fill_in, turns_gently
from rfmpm.stability.section import soil_of
from rfmpm.stability.slices import cut, make_slices

HEIGHT, CREST, SQUARE = 5.0, 10.0, 0.25
WEIGHT = 20e3


def slope(angle=45.0, foundation=0.0, square=SQUARE):
    toe = CREST + HEIGHT / tan(radians(angle))
    ground = [(0.0, HEIGHT), (CREST, HEIGHT), (toe, 0.0)]
    if foundation:
        ground.append((toe + 10.0, 0.0))
    x, y = np.meshgrid(
        np.arange(0.5 * square, ground[-1][0], square), np.arange(0.5 * square - foundation, HEIGHT, square)
    )
    return Section(np.array(ground), -foundation, np.column_stack([x.ravel(), y.ravel()]), square)


def uniform(section, cohesion=12e3, friction=0.0, weight=WEIGHT):
    return tuple(np.full(len(section.points), value) for value in (cohesion, radians(friction), weight))


def layered(section, seed=3):
    cohesion = np.random.default_rng(seed).uniform(5e3, 20e3, len(section.points))
    return (cohesion, *uniform(section)[1:])


@pytest.mark.parametrize("foundation", [0.0, 4.0])
def test_arcs_stay_in_the_soil_and_meet_the_ground(foundation):
    (side,) = sides_of(slope(foundation=foundation))
    ground, line, drawn = side.ground, Line(np.empty(41), np.empty(41)), 0
    for share in np.random.default_rng(1).random((2000, 3)):
        entry, leaving = sorted(share[:2] * ground.along[-1])
        if not draw(ground, arc(ground, entry, leaving, share[2]), 40, line):
            continue
        drawn += 1
        assert np.all(line.y >= -foundation - 1e-9)
        assert np.all(line.y <= np.interp(line.x, ground.x, ground.y) + 1e-9)
        assert (line.x[0], line.y[0]) == pytest.approx(place_on_ground(ground, entry), abs=1e-9)
        assert (line.x[-1], line.y[-1]) == pytest.approx(place_on_ground(ground, leaving), abs=1e-9)
        assert np.all(np.diff(line.x) > 0.0)
    assert drawn > 500


@pytest.mark.parametrize("angle", [45.0, 90.0])
def test_slices_weigh_what_lies_above_the_surface(angle):
    section = slope(angle)
    (side,) = sides_of(section)
    cohesion, friction, weight = uniform(section)
    weight = np.where(section.points[:, 1] > 3.0, 18e3, 21e3)
    line, slices = Line(np.empty(201), np.empty(201)), make_slices(200)
    assert draw(side.ground, arc(side.ground, 4.0, side.ground.along[-1], 0.5), 200, line)
    cut(side.ground, soil_of(side, cohesion, friction, weight), line.x, line.y, 200, slices)
    x = np.linspace(line.x[0], line.x[-1], 20_001)
    x = 0.5 * (x[1:] + x[:-1])
    top, bottom = np.interp(x, side.ground.x, side.ground.y), np.interp(x, line.x, line.y)
    strips = 18e3 * np.maximum(top - np.maximum(bottom, 3.0), 0.0) + 21e3 * np.maximum(
        np.minimum(top, 3.0) - bottom, 0.0
    )
    # The top of a slice is level here, where the ground is not: the slices that the border of 3 m cuts, by its half.
    assert slices.weight.sum() == pytest.approx(strips.mean() * (line.x[-1] - line.x[0]), rel=1e-3)
    assert slices.cohesion.sum() == pytest.approx(12e3 * np.hypot(np.diff(line.x), np.diff(line.y)).sum(), rel=1e-12)


@pytest.mark.parametrize("method", ["bishop", "spencer", "morgenstern_price"])
def test_factor_is_proportional_to_strength_and_to_the_inverse_of_weight(method):
    section = slope(30.0)
    cohesion, friction, weight = uniform(section, 5e3, 25.0)
    sides = sides_of(section)
    found = critical_surface(sides, cohesion, friction, weight, method)
    stronger = critical_surface(sides, 2.0 * cohesion, np.arctan(2.0 * np.tan(friction)), weight, method)
    lighter = critical_surface(sides, 0.5 * cohesion, friction, 0.5 * weight, method)
    assert lighter.factor == pytest.approx(found.factor, rel=1e-9)  # rounding of the iteration's last step
    assert stronger.factor == pytest.approx(2.0 * found.factor, rel=1e-4)  # F of 2 c, 2 tan phi starts elsewhere


@pytest.mark.parametrize("method", ["bishop", "spencer", "morgenstern_price"])
def test_a_mirrored_slope_has_the_same_factor_and_the_mirrored_surface(method):
    section = slope(30.0)
    ground = section.ground[::-1] * [-1.0, 1.0]
    mirrored = section._replace(ground=ground, points=section.points * [-1.0, 1.0])
    here = critical_surface(sides_of(section), *uniform(section, 5e3, 25.0), method)
    there = critical_surface(sides_of(mirrored), *uniform(section, 5e3, 25.0), method)
    assert there.factor == pytest.approx(here.factor, rel=1e-12)  # identity
    np.testing.assert_allclose(there.surface * [-1.0, 1.0], here.surface, atol=1e-9)


def test_of_two_faces_the_steeper_one_slides():
    ground = np.array([(0.0, 0.0), (4.0, 0.0), (9.0, 5.0), (14.0, 5.0), (24.0, 0.0), (28.0, 0.0)])
    x, y = np.meshgrid(np.arange(0.125, 28.0, 0.25), np.arange(-3.875, 5.0, 0.25))
    section = Section(ground, -4.0, np.column_stack([x.ravel(), y.ravel()]), 0.25)
    found = critical_surface(sides_of(section), *uniform(section, 8e3, 20.0))
    assert found.surface[-1, 0] < found.surface[0, 0] <= 14.0  # to the left


def test_circles_without_friction_have_one_factor_by_all_methods():
    # Moments about the centre of a circle know no forces between slices where the strength knows no normal force.
    # On arcs that enter steeply the others have no solution: cohesion pulls there, and no ratio of shear balances it.
    section = slope(30.0, foundation=5.0)
    (side,) = sides_of(section)
    strength, line = layered(section), Line(np.empty(97), np.empty(97))
    assert draw(side.ground, arc(side.ground, 5.0, side.ground.along[-1] - 8.0, 0.3), 96, line)
    surface = np.column_stack(line)
    bishop, *others = (factor_along(side, *strength, surface, m) for m in ("bishop", "spencer", "morgenstern_price"))
    assert others == pytest.approx([bishop, bishop], rel=1e-5)  # what ends the iteration: 1e-6 of the factor


def test_factor_never_falls_where_strength_rises():
    section = slope()
    sides, strength = sides_of(section), layered(section)
    found = critical_surface(sides, *strength).factor
    for band in range(5):
        is_inside = (section.points[:, 1] >= band) & (section.points[:, 1] < band + 1.0)
        stronger = np.where(is_inside, 2.0 * strength[0], strength[0])
        # The search finds the least factor to 0.5 %, so that another surface may come out lower by that.
        assert critical_surface(sides, stronger, *strength[1:]).factor > 0.995 * found


@pytest.mark.parametrize("method", ["bishop", "spencer", "morgenstern_price"])
def test_no_circle_of_many_drawn_by_chance_is_better(method):
    section = slope(40.0)
    (side,) = sides_of(section)
    cohesion, _, weight = layered(section)
    strength = (cohesion, np.full_like(cohesion, radians(15.0)), weight)
    found = critical_surface((side,), *strength, method, circles_only=True).factor
    rng, line = np.random.default_rng(8), Line(np.empty(97), np.empty(97))
    least = np.inf
    for share in rng.random((4000, 3)):
        entry, leaving = 6.0 + 4.0 * share[0], side.ground.along[-1] * (1.0 - 0.2 * share[1] ** 2)
        if draw(side.ground, arc(side.ground, entry, leaving, share[2]), 96, line):
            surface = np.column_stack(line)
            least = min(least, factor_along(side, *strength, surface, method))
    assert found < 1.005 * least  # the search finds the least factor to 0.5 %


def test_a_weak_seam_draws_the_surface_into_it():
    section = slope(30.0, foundation=2.0)
    y = section.points[:, 1]
    cohesion, friction, weight = uniform(section, 10e3, 25.0)
    seam = (y > -1.0) & (y < -0.75)
    strength = (np.where(seam, 0.0, cohesion), np.where(seam, radians(8.0), friction), weight)
    found = critical_surface(sides_of(section), *strength, "spencer")
    circle = critical_surface(sides_of(section), *strength, "spencer", circles_only=True)
    assert found.kind == "polygon"
    assert found.factor < 0.9 * circle.factor
    inside = (found.surface[:, 1] > -1.0) & (found.surface[:, 1] < -0.75)
    assert np.ptp(found.surface[inside, 0]) > HEIGHT


def test_surfaces_of_any_shape_do_not_steepen_on_their_way_down():
    section = slope(30.0, foundation=2.0)
    for seed in range(3):
        cohesion, friction, weight = layered(section, seed)
        found = critical_surface(sides_of(section), cohesion, friction + 0.3, weight, "spencer")
        slopes = np.diff(found.surface[:, 1]) / np.diff(found.surface[:, 0])
        assert np.all(np.diff(slopes) > -1e-6)


def test_a_surface_turns_sharply_only_where_the_strength_along_it_changes():
    section = slope(45.0, foundation=2.0)
    (side,) = sides_of(section)
    corners = Line(np.array([8.0, 10.0, 12.0, 14.0, 16.0]), np.array([5.0, 1.0, 0.0, -0.5, -0.6]))
    is_weak = section.points[:, 0] > 10.0
    for weak, is_taken in ((12e3, False), (6e3, True)):
        cohesion = np.where(is_weak, weak, 12e3)
        soil, line, slices = soil_of(side, cohesion, *uniform(section)[1:]), Line(*np.empty((2, 200))), make_slices(200)
        pieces = fill_in(corners, 5, 96, line)
        cut(side.ground, soil, line.x, line.y, pieces, slices)
        assert turns_gently(corners, 5, 96, slices) is is_taken


def test_no_circle_is_taken_on_which_pull_takes_much_of_the_friction():
    slices = make_slices(2)
    for i, values in enumerate(((1.0, 0.99, 0.14, 5e3, 60e3, 0.2), (4.0, 0.3, 0.95, 200e3, 60e3, 0.2))):
        for name, value in zip(("width", "sine", "cosine", "weight", "cohesion", "friction"), values, strict=True):
            getattr(slices, name)[i] = value
    slices.limit[:], slices.lever[:] = np.inf, 1.0
    normal = (5e3 - 60e3 * 0.99) / (0.14 + 0.99 * 0.2), (200e3 - 60e3 * 0.3) / (0.95 + 0.3 * 0.2)
    expected = -0.2 * normal[0] / (120e3 + 0.2 * sum(normal))
    assert pull(slices, 2, 1.0) == pytest.approx(expected, rel=1e-12)  # identity
    assert expected > LARGEST_PULL
    assert bishop(slices, 2) == np.inf
    slices.friction[:] = 0.0
    assert bishop(slices, 2) == pytest.approx(120e3 / (5e3 * 0.99 + 200e3 * 0.3), rel=1e-6)  # what ends the iteration


def test_arcs_are_cut_off_at_a_base_with_friction_and_run_along_it():
    (side,) = sides_of(slope(foundation=4.0)._replace(base_friction=0.3))
    ground, line, drawn = side.ground, Line(np.empty(41), np.empty(41)), 0
    for share in np.random.default_rng(1).random((1000, 3)):
        entry, leaving = sorted(share[:2] * ground.along[-1])
        found = arc(ground, entry, leaving, 1.01 + 0.98 * share[2])
        if not draw(ground, found, 40, line):
            continue
        x, y, radius, *_ = found
        if y - radius > ground.base - 1e-6:
            continue
        drawn += 1
        on_base = np.abs(line.y - ground.base) < 1e-9
        assert on_base.sum() >= 2
        assert np.all(np.diff(np.flatnonzero(on_base)) == 1)
        assert np.all(np.diff(line.x) > 0.0)
        np.testing.assert_allclose(np.hypot(line.x - x, line.y - y)[~on_base], radius, rtol=1e-9)
        assert (line.x[0], line.y[0]) == pytest.approx(place_on_ground(ground, entry), abs=1e-9)
        assert (line.x[-1], line.y[-1]) == pytest.approx(place_on_ground(ground, leaving), abs=1e-9)
    assert drawn > 50


def test_the_friction_of_the_base_is_not_divided_by_the_factor():
    slices = make_slices(2)
    for i, values in enumerate(((0.6, 0.8, 200e3, 60e3, np.inf, 1.0), (0.0, 1.0, 100e3, 60e3, 0.3, 0.7))):
        for name, value in zip(("sine", "cosine", "weight", "cohesion", "limit", "lever"), values, strict=True):
            getattr(slices, name)[i] = value
    slices.friction[:] = 0.0
    # F = (cohesion + F 0.3 W lever) / driving: 0.3 times 100 kN/m are less than the 60 kN/m of the soil.
    assert bishop(slices, 2) == pytest.approx(60e3 / (200e3 * 0.6 - 0.3 * 100e3 * 0.7), rel=2e-6)  # end of iteration
    slices.limit[1] = 3.0  # the soil is weaker
    assert bishop(slices, 2) == pytest.approx((60e3 + 60e3 * 0.7) / (200e3 * 0.6), rel=2e-6)


@pytest.mark.parametrize("method", ["bishop", "spencer", "morgenstern_price"])
def test_a_slope_is_the_safer_the_rougher_its_base(method):
    section = slope()
    soil = uniform(section, 12e3, 0.0 if method == "bishop" else 20.0)
    factors = [
        critical_surface(sides_of(section._replace(base_friction=friction)), *soil, method).factor
        for friction in (0.1, 0.3, 0.6, np.inf)
    ]
    assert factors == sorted(factors)
    assert factors[1] < 0.97 * factors[-1]


def test_arcs_that_descend_to_the_toe_are_not_cut_off():
    # They meet the base in one point, at which nothing slides along it: a steep face is as safe on any base.
    section, strength = slope(90.0), (10e3, 30.0)
    rough, smooth = (
        critical_surface(sides_of(section._replace(base_friction=friction)), *uniform(section, *strength)).factor
        for friction in (np.inf, 0.3)
    )
    assert smooth == pytest.approx(rough, rel=0.005)  # to which the search finds the least factor


def test_a_tension_crack_takes_the_surface_s_upper_end():
    section = slope(45.0)
    whole = critical_surface(sides_of(section), *uniform(section))
    cracked = critical_surface(sides_of(section._replace(crack=1.0)), *uniform(section))
    assert cracked.surface[0, 1] == pytest.approx(HEIGHT - 1.0, abs=1e-6)  # 40 bisections of an arc
    assert cracked.factor < whole.factor


@pytest.mark.parametrize(
    ("ground", "words"),
    [
        ([(0.0, 5.0), (10.0, 5.0), (9.0, 0.0)], "runs back"),
        ([(0.0, 5.0), (10.0, 5.0), (15.0, -1.0)], "below the firm base"),
        ([(0.0, 5.0), (10.0, 5.0)], "level"),
    ],
)
def test_grounds_that_are_none(ground, words):
    with pytest.raises(ValueError, match=words):
        sides_of(slope()._replace(ground=np.array(ground)))


@pytest.mark.parametrize(
    ("outline", "ground"),
    [
        ([(0, 0), (15, 0), (10, 5), (0, 5)], [(0, 5), (10, 5), (15, 0)]),
        ([(0, 0), (10, 0), (10, 5), (0, 5)], [(0, 5), (10, 5), (10, 0)]),  # a block: its right side is free
        ([(2, 0), (10, 0), (10, 5), (2, 5)], [(2, 0), (2, 5), (10, 5), (10, 0)]),  # and its left one
        ([(0, -3), (40, -3), (40, 0), (15, 0), (10, 5), (0, 5)], [(0, 5), (10, 5), (15, 0), (40, 0)]),
        ([(15, 0), (10, 5), (0, 5), (0, 0)], [(0, 5), (10, 5), (15, 0)]),  # from whatever corner
    ],
)
def test_the_ground_of_a_body(outline, ground):
    found = ground_of(np.array(outline, dtype=float), length=40.0)
    np.testing.assert_array_equal(found, np.array(ground, dtype=float))


def test_arcs_do_not_overhang():
    (side,) = sides_of(slope(foundation=5.0))
    for share in np.random.default_rng(2).random((500, 3)):
        entry, leaving = sorted(share[:2] * side.ground.along[-1])
        *_, radius, start, _ = arc(side.ground, entry, leaving, share[2])
        assert radius == 0.0 or start >= -0.5 * pi - 1e-9


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_load_on_the_ground_drives_what_lies_below_it(is_mirrored):
    section = slope(30.0)._replace(load=np.array([(2.0, 3.0, 20e3), (0.5, 2.0, 10e3)]))
    side = sides_of(section)[0]
    line = Line(np.empty(201), np.empty(201))
    assert draw(side.ground, arc(side.ground, 1.0, side.ground.along[-1], 0.5), 200, line)
    surface = np.column_stack(line)
    if is_mirrored:
        load = section.load * [-1.0, -1.0, 1.0]
        section = section._replace(
            ground=section.ground[::-1] * [-1.0, 1.0], points=section.points * [-1.0, 1.0], load=load
        )
        side = sides_of(section)[0]
    strength = uniform(section, 5e3, 0.0)
    without = sides_of(section._replace(load=np.empty((0, 3))))[0]
    loaded, free = (factor_along(one, *strength, surface, "bishop") for one in (side, without))
    x, y = surface.T
    length = np.hypot(np.diff(x), np.diff(y))
    under = [np.maximum(np.minimum(x[1:], end) - np.maximum(x[:-1], start), 0.0) for start, end in ((0.5, 2), (2, 3))]
    driving = np.sum((10e3 * under[0] + 20e3 * under[1]) * -np.diff(y) / length)
    # Without friction the factor is cohesion times length over the sum of W sin(alpha), to which the load adds its own.
    assert 1.0 / loaded - 1.0 / free == pytest.approx(driving / (5e3 * length.sum()), rel=1e-9)
