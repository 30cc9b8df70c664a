"""Ground that starts at rest stays there: K0, gravity raised slowly, and what is said of a state out of balance."""

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.equilibrium import raise_gravity
from rfmpm.study import StudyError

WEIGHT, HEIGHT, STIFFNESS = 20e3, 3.0, 1e7  # [N/m3], [m], [Pa]
SINKING = WEIGHT * HEIGHT**2 / STIFFNESS  # scale of elastic settlement [m]
GROUND = {"kind": "block", "width_m": 4.0, "height_m": HEIGHT, "foreland_m": 0.0}
SLOPE = {"kind": "slope", "height_m": HEIGHT, "crest_m": 6.0, "angle_deg": 45.0, "foreland_m": 6.0}
CRITICAL = 3.71  # cohesion with which the slope just stands at 20 degrees: Chen (1975), 60 / 16.16 [kPa]


def ground(geometry, start, cohesion=0.0, friction=30.0, cell=0.25, **changes):
    soil = {"law": "mohr_coulomb", "cohesion_kpa": cohesion, "friction_angle_deg": friction}
    study = rfmpm.load_study(
        {
            "study": {"name": "ground", "seed": 1},
            "geometry": geometry,
            "discretisation": {"cell_m": cell, "points_per_cell": 4, "shape": "quadratic_bspline"},
            "boundary": {"base": {"kind": "fixed"}, "sides": {"kind": "roller"}},
            "material": [
                soil
                | {
                    "name": "soil",
                    "unit_weight_kn_m3": WEIGHT / 1e3,
                    "youngs_modulus_kpa": STIFFNESS / 1e3,
                    "poissons_ratio": 0.33,
                }
            ],
            "time": {"end_s": 2.0, "initial_stress": start},
            "output": {"directory": "results"},
        }
    )
    return study.with_changes({key.replace("__", "."): value for key, value in changes.items()})


def moved(study):
    points = rfmpm.simulate(study).points
    return np.hypot(points["displacement_x"], points["displacement_y"]).max()


@pytest.mark.parametrize(
    ("friction", "given", "expected"), [(30.0, None, 0.5), (0.0, None, 0.33 / 0.67), (30.0, 0.8, 0.8)]
)
def test_k0_stress_is_weight_above_and_a_share_of_it(friction, given, expected):
    study = ground(GROUND, "k0", cohesion=5.0, friction=friction, time__k0=given)
    points = scenes.build(study).points
    vertical = -WEIGHT * (HEIGHT - points.position.y)
    np.testing.assert_allclose(points.stress.yy, vertical, rtol=1e-12)
    np.testing.assert_allclose(points.stress.xx, expected * vertical, rtol=1e-12)
    np.testing.assert_allclose(points.stress.zz, expected * vertical, rtol=1e-12)
    assert not points.stress.xy.any()


def test_k0_follows_the_ground_surface():
    points = scenes.build(ground(SLOPE, "k0")).points
    surface = np.minimum(HEIGHT, 9.0 - points.position.x)
    np.testing.assert_allclose(points.stress.yy, -WEIGHT * (surface - points.position.y), rtol=0.0, atol=1e-12 * WEIGHT)


def layered(start, **more):
    upper = {"name": "upper", "material": "soil", "corners_m": [[0, 2], [4, 2], [4, 3], [0, 3]]}
    lower = {"name": "lower", "material": "rock", "corners_m": [[0, 0], [4, 0], [4, 2], [0, 2]]}
    rock = {
        "name": "rock",
        "law": "elastic",
        "unit_weight_kn_m3": 25.0,
        "youngs_modulus_kpa": 1e5,
        "poissons_ratio": 0.2,
    }
    geometry = {"kind": "regions", "foreland_m": 0.0, "region": [upper, lower]} | more
    level = ground(GROUND, start)
    return level.with_changes({"geometry": geometry, "material": [level.material[0], rock]})


def test_k0_of_two_layers_is_that_of_each_under_the_weight_of_both():
    scene = scenes.build(layered("k0"))
    y = scene.points.position.y
    upper = y > 2.0
    weight = np.where(upper, 20e3 * (3.0 - y), 20e3 + 25e3 * (2.0 - y))
    np.testing.assert_allclose(scene.points.stress.yy, -weight, rtol=1e-12)
    np.testing.assert_allclose(scene.points.stress.xx, -np.where(upper, 0.5, 0.25) * weight, rtol=1e-12)


def test_k0_knows_of_soil_that_is_cut_away():
    cut = {"cut": [{"corners_m": [[3, 2.5], [4, 2.5], [4, 3], [3, 3]]}]}
    scene = scenes.build(layered("k0", **cut))
    x, y = scene.points.position
    below = (x > 3.0) & (y > 2.0)
    np.testing.assert_allclose(scene.points.stress.yy[below], -20e3 * (3.0 - y[below]), rtol=1e-12)
    assert rfmpm.simulate(layered("k0", **cut)).quantities["out_of_balance"] > 0.05
    with pytest.raises(StudyError, match="then cut"):
        layered("gravity_ramp", **cut)


@pytest.mark.parametrize("start", ["elastic", "k0", "gravity_ramp"])
def test_level_ground_without_cohesion_stays_where_it_is(start):
    # What is out of balance lies in the uppermost row of cells: its weight alone settles by (h / H)^2 of the scale.
    assert moved(ground(GROUND, start)) < (0.25 / HEIGHT) ** 2 * SINKING


def test_level_ground_under_k0_settles_with_the_square_of_the_cell():
    coarse, fine = (moved(ground(GROUND, "k0", cell=cell)) for cell in (0.5, 0.25))
    assert np.log2(coarse / fine) > 1.7


def test_a_slope_that_stands_moves_less_after_a_ramp_than_after_elastic_stresses():
    elastic, ramp = (
        moved(ground(SLOPE, start, cohesion=1.2 * CRITICAL, friction=20.0)) for start in ("elastic", "gravity_ramp")
    )
    assert ramp < 0.1 * elastic
    assert ramp < 1e-3 * SINKING


def test_a_ramp_leaves_no_trace_but_stress():
    scene = scenes.build(ground(SLOPE, "gravity_ramp", cohesion=1.2 * CRITICAL, friction=20.0))
    own = scenes.release(scene, None)
    assert raise_gravity(scene, own).stands
    for component, first in zip(own.points.position, scene.points.position, strict=True):
        np.testing.assert_array_equal(component, first)
    np.testing.assert_array_equal(own.points.volume, scene.points.volume)
    assert not any(values.any() for values in (*own.points.velocity, *own.history))
    assert own.points.stress.yy.min() < -0.8 * WEIGHT * HEIGHT


@pytest.mark.parametrize("means", ["point", "cell_mean"])
def test_a_ramp_of_elastic_soil_ends_in_the_elastic_stresses(means):
    """To ten times what it leaves out of balance, 1e-4 of gravity's forces."""
    elastic = {
        "name": "soil", "law": "elastic", "unit_weight_kn_m3": 20.0, "youngs_modulus_kpa": 1e4, "poissons_ratio": 0.33
    }  # fmt: skip
    studies = (
        ground(SLOPE, start, material__0=elastic, discretisation__volumetric_strain=means)
        for start in ("elastic", "gravity_ramp")
    )
    solved, raised = (scenes.build(study) for study in studies)
    own = scenes.release(raised, None)
    raise_gravity(raised, own)
    expected = np.array(solved.points.stress)
    assert np.linalg.norm(np.array(own.points.stress) - expected) < 1e-3 * np.linalg.norm(expected)


@pytest.mark.parametrize(
    ("start", "cohesion", "said"),
    [("k0", 5.0, "level ground"), ("gravity_ramp", 0.8 * CRITICAL, "does not stand")],
)
def test_a_start_far_from_balance_is_refused_in_words(start, cohesion, said):
    study = ground(SLOPE, start, cohesion=cohesion, friction=20.0)
    for ask in (rfmpm.simulate, lambda study: realisation.initial_balance(realisation.prepare(study))):
        with pytest.raises(StudyError, match=f"time.initial_stress = .{start}.*at most.*{said}"):
            ask(study)


def test_a_slope_of_random_strength_that_does_not_stand_is_no_fault_of_the_study():
    field = {
        "material": "soil", "distribution": "lognormal", "coefficient_of_variation": 0.1,
        "correlation": "markov_separable", "scale_of_fluctuation_h_m": 6.0, "scale_of_fluctuation_v_m": 1.0,
    }  # fmt: skip
    study = ground(SLOPE, "gravity_ramp", cohesion=0.7 * CRITICAL, friction=20.0, random_field={"cohesion": field})
    row = realisation.run(realisation.prepare(study), 0)
    assert row["status"] in (0, 1)
    assert row["out_of_balance"] > 5e-3
    assert row["run_out"] > 0.0


def test_elastic_stresses_say_nothing_of_balance():
    assert "out_of_balance" not in rfmpm.simulate(ground(GROUND, "elastic")).quantities
