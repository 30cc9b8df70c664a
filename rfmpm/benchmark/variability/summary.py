"""The rows of the study and what they say of each quantity, as one labelled dataset."""

from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rfmpm import estimators
from rfmpm.benchmark.variability.campaigns import FIELD, Grid
from rfmpm.estimators import Estimate
from rfmpm.planning.records import BOUNDED_BY
from rfmpm.variables import FAILED_CODES

if TYPE_CHECKING:
    import xarray as xr

CONFIDENCE, CHARACTERISTIC = 0.95, 0.95
KEPT = (
    *("run_out", "run_out_censored", "retrogression_distance", "retrogression_censored"),
    *("failure_volume", "block_count", "status"),
)
ENDS = {"": "", "_lower": ", lower end of its 95 % interval", "_upper": ", upper end of its 95 % interval"}


class Quantity(NamedTuple):
    """A quantity of the study and the thresholds of its exceedance curve."""

    noun: str
    unit: str
    thresholds: np.ndarray  # shape (k,), in the unit


QUANTITIES = {
    "run_out": Quantity("run-out", "m", np.arange(0.0, 25.1, 0.25)),
    "retrogression_distance": Quantity("retrogression", "m", np.arange(0.0, 10.1, 0.5)),
    "failure_volume": Quantity("failure volume", "m3 m-1", np.arange(0.0, 62.6, 2.5)),
}
GRID_ATTRIBUTES = {
    "coefficient_of_variation": ("1", f"{FIELD}.coefficient_of_variation"),
    "vertical_scale": ("m", f"{FIELD}.scale_of_fluctuation_v_m"),
    "scale_ratio": ("1", f"{FIELD}.scale_of_fluctuation_h_m over {FIELD}.scale_of_fluctuation_v_m"),
}


def summarise(grid: Grid, campaigns: Mapping[tuple[int, ...], "xr.Dataset"]) -> "xr.Dataset":
    """Put the rows of all combinations side by side and add mean, spread, characteristic value and exceedance curve.

    Args:
        grid: of the combinations.
        campaigns: rows of each combination by its position, as many in each.

    Returns:
        Dataset over (coefficient_of_variation, vertical_scale, scale_ratio): the rows along `realisation`, and for each
        quantity `_mean`, `_standard_deviation`, `_characteristic` (the 95 % quantile) and, along the quantity's
        threshold, `_exceedance`, each with the ends of its 95 % interval in `_lower` and `_upper`; `failed_count`, and
        `computing_time` [s] of all rows.
    """
    import xarray as xr

    first = campaigns[0, 0, 0]
    dimensions, positions = grid._fields, list(product(*map(range, grid.shape)))
    coordinates = {
        name: (name, np.array(values), {"units": GRID_ATTRIBUTES[name][0], "long_name": GRID_ATTRIBUTES[name][1]})
        for name, values in zip(dimensions, grid, strict=True)
    }
    found = xr.Dataset(coords=coordinates | {"realisation": first["realisation"]}, attrs=_origin(first))

    def over_the_grid(value: Callable[[Any], np.ndarray]) -> np.ndarray:
        columns = [value(campaigns[position]) for position in positions]
        return np.array(columns).reshape(*grid.shape, *np.shape(columns[0]))

    for name in KEPT:
        rows = over_the_grid(lambda each, name=name: each[name].values)
        found[name] = ((*dimensions, "realisation"), rows, first[name].attrs, {"zlib": True, "shuffle": True})
    failed = over_the_grid(lambda each: each["status"].isin(list(FAILED_CODES)).sum().values)
    time = over_the_grid(lambda each: each["wall_time"].sum().values)
    found["failed_count"] = (dimensions, failed, {"units": "1", "long_name": "number of failed realisations"})
    found["computing_time"] = (dimensions, time, {"units": "s", "long_name": "computing time of all realisations"})
    for name in QUANTITIES:
        found = found.assign(_statistics(found, name))
    return found


def _origin(first: "xr.Dataset") -> dict[str, Any]:
    kept = ("Conventions", "source", "seed", "rfmpm_version", "source_hash", "library_versions", "study")
    return {name: first.attrs[name] for name in kept if name in first.attrs} | {
        "title": "random-field study of the short slope",
        "comment": "Realisation i has the same random numbers in every combination. Censored values are lower bounds: "
        "they count as exceeding every threshold, and enter mean and standard deviation at their value.",
    }


def outcomes(cell: "xr.Dataset", quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Values of a quantity along the realisations, NaN where it failed, and whether they are lower bounds."""
    censored = np.any([cell[flag].values == 1 for flag in BOUNDED_BY[quantity]], axis=0)
    return cell[quantity].values.astype(float), censored


def each_cell(found: "xr.Dataset", dimensions: tuple[str, ...] = Grid._fields) -> Iterator["xr.Dataset"]:
    """Every combination of the values along some dimensions, the last one running fastest."""
    for position in product(*(range(found.sizes[name]) for name in dimensions)):
        yield found.isel(dict(zip(dimensions, position, strict=True)))


def _statistics(found: "xr.Dataset", name: str) -> dict[str, Any]:
    quantity, shape = QUANTITIES[name], tuple(found.sizes[dimension] for dimension in Grid._fields)
    threshold = f"{name}_threshold"
    estimates: dict[str, list[Estimate]] = {"mean": [], "standard_deviation": [], "characteristic": []}
    curves = []
    for cell in each_cell(found):
        values, censored = outcomes(cell, name)
        estimates["mean"].append(estimators.mean(values, CONFIDENCE, censored))
        estimates["standard_deviation"].append(estimators.standard_deviation(values, CONFIDENCE))
        estimates["characteristic"].append(estimators.quantile(values, CHARACTERISTIC, censored, CONFIDENCE))
        curves.append(estimators.exceedance_curve(values, quantity.thresholds, censored, CONFIDENCE))
    words = {"mean": "mean", "standard_deviation": "standard deviation", "characteristic": "95 % quantile"}
    new: dict[str, Any] = {threshold: (threshold, quantity.thresholds, {"units": quantity.unit})}
    for end, text in ENDS.items():
        part = end.removeprefix("_") or "value"
        for statistic, all_cells in estimates.items():
            values = np.reshape([getattr(each, part) for each in all_cells], shape)
            attributes = {"units": quantity.unit, "long_name": f"{words[statistic]} of the {quantity.noun}{text}"}
            new[f"{name}_{statistic}{end}"] = (Grid._fields, values, attributes)
        values = np.reshape([getattr(each, part) for each in curves], (*shape, -1))
        attributes = {"units": "1", "long_name": f"probability that the {quantity.noun} exceeds the threshold{text}"}
        new[f"{name}_exceedance{end}"] = ((*Grid._fields, threshold), values, attributes, {"zlib": True})
    return new
