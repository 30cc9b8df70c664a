"""The campaigns of a sweep as one labelled dataset, whose first dimensions are the swept parameters."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm import estimators
from rfmpm.variables import FAILED_CODES

if TYPE_CHECKING:
    import xarray as xr

SWEEP_FILE = "sweep.nc"
UNITS = {"kpa": "kPa", "deg": "degree", "kn_m3": "kN m-3", "kpa_s": "kPa s", "kpa_per_m": "kPa m-1", "m": "m", "s": "s"}
SUMMARY = {
    "mean_run_out": ("mean run-out distance", "m"),
    "exceedance_probability": ("probability that the run-out exceeds the limit", "1"),
}
CONFIDENCE = 0.95


def unit_of(key: str) -> str:
    """Unit that the name of a study's key ends in; "1" if it ends in none."""
    last = key.rpartition(".")[2]
    fitting = [ending for ending in UNITS if last.endswith(f"_{ending}")]
    return UNITS[max(fitting, key=len)] if fitting else "1"


def sweep_dataset(axes: Sequence[Any], campaigns: Mapping[tuple[int, ...], "xr.Dataset"], limit: float) -> "xr.Dataset":
    """Put the campaigns of a grid side by side.

    Args:
        axes: of the grid, each with `name`, `keys` and `values`.
        campaigns: rows of each cell by its position.
        limit: the l in P(run-out > l) [m].

    Returns:
        The variables of a campaign over (axes..., realisation), surfaces only where all cells have the same bins; and
        over the axes alone mean run-out and exceedance probability with 95 % intervals, and the count of failures.
    """
    import xarray as xr

    names, shape = tuple(axis.name for axis in axes), tuple(len(axis.values) for axis in axes)
    first = campaigns[(0,) * len(shape)]
    data = {}
    for name, variable in first.data_vars.items():
        parts = {position: rows[name] for position, rows in campaigns.items()}
        if any(part.shape != variable.shape or not _has_same_bins(part, variable) for part in parts.values()):
            continue
        whole = np.empty((*shape, *variable.shape), variable.dtype)
        for position, part in parts.items():
            whole[position] = part.values
        data[name] = xr.Variable((*names, *variable.dims), whole, variable.attrs, _encoding(variable))
    kept = ("title", "Conventions", "source", "seed", "rfmpm_version", "source_hash")
    attributes = {name: first.attrs[name] for name in kept if name in first.attrs}
    attributes["comment"] = (
        "Realisation i has the same random numbers in every cell: differences between cells are of their parameters."
    )
    coordinates = {name: first.coords[name] for name in first.coords if any(name in v.dims for v in data.values())}
    summary = _summary(names, shape, campaigns, limit)
    return xr.Dataset(data | summary, _coordinates(axes) | coordinates, attributes)


def _has_same_bins(part: Any, variable: Any) -> bool:
    return "x" not in variable.dims or np.array_equal(part["x"].values, variable["x"].values)


def _encoding(variable: Any) -> dict[str, Any]:
    """As in the campaigns' own files, but for the chunks."""
    if variable.dtype == object:
        return {}
    kept = {name: value for name, value in variable.encoding.items() if name in ("dtype", "_FillValue")}
    return kept | {"zlib": True, "shuffle": True, "complevel": 4}


def _coordinates(axes: Sequence[Any]) -> dict[str, Any]:
    """Values of the first key of each axis along it, those of the others beside it."""
    found = {}
    for axis in axes:
        for number, key in enumerate(axis.keys):
            name = axis.name if number == 0 else key.rpartition(".")[2]
            values = np.array([value[number] for value in axis.values])
            attributes = {"long_name": f"study key {key}"}
            if values.dtype.kind in "if":
                attributes["units"] = unit_of(key)
            found[name] = (axis.name, values, attributes)
    return found


def _summary(names, shape, campaigns: Mapping[tuple[int, ...], "xr.Dataset"], limit: float) -> dict[str, Any]:
    columns = {f"{name}{end}": np.full(shape, np.nan) for name in SUMMARY for end in ("", "_lower", "_upper")}
    failed = np.zeros(shape, "int32")
    for position, rows in campaigns.items():
        censored = np.nan_to_num(rows["run_out_censored"].values) > 0.0
        found = {
            "mean_run_out": estimators.mean(rows["run_out"].values, CONFIDENCE, censored),
            "exceedance_probability": estimators.exceedance(rows["run_out"].values, limit, censored, CONFIDENCE),
        }
        for name, estimate in found.items():
            columns[name][position] = estimate.value
            columns[f"{name}_lower"][position] = estimate.lower
            columns[f"{name}_upper"][position] = estimate.upper
        failed[position] = int(rows["status"].isin(list(FAILED_CODES)).sum())
    ends = {"_lower": ", lower end of its 95 % interval", "_upper": ", upper end of its 95 % interval"}
    found = {}
    for name, values in columns.items():
        base = name.removesuffix("_lower").removesuffix("_upper")
        text, unit = SUMMARY[base]
        attributes = {"long_name": text + ends.get(name.removeprefix(base), ""), "units": unit}
        if base == "exceedance_probability":
            attributes["run_out_limit_m"] = limit
        found[name] = (names, values, attributes)
    found["failed_count"] = (names, failed, {"long_name": "number of failed realisations", "units": "1"})
    return found
