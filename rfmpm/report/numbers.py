"""Dataset and study -> every number of the report, once, for the page, the figures and report.json alike."""

import math
from dataclasses import asdict, dataclass, is_dataclass

import numpy as np

from rfmpm import estimators, planning
from rfmpm.estimators.curves import Band
from rfmpm.estimators.discretisation import Discretisation
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.failure_modes import MODES
from rfmpm.report.answering import Answers
from rfmpm.report.asked import Asked, asked
from rfmpm.report.budget import Budget, Standing, budget, next_steps
from rfmpm.report.costs import cost
from rfmpm.report.members import censored_members, first_index, flagged, independent, reasons, statuses, usable
from rfmpm.report.modes import Mode, modes
from rfmpm.report.safety import Safety, safety

CONFIDENCE = 0.95
QUALITY = ("plastic_work_share", "friction_work_share", "numerical_dissipation_share", "energy_balance_error")
MOST_POINTS = 2000  # of a curve; more would be seen in no picture and make report.json large
FEWER_POINTS = 200  # of a curve that takes an estimator's whole work at each
BLOCK = 2**16  # rows whose surfaces are looked at together
PICTURED = (("median", 0.5), ("95th percentile", 0.95), ("worst", 1.0))
MOST_PICTURED = len(PICTURED) + len(MODES)  # a typical member of each kind of failure, too


@dataclass(frozen=True)
class Numbers:
    """What the report says, as numbers in SI units."""

    asked: Asked
    answer: estimators.Estimate
    budget: Budget
    discretisation: Discretisation | None
    next_steps: list[str]
    is_random: bool  # whether realisations differ
    choice: str  # how most realisations were chosen, the first ones alone being a fair sample; empty: not at all
    is_plain: bool  # whether they are independent and all on the study's own cells
    coarser: int  # rows on coarser cells
    held: int  # rows in the dataset, on the study's own cells
    first: int  # index of the first row: 0 but in a part of a study
    used: int  # rows the estimates rest on: indices from the first on without a gap
    completed: int
    beyond: int  # of them beyond the limit; 0 unless a probability is asked
    limit: float  # of the run-out [m]
    mean_run_out: estimators.Estimate  # [m]
    exceedance: estimators.Estimate  # P(run-out > limit) [-]
    failing: estimators.Estimate  # P(any soil fails) [-]
    quantiles: dict[str, estimators.Estimate]  # of run-out [m]
    given_failure: dict[str, estimators.Estimate]  # of the run-out of slopes that fail: exceedance [-], median [m]
    modes: list[Mode]
    safety: Safety | None  # factors of safety beside failures
    statuses: dict[str, int]
    reasons: list[tuple[int, str, str]]  # realisation, status, reason, of all that are not "ok"
    censored: int
    at_back: int  # slides that met the edge behind the crest
    quality: dict[str, dict[str, float]]
    cost: dict[str, float]  # [s], [J]
    pictured: list[tuple[str, int, float]]  # which, realisation, run-out [m]
    curve: Band | None  # P(quantity asked > l) over l [m or m3/m]
    running_mean: Band  # of the quantity asked, over the number of realisations [m or m3/m]
    running_exceedance: Band | None  # over the number of realisations [-]
    settling: Band | None  # the answer over the number of realisations, where no running estimate shows it
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
    rows, answers = usable(dataset, study), Answers(dataset, study, CONFIDENCE)
    counted = independent(rows, study)
    return Numbers(
        **_answer(rows if answers.fair_size is None else planning.on_own_cells(dataset), study, answers),
        **_of_run_out(rows, study, answers),
        **_curves(rows, study, answers),
        coarser=int(np.sum(dataset["level"].values > 0)),
        held=int(np.sum(dataset["level"].values == 0)),
        first=first_index(dataset),
        modes=modes(counted, CONFIDENCE),
        safety=safety(counted, CONFIDENCE),
        statuses=statuses(rows),
        reasons=reasons(rows),
        quality={name: _median_and_worst(rows[name].values) for name in QUALITY if name in rows},
        cost=cost(dataset),
        pictured=_pictured(rows),
    )


def _answer(rows, study, answers: Answers) -> dict:
    """The answer, its error and what to do next."""
    question = asked(answers.question)
    values, censored = rows[question.quantity].values, censored_members(rows, question.quantity)
    completed = ~np.isnan(values)
    answer, cells = answers.estimate(answers.rows), answers.discretisation()
    parts = budget(answer, answers.without_failures(), cells, question)
    beyond = (values > question.limit) | censored if question.is_probability else np.zeros(values.size, bool)
    counts = {"used": values.size, "completed": int(completed.sum()), "beyond": int(np.sum(beyond & completed))}
    standing = Standing(
        question,
        answer,
        parts,
        is_random=bool(study.fields or study.uncertain),
        at_back=int(np.sum(flagged(rows, "retrogression_censored") & completed)),
        at_front=int(np.sum(flagged(rows, "run_out_censored") & completed)),
        wanted=answers.question.wanted_half_width(answer.value),
        **counts,
    )
    return counts | {
        "asked": question,
        "answer": answer,
        "budget": parts,
        "discretisation": cells,
        "next_steps": next_steps(standing, study),
        "is_random": standing.is_random,
        "choice": _choice(answers),
        "is_plain": answers.is_plain,
        "at_back": standing.at_back,
    }


def _choice(answers: Answers) -> str:
    if answers.approaches_limit:
        return "sought near the limit"
    return "" if answers.fair_size is None else "chosen where the coarser ones leave the answer open"


def _of_run_out(rows, study, answers: Answers) -> dict:
    """What is said of the run-out, whatever the question."""
    run_out, censored = rows["run_out"].values, censored_members(rows)
    limit, volume = float(study.quantities.run_out_limit_m), rows["failure_volume"].values
    fails = (volume > 0.0) | np.isnan(run_out)  # what did not complete may have failed: it counts both ways
    fails &= np.isin(rows["realisation"].values, independent(rows, study)["realisation"].values)
    every = answers.rows_of("run_out")
    ask = {"quantity": "run_out", "limit": limit, "probability": None}
    return {
        "limit": limit,
        "mean_run_out": answers.estimate(every, **ask | {"kind": "mean"}),
        "exceedance": answers.estimate(every, **ask | {"kind": "exceedance"}),
        "failing": answers.estimate(answers.rows_of("failure_volume"), **ask | {"kind": "exceedance", "limit": 0.0}),
        "quantiles": {
            name: answers.estimate(every, **ask | {"kind": "quantile", "probability": p})
            for name, p in (("median", 0.5), ("p95", 0.95))
        },
        "given_failure": {
            "exceedance": estimators.exceedance(run_out[fails], limit, censored[fails], CONFIDENCE),
            "median": estimators.quantile(run_out[fails], 0.5, censored[fails], CONFIDENCE),
        },
        "censored": int(np.sum(censored & ~np.isnan(run_out))),
    }


def _curves(rows, study, answers: Answers) -> dict:
    question = answers.question
    values, censored = rows[question.quantity].values, censored_members(rows, question.quantity)
    counts = _thinned(np.arange(1, values.size + 1))
    running = None
    if question.kind == "exceedance":
        running = estimators.running_exceedance(values, question.limit, censored, CONFIDENCE, counts)
    return {
        "curve": _curve(values, answers),
        "running_mean": estimators.running_mean(values, CONFIDENCE, counts),
        "running_exceedance": running,
        "settling": None if answers.is_plain and question.kind != "quantile" else answers.settling(),
        "inundation_depth": float(study.quantities.inundation_depth_m),
        "inundation": _inundation(independent(rows, study), study),
    }


def _thinned(values: np.ndarray, most: int | None = None) -> np.ndarray:
    """At most so many of the values, evenly spread over their order, the first and the last among them."""
    most = MOST_POINTS if most is None else most
    if values.size <= most:
        return values
    return values[np.linspace(0, values.size - 1, most).round().astype(int)]


def _median_and_worst(values: np.ndarray) -> dict[str, float]:
    sizes = np.abs(values[~np.isnan(values)])
    if not sizes.size:
        return {"median": math.nan, "worst": math.nan}
    return {"median": float(np.median(sizes)), "worst": float(sizes.max())}


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


def _curve(values: np.ndarray, answers: Answers) -> Band | None:
    """The exceedance curve at its steps, or at so many of them, from 0 to a little beyond the last and the limit."""
    steps = np.unique(values[~np.isnan(values)])
    if not steps.size:
        return None
    start, end = min(0.0, steps[0]), 1.15 * max(steps[-1], answers.question.limit or 0.0, 1.0)
    return answers.curve(np.unique([start, *_thinned(steps, None if answers.is_plain else FEWER_POINTS), end]))


def _inundation(rows, study) -> Band | None:
    """P(deposit depth >= asked depth) in every bin beyond the toe; failed realisations count both ways."""
    if "final_surface" not in rows or not rows.sizes["realisation"]:
        return None
    from rfmpm.mpm.scene import ground_height, toe_x

    distance = rows["x"].values - toe_x(study)
    beyond = distance > 0.0
    before = ground_height(study, rows["x"].values[beyond])
    surface, failed = rows["final_surface"].values, np.isnan(rows["run_out"].values)
    n, n_failed = failed.size, int(failed.sum())
    count = np.zeros(int(beyond.sum()), int)
    for start in range(0, n, BLOCK):
        depth = surface[start : start + BLOCK, beyond][~failed[start : start + BLOCK]] - before
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
