"""Dataset and study -> every number of the report, once, for the page, the figures and report.json alike."""

import math
from dataclasses import asdict, dataclass, is_dataclass
from datetime import datetime

import numpy as np

from rfmpm import estimators
from rfmpm.estimators.curves import Band
from rfmpm.estimators.intervals import clopper_pearson

CONFIDENCE = 0.95
SPREAD = ("run_out", "failure_volume", "retrogression_distance")
QUALITY = ("plastic_work_share", "friction_work_share", "numerical_dissipation_share", "energy_balance_error")
MOST_POINTS = 2000  # of a curve; more would be seen in no picture and make report.json large
BLOCK = 2**16  # rows whose surfaces are looked at together
PICTURED = (("median", 0.5), ("95th percentile", 0.95), ("worst", 1.0))


@dataclass(frozen=True)
class Numbers:
    """What the report says, as numbers in SI units."""

    held: int  # rows in the dataset
    first: int  # index of the first row: 0 but in a part of a study
    used: int  # rows the estimates rest on: indices from the first on without a gap
    completed: int
    limit: float  # [m]
    mean_run_out: estimators.Estimate  # [m]
    exceedance: estimators.Estimate  # P(run-out > limit) [-]
    failing: estimators.Estimate  # P(any soil fails) [-]
    quantiles: dict[str, estimators.Estimate]  # of run-out [m]
    statuses: dict[str, int]
    reasons: list[tuple[int, str, str]]  # realisation, status, reason, of all that are not "ok"
    censored: int
    quality: dict[str, dict[str, float]]
    cost: dict[str, float]  # [s]
    pictured: list[tuple[str, int, float]]  # which, realisation, run-out [m]
    curve: Band | None  # P(run-out > l) over l [m]
    running_mean: Band  # over the number of realisations [m]
    running_exceedance: Band  # over the number of realisations [-]
    inundation_depth: float  # [m]
    inundation: Band | None  # probability over the distance beyond the toe [m]


def analyse(dataset, study) -> Numbers:
    """Compute every number of the report.

    Args:
        dataset: the ensemble, an xarray.Dataset as `open_ensemble` gives it.
        study: its Study.

    Returns:
        Numbers.
    """
    rows = usable(dataset)
    run_out, censored = rows["run_out"].values, censored_members(rows)
    limit = float(study.quantities.run_out_limit_m)
    counts = _thinned(np.arange(1, run_out.size + 1))
    return Numbers(
        held=dataset.sizes["realisation"],
        first=first_index(dataset),
        used=rows.sizes["realisation"],
        completed=int(np.sum(~np.isnan(run_out))),
        limit=limit,
        mean_run_out=estimators.mean(run_out, CONFIDENCE, censored),
        exceedance=estimators.exceedance(run_out, limit, censored, CONFIDENCE),
        failing=estimators.exceedance(rows["failure_volume"].values, 0.0, censored, CONFIDENCE),
        quantiles={
            name: estimators.quantile(run_out, p, censored, CONFIDENCE) for name, p in (("median", 0.5), ("p95", 0.95))
        },
        statuses=_statuses(rows),
        reasons=_reasons(rows),
        censored=int(np.sum(censored & ~np.isnan(run_out))),
        quality={name: _median_and_worst(rows[name].values) for name in QUALITY if name in rows},
        cost=_cost(dataset),
        pictured=_pictured(rows),
        curve=_curve(run_out, censored, limit),
        running_mean=estimators.running_mean(run_out, CONFIDENCE, counts),
        running_exceedance=estimators.running_exceedance(run_out, limit, censored, CONFIDENCE, counts),
        inundation_depth=float(study.quantities.inundation_depth_m),
        inundation=_inundation(rows, study),
    )


def usable(dataset):
    """Return the rows with indices 0, 1, 2, ... up to the first gap, in this order (xarray.Dataset).

    Those of a part of a study begin with its own first index.
    """
    indices = dataset["realisation"].values
    if np.any(np.diff(indices) < 0):
        dataset = dataset.sortby("realisation")
    return dataset.isel(realisation=slice(estimators.contiguous_prefix(indices - first_index(dataset))))


def first_index(dataset) -> int:
    """Return the index of the first realisation that the dataset is to hold: 0 but in a part of a study."""
    return int(dataset.attrs.get("first_realisation", 0))


def _thinned(values: np.ndarray) -> np.ndarray:
    """At most MOST_POINTS of the values, evenly spread over their order, the first and the last among them."""
    if values.size <= MOST_POINTS:
        return values
    return values[np.linspace(0, values.size - 1, MOST_POINTS).round().astype(int)]


def censored_members(rows) -> np.ndarray:
    """Return where the front met the far wall, shape (n,); nowhere if the dataset does not say."""
    if "run_out_censored" not in rows:
        return np.zeros(rows.sizes["realisation"], bool)
    return np.nan_to_num(rows["run_out_censored"].values.astype(float)) > 0.0


def status_names(rows) -> list[str]:
    """Return the status of every row in words, read off the CF flags."""
    attributes = rows["status"].attrs
    names = dict(
        zip(np.atleast_1d(attributes["flag_values"]).tolist(), attributes["flag_meanings"].split(), strict=True)
    )
    return [names[int(code)] for code in rows["status"].values]


def _statuses(rows) -> dict[str, int]:
    found = status_names(rows)
    order = rows["status"].attrs["flag_meanings"].split()
    return {name: found.count(name) for name in order if name in found}


def _reasons(rows) -> list[tuple[int, str, str]]:
    reasons = rows["status_reason"].values if "status_reason" in rows else [""] * rows.sizes["realisation"]
    members = zip(rows["realisation"].values, status_names(rows), reasons, strict=True)
    return [(int(index), status, str(reason)) for index, status, reason in members if status != "ok"]


def _median_and_worst(values: np.ndarray) -> dict[str, float]:
    sizes = np.abs(values[~np.isnan(values)])
    if not sizes.size:
        return {"median": math.nan, "worst": math.nan}
    return {"median": float(np.median(sizes)), "worst": float(sizes.max())}


def _cost(dataset) -> dict[str, float]:
    wall = dataset["wall_time"].values
    known = wall[~np.isnan(wall)]
    cost = {"computing": float(known.sum()), "per_realisation": float(known.mean()) if known.size else math.nan}
    if {"start", "end"} <= dataset.attrs.keys():
        start, end = (datetime.fromisoformat(dataset.attrs[key]) for key in ("start", "end"))
        cost["elapsed"] = (end - start).total_seconds()
    return cost


def _pictured(rows) -> list[tuple[str, int, float]]:
    """The completed realisations at three ranks of run-out; one that serves twice is named once, with both names."""
    run_out = rows["run_out"].values
    completed = np.flatnonzero(~np.isnan(run_out))
    order = completed[np.argsort(run_out[completed], kind="stable")]
    chosen: dict[int, list[str]] = {}
    for name, rank in PICTURED if order.size else ():
        chosen.setdefault(int(order[math.ceil(rank * order.size) - 1]), []).append(name)
    index = rows["realisation"].values
    return [(", ".join(names), int(index[at]), float(run_out[at])) for at, names in chosen.items()]


def _curve(run_out: np.ndarray, censored: np.ndarray, limit: float) -> Band | None:
    """The exceedance curve at its steps, or at so many of them, from 0 to a little beyond the last and the limit."""
    steps = np.unique(run_out[~np.isnan(run_out)])
    if not steps.size:
        return None
    start, end = min(0.0, steps[0]), 1.15 * max(steps[-1], limit, 1.0)
    return estimators.exceedance_curve(run_out, np.unique([start, *_thinned(steps), end]), censored, CONFIDENCE)


def _inundation(rows, study) -> Band | None:
    """P(deposit depth >= asked depth) in every bin beyond the toe; failed realisations count both ways."""
    if "final_surface" not in rows or not rows.sizes["realisation"]:
        return None
    from rfmpm.mpm.scene import toe_x

    distance = rows["x"].values - toe_x(study)
    beyond = distance > 0.0
    surface, failed = rows["final_surface"].values, np.isnan(rows["run_out"].values)
    n, n_failed = failed.size, int(failed.sum())
    count = np.zeros(int(beyond.sum()), int)
    for start in range(0, n, BLOCK):
        depth = surface[start : start + BLOCK, beyond][~failed[start : start + BLOCK]]
        count += np.sum(depth >= study.quantities.inundation_depth_m, axis=0)  # NaN, no soil in the bin, is not
    lower, _ = clopper_pearson(count, n, CONFIDENCE)
    _, upper = clopper_pearson(count + n_failed, n, CONFIDENCE)
    value = count / (n - n_failed) if n > n_failed else np.full(count.shape, np.nan)
    return Band(distance[beyond], value, lower, upper, CONFIDENCE)


def as_json(value):
    """Turn numbers into what JSON can hold: NaN and infinity become null, arrays lists, records dictionaries."""
    if is_dataclass(value):
        value = asdict(value)
    if isinstance(value, dict):
        return {key: as_json(item) for key, item in value.items() if item is not None}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [as_json(item) for item in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value
