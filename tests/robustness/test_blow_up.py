"""A run that goes wrong ends with a status and a reason, and never with an exception."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.mpm import scene as scenes
from rfmpm.variables import FAILED, STATUS

STUDY = rfmpm.load_study(Path(__file__).with_name("coarse.toml"))
MEASURES = ("run_out", "failure_volume", "retrogression_distance", "influence_distance", "initial_failure_volume")


@pytest.fixture
def prepared():
    return realisation.prepare(STUDY)


def changed(prepared, controls=None, **points):
    """The prepared study with other numbers for the time integration and other points to start from."""
    scene = prepared.scene
    controls = scene.controls._replace(**(controls or {}))
    return replace(prepared, scene=replace(scene, points=scene.points._replace(**points), controls=controls))


def with_one(vector, component, point, value):
    values = getattr(vector, component).copy()
    values[point] = value
    return vector._replace(**{component: values})


def assert_failed(row, *statuses):
    assert row["status"] in {STATUS[status] for status in statuses}
    assert set(statuses) <= set(FAILED)
    assert row["status_reason"]
    assert all(np.isnan(row[name]) for name in MEASURES)
    assert np.all(np.isnan(row["final_surface"]))


@pytest.mark.parametrize("factor", [3.0, 5.0, 100.0])
def test_a_step_beyond_the_critical_one_is_a_status(prepared, factor):
    courant = factor * prepared.scene.controls.courant / STUDY.time.step_fraction
    row = realisation.run(changed(prepared, {"courant": courant}), 0)
    # A little beyond, the energy grows from step to step; far beyond, the first step throws points out.
    assert_failed(row, "left_grid" if factor == 100.0 else "diverged")
    cause = "left the grid" if factor == 100.0 else "energy came from nothing"
    assert cause in row["status_reason"]
    assert "smaller time.step_fraction" in row["status_reason"]


def test_the_largest_step_that_a_study_may_ask_for_does_not_blow_up():
    row = realisation.run(realisation.prepare(STUDY.with_changes({"time.step_fraction": 1.0})), 0)
    assert row["status"] == STATUS["not_at_rest"]
    assert np.isfinite([row[name] for name in MEASURES]).all()


@pytest.mark.parametrize("component", ["x", "y"])
@pytest.mark.parametrize("point", [0, 60, -1])
def test_a_velocity_that_is_not_a_number_is_a_status(prepared, component, point):
    velocity = with_one(prepared.scene.points.velocity, component, point, np.nan)
    row = realisation.run(changed(prepared, velocity=velocity), 0)
    assert_failed(row, "diverged")
    assert "not a number" in row["status_reason"]


def test_a_velocity_whose_square_is_infinite_is_a_status(prepared):
    # It makes the time step zero, and a run without end if nobody looks.
    velocity = with_one(prepared.scene.points.velocity, "x", 60, 1e200)
    row = realisation.run(changed(prepared, velocity=velocity), 0)
    assert_failed(row, "diverged")
    assert "not a number" in row["status_reason"]


@pytest.mark.parametrize("name", ["xx", "xy"])
def test_a_stress_that_is_not_a_number_is_a_status(prepared, name):
    stress = with_one(prepared.scene.points.stress, name, 10, np.nan)
    row = realisation.run(changed(prepared, stress=stress), 0)
    assert_failed(row, "diverged")


def test_a_cohesion_that_is_not_a_number_is_a_status(prepared, monkeypatch):
    release = scenes.release
    nothing = {"cohesion": np.full(len(prepared.scene.points.mass), np.nan)}
    monkeypatch.setattr(scenes, "release", lambda scene, strengths: release(scene, nothing))
    assert_failed(realisation.run(prepared, 0), "diverged")


def test_a_point_thrown_out_of_the_top_is_named(prepared):
    points = prepared.scene.points
    point = int(np.argmax(points.position.y + points.position.x * 1e-3))
    # One light point in the air above the crest, where nothing holds it.
    position = with_one(points.position, "y", point, prepared.scene.body.top - 0.01)
    velocity = with_one(points.velocity, "y", point, 50.0)
    # The engine counts energy from a start at rest, and would say that the throw came from nothing.
    row = realisation.run(changed(prepared, {"energy_scale": np.inf}, position=position, velocity=velocity), 0)
    assert_failed(row, "left_grid")
    assert f"point {point} left the grid" in row["status_reason"]


def test_outcome_of_a_failed_run_can_be_looked_at(prepared):
    velocity = with_one(prepared.scene.points.velocity, "x", 3, np.nan)
    outcome = realisation.simulate(changed(prepared, velocity=velocity), frames=5)
    assert outcome.status == "diverged"
    assert outcome.points["x"].shape == prepared.scene.points.mass.shape
    assert len(outcome.frames) >= 1


def test_a_failed_run_leaves_the_scene_for_the_next_one(prepared):
    expected = realisation.run(prepared, 0)
    realisation.run(changed(prepared, {"courant": 10.0}), 0)
    again = realisation.run(prepared, 0)
    for name in MEASURES:
        assert again[name] == expected[name]
    assert again["step_count"] == expected["step_count"]
