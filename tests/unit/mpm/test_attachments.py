"""A load on the ground and an obstacle in the way: stresses, impulse, and what is refused."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from ground_studies import CLAY, ROCK, WHOLE, region, tables

import rfmpm
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import RUNNING, start
from rfmpm.study import StudyError, load_study

COLUMN = [[0, 0], [2, 0], [2, 4], [0, 4]]
PRESSURE = 30e3  # [Pa]
SHIFT = 1e-8  # of the static solve, see test_initial_stress


def loaded(**more):
    study = tables(region("all", COLUMN, "rock"), materials=[ROCK], foreland_m=0.0)
    study |= {"load": [{"from_m": 0.0, "to_m": 2.0, "pressure_kpa": PRESSURE / 1e3}]} | more
    study["discretisation"] |= {"shape": "linear", "volumetric_strain": "point"}
    study["boundary"]["base"] = {"kind": "roller"}
    return load_study(study)


def test_a_load_goes_through_the_column_to_the_base():
    points = scenes.build(loaded()).points
    centre = (np.floor(points.position.y / 0.5) + 0.5) * 0.5
    below = centre < 3.5  # within the uppermost cell its force is on the way from the points to the nodes
    exact = -PRESSURE - 24e3 * (4.0 - centre)
    np.testing.assert_allclose(points.stress.yy[below], exact[below], rtol=0.0, atol=SHIFT * 130e3)


@pytest.mark.slow
def test_a_loaded_column_stays_at_rest():
    outcome = rfmpm.simulate(loaded(), homogeneous=True)
    assert np.abs(outcome.points["displacement_y"]).max() < 1e-6
    assert np.isfinite(outcome.points["stress_yy"]).all()


def wall(left, friction=0.0):
    corners = [[left, 0], [left + 1, 0], [left + 1, 5], [left, 5]]
    return {"obstacle": [{"corners_m": corners, "friction": friction}]}


@pytest.mark.slow
def test_a_wall_takes_the_momentum_that_a_block_loses():
    block = [[2, 0], [4, 0], [4, 2], [2, 2]]
    study = tables(region("all", block, "rock"), materials=[ROCK]) | wall(6.0)
    study["boundary"]["base"] = {"kind": "roller"}
    scene = scenes.build(load_study(study))
    # It starts with energy of motion; the filter, which pays no heed to what an obstacle holds, would take 1e-6 of it.
    scene = replace(scene, controls=scene.controls._replace(growth_limit=inf, dissipation_time=inf))
    own = scenes.release(scene, None)
    own.points.velocity.x[:] = 2.0
    before = own.points.mass.sum() * 2.0
    now = SOLVERS["explicit"](start(), 1.5, *scenes.arguments(scene, own))
    after = own.points.mass @ own.points.velocity.x
    assert now.status == RUNNING
    assert after < 0.0  # it bounced, and has not come to the left side yet
    assert own.obstacle.impulse[0] == pytest.approx(before - after, rel=1e-12)
    assert own.points.position.x.max() < 6.0


@pytest.mark.slow
def test_a_wall_stops_a_slide():
    soft = {**CLAY, "cohesion_kpa": 6.0, "residual_cohesion_kpa": 4.0}
    study = tables(region("all", WHOLE), materials=[soft], headroom_m=6.0) | {"time": {"end_s": 3.0}}
    assert rfmpm.simulate(load_study(study)).points["x"].max() > 9.5
    outcome = rfmpm.simulate(load_study(study | wall(8.5)))
    # Splines reach over the wall by less than a cell.
    assert outcome.points["x"].max() < 8.5 + 0.5
    force, time = outcome.history["impact_force"], outcome.history["time"]
    assert outcome.quantities["impact_force_peak"] == force.max() > 0.0
    assert force[time < 0.3].max() == 0.0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"load": [{"from_m": 3.0, "to_m": 1.0, "pressure_kpa": 5.0}]},
            "must be greater than from_m",
        ),
        ({"load": [{"from_m": 3.0, "to_m": 99.0, "pressure_kpa": 5.0}]}, "where the soil ends"),
        ({"obstacle": [{"corners_m": [[6, 0], [8, 0], [8, 2], [6, 2]]}]}, "m2 of soil"),
        ({"obstacle": [{"corners_m": [[9, 0], [9.2, 0], [9.2, 2], [9, 2]]}]}, "is thinner than a cell"),
    ],
)
def test_what_does_not_fit_is_refused(changes, words):
    with pytest.raises(StudyError, match=words.replace(".", r"\.")):
        load_study(tables(region("all", WHOLE)) | changes)


def test_an_obstacle_beside_soil_that_crosses_itself_is_no_second_fault():
    below, crossed = [[0, 0], [25, 0], [25, 2], [0, 2]], [[0, 2], [15, 2], [10, 7], [12, 1], [0, 7]]
    obstacle = {"obstacle": [{"corners_m": [[20, 2], [21, 2], [21, 6], [20, 6]]}]}
    with pytest.raises(StudyError, match="crosses or touches itself") as refused:
        load_study(tables(region("below", below), region("above", crossed)) | obstacle)
    assert not any(problem.startswith("obstacle") for problem in refused.value.problems)
