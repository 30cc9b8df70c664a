from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import rfmpm
from rfmpm import results
from rfmpm.variables import HISTORY_VARIABLES, POINT_VARIABLES

POINTS = 5
DRAINED = Path(__file__).parents[3] / "configs" / "drained_cross_correlated.toml"


def points(shift):
    return {name: np.arange(POINTS) + 10.0 * place + shift for place, name in enumerate(POINT_VARIABLES)}


def outcome(frame_times, history_times):
    return SimpleNamespace(
        points=points(9.0), frames=[(time, points(time)) for time in frame_times], motion={}, status="ok", reason="",
        step_count=7, wall_time=0.25,
        history={"time": history_times}
        | {name: np.arange(len(history_times)) + place for place, name in enumerate(HISTORY_VARIABLES)},
    )  # fmt: skip


def written(tmp_path, study, frame_times, history_times):
    results.write_simulation(tmp_path / "simulation.nc", outcome(frame_times, history_times), study)
    return xr.load_dataset(tmp_path / "simulation.nc", decode_times=False)


def test_snapshots_and_a_denser_history(tmp_path, study):
    found = written(tmp_path, study, [0.0, 0.5, 1.0], np.linspace(0.0, 1.0, 11))
    assert dict(found.sizes) == {"time": 3, "point": POINTS, "history_time": 11}
    assert found["x"].dims == ("time", "point")
    assert found["cohesion"].dims == ("point",)
    assert found["front"].dims == ("history_time",)
    np.testing.assert_array_equal(found["stress_xy"][1], points(0.5)["stress_xy"])
    assert "history_time" in found.attrs["comment"]


def test_history_of_the_same_times_shares_their_dimension(tmp_path, study):
    found = written(tmp_path, study, [0.0, 1.0], np.array([0.0, 1.0]))
    assert found["kinetic_energy"].dims == ("time",)
    assert found["kinetic_energy"].attrs["units"] == "J m-1"
    assert "history_time" not in found.sizes


def test_without_snapshots_the_final_state_is_kept(tmp_path, study):
    found = written(tmp_path, study, [], np.array([0.0, 2.0]))
    np.testing.assert_array_equal(found["time"], [2.0])
    np.testing.assert_array_equal(found["x"][0], points(9.0)["x"])


@pytest.mark.parametrize("name", POINT_VARIABLES)
def test_units_and_time_axis(tmp_path, study, name):
    found = written(tmp_path, study, [0.0], np.array([0.0, 1.0]))
    assert found[name].attrs["units"] == POINT_VARIABLES[name].unit
    assert found["time"].attrs["units"] == "s"
    assert found["time"].encoding.get("_FillValue") is None  # CF: coordinates miss nothing
    assert found.attrs["status"] == "ok"


def test_random_properties_are_kept_where_they_are_random(tmp_path):
    changes = {"discretisation.cell_m": 1.0, "time.end_s": 0.1}
    study = rfmpm.load_study(DRAINED).with_changes(changes)
    results.write_simulation(tmp_path / "simulation.nc", rfmpm.simulate(study, index=2), study)
    fields = rfmpm.realise_fields(study, index=2)
    with xr.open_dataset(tmp_path / "simulation.nc") as data:
        assert data["friction_angle"].attrs["units"] == "rad"
        assert "residual_cohesion" not in data
        for name, values in fields.items():
            np.testing.assert_array_equal(data[name], values)
