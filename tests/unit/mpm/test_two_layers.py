"""Several materials in one scene: a column of two layers carries its weight; equal soils move as one."""

import numpy as np
import pytest
from ground_studies import CLAY, LOWER, ROCK, SAND, UPPER, WHOLE, region, tables

import rfmpm
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import RUNNING, start
from rfmpm.study import load_study

IDENTITY = 1e-8  # of the shift of the static solve, see test_initial_stress
LIGHT = {**ROCK, "name": "light", "unit_weight_kn_m3": 15.0, "youngs_modulus_kpa": 1000.0, "poissons_ratio": 0.3}
TWO = region("up", UPPER), region("down", LOWER, "clay2")


def column():
    layers = (
        region("up", [[0, 2], [2, 2], [2, 4], [0, 4]], "light"),
        region("down", [[0, 0], [2, 0], [2, 2], [0, 2]], "rock"),
    )
    study = load_study(tables(*layers, materials=[LIGHT, ROCK], foreland_m=0.0))
    choices = {"discretisation.shape": "linear", "discretisation.volumetric_strain": "point"}
    return scenes.build(study.with_changes(choices | {"boundary.base": {"kind": "roller"}}))


def test_column_of_two_layers_carries_the_weight_above():
    points = column().points
    centre = (np.floor(points.position.y / 0.5) + 0.5) * 0.5  # a linear cell has the stress of its centre
    exact = -np.where(centre > 2.0, 15e3 * (4.0 - centre), 15e3 * 2.0 + 24e3 * (2.0 - centre))
    tolerance = IDENTITY * 78e3
    np.testing.assert_allclose(points.stress.yy, exact, rtol=0.0, atol=tolerance)
    sideways = np.where(points.position.y > 2.0, 0.3 / 0.7, 0.0) * exact
    np.testing.assert_allclose(points.stress.xx, sideways, rtol=0.0, atol=tolerance)


@pytest.mark.slow
def test_it_stays_at_rest():
    scene = column()
    now = SOLVERS["explicit"](start(), 0.5, *scenes.arguments(scene, scenes.release(scene, None)))
    assert now.status == RUNNING
    assert now.peak_kinetic < IDENTITY**2 * scene.controls.energy_scale


@pytest.mark.slow
def test_one_soil_in_two_regions_is_one_soil_bit_for_bit():
    one, two = (load_study(tables(*parts)) for parts in ([region("all", WHOLE)], (TWO[0], region("low", LOWER))))
    first, second = rfmpm.simulate(one).points, rfmpm.simulate(two).points
    assert all(np.array_equal(first[name], second[name]) for name in first)
    assert first["plastic_strain"].max() > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2])
def test_two_soils_of_equal_numbers_move_as_one(threads):
    one = rfmpm.simulate(load_study(tables(region("all", WHOLE)))).points
    two = rfmpm.simulate(load_study(tables(*TWO, materials=[CLAY, {**CLAY, "name": "clay2"}])), threads=threads).points
    order = [np.lexsort((points["x_initial"], points["y_initial"])) for points in (one, two)]
    # The order of the sums differs: rounding, which grows a little from step to step.
    for name in ("x", "y", "plastic_strain", "stress_yy", "volume"):
        scale = np.abs(one[name]).max()
        np.testing.assert_allclose(two[name][order[1]], one[name][order[0]], rtol=0.0, atol=1e-9 * scale)


@pytest.mark.slow
def test_laws_and_fields_are_each_soil_s_own():
    field = {
        "material": "sand",
        "distribution": "lognormal",
        "coefficient_of_variation": 0.3,
        "correlation": "markov_separable",
        "scale_of_fluctuation_h_m": 3.0,
        "scale_of_fluctuation_v_m": 1.0,
    }
    study = load_study(
        tables(region("up", UPPER), region("down", LOWER, "sand"), materials=[CLAY, SAND])
        | {"random_field": {"cohesion": field}}
    )
    outcome = rfmpm.simulate(study)
    counts = scenes.build(study).soils.counts
    clay, sand = np.split(outcome.points["cohesion"], [counts[0]])
    assert set(clay) == {8e3}
    assert len(np.unique(sand)) == counts[1]
    assert abs(outcome.quantities["energy_balance_error"]) < 0.01
    assert outcome.points["plastic_strain"][: counts[0]].max() > 0.1


def test_one_softening_length_serves_a_scene():
    with pytest.raises(rfmpm.StudyError, match=r"material\.1\.softening_length_m = 1\.0: must be that of"):
        load_study(tables(*TWO, materials=[CLAY, {**CLAY, "name": "clay2", "softening_length_m": 1.0}]))
