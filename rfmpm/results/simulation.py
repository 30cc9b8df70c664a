"""One realisation with its snapshots and histories as a NetCDF file."""

from pathlib import Path

import numpy as np

from rfmpm.results.netcdf import labelled_array, write_dataset
from rfmpm.results.provenance import global_attributes
from rfmpm.variables import HISTORY_VARIABLES, MOTION_VARIABLES, POINT_VARIABLES, Variable

# The standard name "time" and the axis T are for times of a calendar ("seconds since ..."), which a model has not.
_TIME = {"comment": "Model time since release."}


def write_simulation(path: Path, outcome, study) -> None:
    """Write simulation.nc: points over `time`, histories over `time` or, where denser, over `history_time`.

    The motion of the study's named points is over `motion_time` and `history_point`.

    Without frames the final state is the one entry of `time`.

    Args:
        path: the file; replaced if it exists.
        outcome: the Outcome of a simulation.
        study: the study it belongs to.

    Raises:
        OSError: if the file cannot be written.
    """
    import xarray as xr

    history = {name: np.asarray(values) for name, values in outcome.history.items()}
    frames = outcome.frames or [(history["time"][-1], outcome.points)]
    times = np.array([time for time, _ in frames])
    data = {
        name: labelled_array(variable, _over_frames(variable, frames, outcome.points), study)
        for name, variable in POINT_VARIABLES.items()
        if name in outcome.points
    }
    coordinates = {"time": _time("time", times, study)}
    shared = np.array_equal(times, history["time"])
    if not shared:
        coordinates["history_time"] = _time("history_time", history["time"], study)
    for name, variable in HISTORY_VARIABLES.items():
        if name in history:
            labelled = labelled_array(variable, history[name], study)
            data[name] = labelled if not shared else xr.Variable(("time",), labelled.values, labelled.attrs)
    if outcome.motion:
        coordinates["motion_time"] = _time("motion_time", outcome.motion["motion_time"], study)
        coordinates["history_point"] = xr.Variable(
            ("history_point",), outcome.motion["history_point"], {"long_name": "name of a point in the study"}
        )
        for name, variable in MOTION_VARIABLES.items():
            data[name] = labelled_array(variable, outcome.motion[name], study)
    attributes = global_attributes(study) | {
        "comment": "Histories are given over time."
        if shared
        else "Histories are given over history_time, which is denser than the snapshots' time.",
        "status": outcome.status,
        "status_reason": outcome.reason,
        "step_count": outcome.step_count,
        "wall_time_s": outcome.wall_time,
    }
    write_dataset(Path(path), xr.Dataset(data, coordinates, attributes))


def _time(name: str, values: np.ndarray, study):
    variable = Variable(name, (name,), "float64", "s", "model time", _TIME)
    return labelled_array(variable, values, study)


def _over_frames(variable: Variable, frames: list, final: dict) -> np.ndarray:
    if "time" not in variable.dims:
        return np.asarray(final[variable.name])
    return np.array([points[variable.name] for _, points in frames])
