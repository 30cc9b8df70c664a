"""Factor of safety of an undrained slope: stability numbers, one strong or weak band, and what a row says."""

from math import pi, radians, sqrt, tan
from pathlib import Path

import numpy as np
import pytest

from rfmpm.mpm.geometry import Body, fill
from rfmpm.realisation import prepare, run, simulate
from rfmpm.stability import factor_of_safety, prepare_surfaces
from rfmpm.stability.circles import Arcs, Profile, arcs, driving_moments
from rfmpm.study import StudyError, load_study

COARSE = Path(__file__).parents[2] / "robustness" / "coarse.toml"
HEIGHT, CREST, SQUARE = 5.0, 10.0, 0.25


def body(angle):
    toe = CREST + HEIGHT / tan(radians(angle))
    outline = np.array([(0.0, 0.0), (toe, 0.0), (CREST, HEIGHT), (0.0, HEIGHT)])
    return Body(outline, toe, CREST, HEIGHT, toe + 20.0, HEIGHT + 3.0)


def surfaces_of(angle):
    shape = body(angle)
    points, _ = fill(shape.outline, 2.0 * SQUARE, 4)
    return points, prepare_surfaces(shape, points, SQUARE)


@pytest.mark.parametrize(("angle", "number"), [(45, 6.12), (60, 5.24), (90, 3.83)])
def test_stability_numbers_of_taylor(angle, number):
    # Taylor (1937), Journal of the Boston Society of Civil Engineers 24: factor = number c / (unit weight height), firm
    # base at the toe. One per cent: of a chart read to three digits; a surface may leave just above the toe.
    points, surfaces = surfaces_of(angle)
    found = factor_of_safety(surfaces, np.full(len(points), 12e3), 20e3)
    assert found * 20e3 * HEIGHT / 12e3 == pytest.approx(number, rel=0.01)


def test_factor_is_proportional_to_strength_and_to_the_inverse_of_weight():
    points, surfaces = surfaces_of(45)
    strength = np.random.default_rng(3).uniform(5e3, 20e3, len(points))
    found = factor_of_safety(surfaces, strength, 20e3)
    assert factor_of_safety(surfaces, 3.0 * strength, 20e3) == pytest.approx(3.0 * found, rel=1e-12)  # identity
    assert factor_of_safety(surfaces, strength, 10e3) == pytest.approx(2.0 * found, rel=1e-12)


def test_factor_never_falls_where_strength_rises():
    points, surfaces = surfaces_of(45)
    strength = np.random.default_rng(3).uniform(5e3, 20e3, len(points))
    found = factor_of_safety(surfaces, strength, 20e3)
    for band in range(5):
        is_inside = (points[:, 1] >= band) & (points[:, 1] < band + 1.0)
        # Refinement finds the minimum to 0.5 %, so that another surface may come out lower by that.
        assert factor_of_safety(surfaces, np.where(is_inside, 2.0 * strength, strength), 20e3) > 0.995 * found


def test_refinement_finds_what_a_fine_grid_finds():
    points, surfaces = surfaces_of(45)
    rng = np.random.default_rng(8)
    from rfmpm.stability import undrained

    for _ in range(3):
        strength = 20e3 * np.exp(0.25 * rng.standard_normal(5))[np.minimum(points[:, 1].astype(int), 4)]
        shares = rng.uniform(0.0, [undrained.LAST_ENTRY, undrained.LAST_EXIT, 1.0], (20_000, 3))
        shares[:10_000, 1] = 0.0  # many leave at the toe
        fine = undrained._resisting(surfaces, arcs(surfaces.profile, shares), strength).min() / 20e3
        assert factor_of_safety(surfaces, strength, 20e3) < 1.002 * fine


def test_surfaces_stay_in_the_soil_and_meet_the_ground():
    profile = Profile(CREST, 15.0, HEIGHT)
    shares = np.random.default_rng(1).random((2000, 3)) * [0.99, 0.95, 1.0]
    given = arcs(profile, shares)
    for share in np.linspace(0.0, 1.0, 41):
        angle = given.start + share * (given.end - given.start)
        x, y = given.x + given.radius * np.sin(angle), given.y - given.radius * np.cos(angle)
        ground = np.where(x <= CREST, HEIGHT, 15.0 - x)
        assert np.all(x >= -1e-9)
        assert np.all(y >= -1e-9)
        assert np.all(y <= ground + 1e-9)
    np.testing.assert_allclose(given.x + given.radius * np.sin(given.start), shares[:, 0] * CREST, atol=1e-9)
    np.testing.assert_allclose(given.y - given.radius * np.cos(given.start), HEIGHT, atol=1e-9)
    np.testing.assert_allclose(given.y - given.radius * np.cos(given.end), shares[:, 1] * HEIGHT, atol=1e-9)
    assert np.all(given.start >= -0.5 * pi - 1e-9)


@pytest.mark.parametrize("angle", [45, 90])
def test_moments_are_those_of_a_sum_over_strips(angle):
    shape = body(angle)
    profile = Profile(shape.crest_edge, shape.toe, shape.height)
    given = arcs(profile, np.array([(0.3, 0.1, 0.7), (0.6, 0.0, 1.0), (0.8, 0.4, 0.3)]))
    x = np.linspace(0.0, shape.toe, 300_001)
    middle, width = 0.5 * (x[1:] + x[:-1]), x[1]
    face = HEIGHT * (shape.toe - middle) / max(shape.toe - CREST, 1e-9)
    ground = np.where(middle < CREST, HEIGHT, face)
    for arc, found in zip(zip(*given, strict=True), driving_moments(profile, given), strict=True):
        one = Arcs(*arc)
        first, last = (one.x + one.radius * np.sin(end) for end in (one.start, one.end))
        inside = (middle > first) & (middle < last)
        below = one.y - np.sqrt(np.maximum(one.radius**2 - (middle - one.x) ** 2, 0.0))
        expected = np.sum(np.where(inside, (one.x - middle) * (ground - below), 0.0)) * width
        assert found == pytest.approx(expected, rel=1e-3)  # of strips of 50 micrometres and their ends


def test_a_row_holds_the_factor_where_the_study_asks_for_it():
    study = load_study(COARSE)
    asked = study.with_changes({"quantities.factor_of_safety": True})
    plain, row = run(prepare(study), 1), run(prepare(asked), 1)
    assert row.keys() - plain.keys() == {"factor_of_safety"}
    assert row["run_out"] == plain["run_out"]
    assert study.with_changes({"quantities.factor_of_safety": False}).physics_hash == study.physics_hash
    assert asked.physics_hash != study.physics_hash
    prepared = prepare(asked)
    homogeneous = simulate(prepared, homogeneous=True).quantities["factor_of_safety"]
    # 8 kPa on 4 m of 20 kN/m3; the crest is as wide as the slope is high, which leaves out the widest surfaces.
    assert homogeneous == pytest.approx(6.12 * 8.0 / 80.0, rel=0.02)
    other = prepare(asked.with_changes({"material.0.strength_convention": "sqrt_3j2"}))
    lower = simulate(other, homogeneous=True).quantities["factor_of_safety"]
    assert lower == pytest.approx(homogeneous / sqrt(3.0), rel=1e-12)


def test_an_uncertain_weight_enters_the_factor():
    entry = {"key": "material.0.unit_weight_kn_m3", "distribution": "uniform", "low": 16.0, "high": 20.0}
    study = load_study(COARSE).with_changes({"quantities.factor_of_safety": True})
    prepared = prepare(study.with_changes({"uncertain": [entry]}))
    row = run(prepared, 0)
    weight = float(row["uncertain_value"][0])
    xi = np.random.default_rng(0).standard_normal(prepared.n_variables)
    xi[0] = 0.0
    at_18 = run(prepared, 0, xi=xi)["factor_of_safety"]
    assert at_18 == pytest.approx(run(prepare(study), 0, xi=xi[1:])["factor_of_safety"] * 20.0 / 18.0, rel=1e-12)
    assert 16.0 < weight < 20.0


def test_only_undrained_slopes_have_one():
    drained = {"law": "mohr_coulomb", "friction_angle_deg": 30.0, "residual_cohesion_kpa": None}
    study = load_study(COARSE).model_dump(exclude_unset=True)
    study["material"] = [{**study["material"][0], **drained}]
    study["material"][0] = {k: v for k, v in study["material"][0].items() if v is not None and "softening" not in k}
    study["quantities"] = {"factor_of_safety": True}
    with pytest.raises(StudyError, match=r'needs geometry\.kind = "slope" and a material with law = "von_mises"'):
        load_study(study)
