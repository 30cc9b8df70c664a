"""Motion of named points: which points, what is kept, and that it costs nothing where nobody asks."""

import numpy as np
import pytest
import xarray as xr

import rfmpm
from rfmpm import realisation, report, results
from rfmpm.study import StudyError
from rfmpm.variables import MOTION_VARIABLES

PLACES = [{"name": "crown", "x_m": 3.9, "y_m": 2.0}, {"name": "foot", "x_m": 6.0, "y_m": 0.0}]


@pytest.fixture(scope="module")
def plain():
    return rfmpm.load_study(
        {
            "study": {"name": "slope", "seed": 1},
            "geometry": {"kind": "slope", "height_m": 2.0, "crest_m": 4.0, "angle_deg": 45.0, "foreland_m": 6.0},
            "discretisation": {"cell_m": 0.5, "points_per_cell": 4, "shape": "quadratic_bspline"},
            "boundary": {"base": {"kind": "fixed"}, "sides": {"kind": "roller"}},
            "material": [
                {
                    "name": "clay",
                    "law": "von_mises",
                    "unit_weight_kn_m3": 20.0,
                    "youngs_modulus_kpa": 1000.0,
                    "poissons_ratio": 0.33,
                    "cohesion_kpa": 5.0,
                }
            ],
            "time": {"end_s": 2.0},
            "output": {"directory": "results"},
        }
    )


@pytest.fixture(scope="module")
def study(plain):
    return plain.with_changes({"history": PLACES})


@pytest.fixture(scope="module")
def outcome(study):
    return rfmpm.simulate(study)


def test_nearest_points_are_followed_to_the_end(outcome):
    motion, points = outcome.motion, outcome.points
    assert list(motion["history_point"]) == ["crown", "foot"]
    for k, place in enumerate(PLACES):
        distance = np.hypot(points["x_initial"] - place["x_m"], points["y_initial"] - place["y_m"])
        p = int(np.argmin(distance))
        assert (motion["history_x"][k], motion["history_y"][k]) == (points["x_initial"][p], points["y_initial"][p])
        for name in ("displacement_x", "displacement_y", "velocity_x", "velocity_y"):
            assert motion[f"history_{name}"][-1, k] == points[name][p]
    assert motion["motion_time"][-1] == outcome.history["time"][-1]


def test_samples_start_at_rest_and_are_as_close_as_asked(study, outcome):
    times = outcome.motion["motion_time"]
    assert times[0] == 0.0
    assert not outcome.motion["history_velocity_x"][0].any()
    step = times[-1] / outcome.step_count
    assert np.diff(times).max() <= 0.02 + 1.5 * step
    rare = rfmpm.simulate(study.with_changes({"output.history_interval_s": 0.5})).motion
    assert len(rare["motion_time"]) == 5


@pytest.mark.parametrize("axis", "xy")
def test_acceleration_adds_up_to_the_velocity(outcome, axis):
    motion = outcome.motion
    steps = np.diff(motion["motion_time"])[:, None] * motion[f"history_acceleration_{axis}"][1:]
    velocity = motion[f"history_velocity_{axis}"]
    np.testing.assert_allclose(np.cumsum(steps, axis=0), velocity[1:], rtol=0.0, atol=1e-12 * np.abs(velocity).max())


def test_a_run_is_bit_for_bit_the_same_with_and_without(plain, study, outcome):
    other = rfmpm.simulate(plain)
    assert other.motion == {}
    assert other.step_count == outcome.step_count
    assert other.quantities == pytest.approx(outcome.quantities, rel=0.0, abs=0.0, nan_ok=True)
    for name, values in other.points.items():
        np.testing.assert_array_equal(values, outcome.points[name])
    for name, values in other.history.items():
        np.testing.assert_array_equal(values, outcome.history[name])
    assert plain.physics_hash == study.physics_hash


def test_a_campaign_does_not_follow_points(study, monkeypatch):
    def refuse(*arguments):
        raise AssertionError

    monkeypatch.setattr(realisation, "Motion", refuse)
    assert realisation.run(realisation.prepare(study), 0)["step_count"] > 0


def test_file_holds_the_motion_with_units(study, outcome, tmp_path):
    results.write_simulation(tmp_path / "simulation.nc", outcome, study)
    with xr.open_dataset(tmp_path / "simulation.nc") as kept:
        assert list(kept.history_point.values) == ["crown", "foot"]
        for name, variable in MOTION_VARIABLES.items():
            assert kept[name].dims == variable.dims
            assert kept[name].attrs["units"] == variable.unit
            np.testing.assert_array_equal(kept[name], outcome.motion[name])
        np.testing.assert_array_equal(kept.motion_time, outcome.motion["motion_time"])


def test_picture_has_a_row_for_the_motion(study, plain, outcome, tmp_path):
    from PIL import Image

    report.write_simulation_picture(outcome, study, tmp_path / "with.png")
    report.write_simulation_picture(rfmpm.simulate(plain), plain, tmp_path / "without.png")
    heights = [Image.open(tmp_path / f"{name}.png").height for name in ("with", "without")]
    assert heights[0] > heights[1] + 200


@pytest.mark.parametrize(
    ("places", "said"),
    [
        ([PLACES[0], PLACES[0]], r"history\.1\.name.*is the name of another"),
        ([{"name": "sky", "x_m": 5.0, "y_m": 1.6}], r"history\.0\.y_m.*the ground is at y_m = 1 there"),
        ([{"name": "far", "x_m": 9.0, "y_m": 0.0}], r"history\.0\.y_m.*no soil within a cell"),
        ([{"name": "low", "x_m": 1.0, "y_m": -1.0}], r"history\.0\.y_m"),
        ([{"name": "crown", "x": 1.0, "y_m": 1.0}], r"history\.0\.x = 1.0: unknown key"),
    ],
)
def test_places_that_cannot_be_are_refused(plain, places, said):
    with pytest.raises(StudyError, match=said):
        plain.with_changes({"history": places})
