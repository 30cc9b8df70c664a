"""One realisation: a pure function of study, index and level."""

from dataclasses import replace
from math import isnan
from pathlib import Path

import numpy as np
import pytest

from rfmpm import seeds
from rfmpm.observer import SAMPLE_INTERVAL
from rfmpm.quantities import QUANTITIES
from rfmpm.realisation import compile_kernels, prepare, realise_fields, run, simulate
from rfmpm.study import load_study
from rfmpm.variables import COORDINATES, POINT_VARIABLES, STATUS, active_variables

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


@pytest.fixture(scope="module")
def prepared(study):
    return prepare(study)


@pytest.fixture(scope="module")
def homogeneous(study):
    return prepare(without_field(study))


def without_field(study):
    return study.with_changes({"random_field": {}})


def without_time(row, *others):
    return {name: value for name, value in row.items() if name not in ("wall_time", *others)}


def longest_step(prepared):
    controls = prepared.scene.controls
    return controls.courant * controls.cell / controls.wave_speed


def is_same(row, other):
    """Bit for bit, NaN equal to NaN."""
    assert row.keys() == other.keys()
    return all(np.asarray(row[name]).tobytes() == np.asarray(other[name]).tobytes() for name in row)


@pytest.mark.parametrize("index", [0, 5])
def test_same_arguments_same_row(prepared, study, index):
    row = without_time(run(prepared, index))
    run(prepared, index + 1)  # what came before leaves nothing behind
    assert is_same(without_time(run(prepared, index)), row)
    assert is_same(without_time(run(prepare(study), index)), row)


def test_same_row_with_a_stored_factor(prepared, study, tmp_path):
    row = without_time(run(prepared, 3))
    for _ in range(2):  # made, then found
        assert is_same(without_time(run(prepare(study, tmp_path), 3)), row)


def test_compiling_ahead_changes_nothing(prepared, study):
    ahead = prepare(study)
    compile_kernels(ahead)
    assert is_same(without_time(run(ahead, 2)), without_time(run(prepared, 2)))


@pytest.mark.parametrize("other", [{"index": 1}, {"index": 0, "level": 1}])
def test_index_and_level_choose_the_field(prepared, other):
    row, second = run(prepared, 0), run(prepared, **other)
    assert (second["realisation"], second["level"]) == (other["index"], other.get("level", 0))
    assert not np.array_equal(row["final_surface"], second["final_surface"])


def test_given_xi_is_the_drawn_one(prepared, study):
    count = prepared.fields["cohesion"].n_variables
    drawn = seeds.standard_normal(study.study.seed, 2, 7, count)
    row = without_time(run(prepared, 7, level=2))
    assert is_same(without_time(run(prepared, 7, level=2, xi=drawn)), row)
    assert not is_same(without_time(run(prepared, 7, level=2, xi=-drawn)), row)
    # With xi given, index and level are names only.
    named = without_time(run(prepared, 0, xi=drawn), "realisation", "level")
    assert is_same(named, without_time(row, "realisation", "level"))


def test_row_holds_exactly_the_active_variables(prepared, homogeneous, study):
    for one in (prepared, homogeneous):
        expected = {variable.name for variable in active_variables(one.study)} | {"realisation", "level"}
        assert run(one, 0).keys() == expected
    bare = study.model_dump(exclude_none=True)
    del bare["output"]["surface_bin_m"]
    assert "final_surface" in run(prepared, 0)
    assert "final_surface" not in run(prepare(load_study(bare)), 0)


def test_row_is_finite_and_of_the_kinds_of_the_table(prepared):
    row = run(prepared, 0)
    assert row["status"] == STATUS["not_at_rest"]
    assert "time.end_s = 1 s" in row["status_reason"]
    assert isnan(row["time_at_rest"])
    assert row["wall_time"] > 0.0
    for variable in active_variables(prepared.study):
        value = row[variable.name]
        if variable.name == "time_at_rest" or variable.dtype == "str":
            continue
        assert np.asarray(value).dtype.kind == np.dtype(variable.dtype).kind, variable.name
        assert np.all(np.isfinite(value)), variable.name
    assert row["final_surface"].shape == (16,)


def test_row_of_a_run_that_comes_to_rest(study):
    # Soft enough to slide, and stopped by a base that holds: rests long before the end.
    calm = study.with_changes(
        {
            "time.end_s": 60.0,
            "material.0.cohesion_kpa": 40.0,
            "material.0.residual_cohesion_kpa": 40.0,
            "discretisation.dissipation_time_s": 0.1,
        }
    )
    row = run(prepare(calm), 0)
    assert (row["status"], row["status_reason"]) == (STATUS["ok"], "")
    assert 1.0 < row["time_at_rest"] < 60.0


def test_homogeneous_run_ignores_index_and_level(homogeneous):
    first, second = run(homogeneous, 0), run(homogeneous, 41, level=3)
    assert (second["realisation"], second["level"]) == (41, 3)
    assert is_same(without_time(first, "realisation", "level"), without_time(second, "realisation", "level"))


def test_leaving_the_field_out_is_the_homogeneous_study(prepared, homogeneous):
    found, expected = simulate(prepared, 4, homogeneous=True), simulate(homogeneous)
    assert is_same(found.quantities, expected.quantities)
    assert np.all(found.points["cohesion"] == 8e3)
    assert not is_same(found.quantities, simulate(prepared, 4).quantities)


def test_fields_are_those_of_the_run(prepared, study):
    field = realise_fields(study, 6, level=1)
    assert field.keys() == {"cohesion"}
    np.testing.assert_array_equal(simulate(prepared, 6, level=1).points["cohesion"], field["cohesion"])
    assert realise_fields(without_field(study), 6) == {}


def test_cohesion_of_the_points_is_the_one_asked_for_in_either_convention(study):
    changes = {"random_field": {}, "material.0.strength_convention": "sqrt_3j2"}
    asked = study.material[0].cohesion_kpa * 1e3
    assert np.all(simulate(prepare(study.with_changes(changes))).points["cohesion"] == asked)


def test_simulation_agrees_with_the_row(prepared):
    row, outcome = run(prepared, 3), simulate(prepared, 3)
    assert is_same({name: row[name] for name in outcome.quantities}, outcome.quantities)
    assert (STATUS[outcome.status], outcome.reason) == (row["status"], row["status_reason"])
    assert outcome.step_count == row["step_count"]
    assert outcome.quantities["failure_volume"] == outcome.history["failed_volume"][-1]


def test_points_are_those_of_the_table(prepared):
    outcome = simulate(prepared, 0)
    points, count = outcome.points, len(prepared.scene.points.mass)
    assert points.keys() == {name for name, each in POINT_VARIABLES.items() if each.is_active(prepared.study)}
    assert all(values.shape == (count,) for values in points.values())
    for axis in ("x", "y"):
        moved = points[axis] - points[f"{axis}_initial"]
        np.testing.assert_array_equal(points[f"displacement_{axis}"], moved)
    np.testing.assert_array_equal(points["x_initial"], prepared.scene.points.position.x)


@pytest.mark.parametrize("frames", [0, 2, 4, 7])
def test_frames_are_as_many_as_asked_evenly_spread_from_start_to_end(prepared, frames):
    outcome = simulate(prepared, 0, frames=frames)
    times = [time for time, _ in outcome.frames]
    assert len(times) == frames
    if frames:
        assert times[0] == 0.0
        assert times[-1] == outcome.history["time"][-1] >= prepared.study.time.end_s
        # Even in the number of samples, which are as far apart as their interval, up to a step, but for the last one.
        controls = prepared.scene.controls
        longest_step = controls.courant * controls.cell / controls.wave_speed
        even = np.linspace(0.0, times[-1], frames)
        assert np.abs(times - even).max() < SAMPLE_INTERVAL + longest_step


def test_more_frames_than_samples_gives_every_sample(prepared):
    outcome = simulate(prepared, 0, frames=1000)
    assert [time for time, _ in outcome.frames] == [0.0, *outcome.history["time"]]


def test_frames_show_the_state_of_their_time(prepared):
    outcome = simulate(prepared, 0, frames=4)
    first, last = outcome.frames[0][1], outcome.frames[-1][1]
    assert not first["displacement_x"].any()
    assert not first["velocity_y"].any()
    assert first["stress_yy"].min() < 0.0
    for name, values in last.items():
        np.testing.assert_array_equal(values, outcome.points[name])


def test_looking_changes_nothing(prepared):
    plain, seen = simulate(prepared, 0), simulate(prepared, 0, frames=5)
    assert is_same(plain.points, seen.points)
    assert is_same(plain.quantities, seen.quantities)
    assert seen.history.keys() - plain.history.keys() == {"front", "crest"}


def test_histories_have_an_entry_per_interval(prepared):
    history = simulate(prepared, 0, frames=2).history
    count = len(history["time"])
    assert all(values.shape == (count,) for values in history.values())
    # A sample is taken after the first step that ends the interval; the last one at the end.
    intervals, step, end = np.diff(history["time"], prepend=0.0), longest_step(prepared), prepared.study.time.end_s
    assert end / (SAMPLE_INTERVAL + step) <= count <= round(end / SAMPLE_INTERVAL)
    assert np.all(intervals[:-1] >= SAMPLE_INTERVAL * (1.0 - 1e-12))
    assert np.all(intervals < SAMPLE_INTERVAL + step)
    assert 0.0 <= history["time"][-1] - end < step
    body = prepared.scene.body
    assert np.all(history["crest"] <= body.crest_edge)
    assert history["front"][-1] > body.toe
    assert history["failed_volume"][0] == 0.0


def test_numerical_failure_is_a_row_with_a_status_and_no_quantities(prepared):
    scene = prepared.scene
    broken = replace(prepared, scene=replace(scene, controls=scene.controls._replace(courant=5.0)))
    row = run(broken, 0)
    assert row.keys() == run(prepared, 0).keys()
    assert row["status"] == STATUS["diverged"]
    assert row["status_reason"]
    assert all(np.all(np.isnan(row[name])) for name in (*QUANTITIES, "initial_failure_volume", "time_at_rest"))
    assert row["step_count"] >= 1
    assert row["realisation"] == 0
    assert COORDINATES["realisation"].name in row


def test_time_limit_makes_a_row_that_says_so(study):
    limited = prepare(study.with_changes({"failures.realisation_time_limit_s": 1e-9}))
    row = run(limited, 2)
    assert (row["status"], row["realisation"]) == (STATUS["timeout"], 2)
    assert row["status_reason"] == "took longer than failures.realisation_time_limit_s = 1e-09 s"
    assert isnan(row["run_out"])
    assert row["wall_time"] > 0.0
    assert simulate(limited, 2).status != "timeout"  # a person who looks at one may take the time


def test_time_limit_that_is_not_reached_changes_no_bit(prepared, study):
    limited = prepare(study.with_changes({"failures.realisation_time_limit_s": 1e9}))
    np.testing.assert_equal(without_time(run(limited, 2)), without_time(run(prepared, 2)))


def test_watch_is_called_on_the_way_and_what_it_raises_is_passed_on(prepared, study):
    calls = []
    watched = run(prepared, 2, watch=lambda: calls.append(None))
    assert len(calls) >= study.time.end_s / SAMPLE_INTERVAL - 1
    np.testing.assert_equal(without_time(watched), without_time(run(prepared, 2)))

    def enough():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(prepared, 2, watch=enough)
