"""One realisation: from (study, level, index) to one row; the only place where fields and mechanics meet."""

import time
from collections.abc import Callable
from dataclasses import replace
from math import inf, nan
from typing import Any

import numpy as np

from rfmpm.initial_state import begin, refuse_large
from rfmpm.kernel_tools import start_threads
from rfmpm.motion import Motion
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import RUNNING, start
from rfmpm.observer import Observer
from rfmpm.outcome import Outcome, measure, verdict
from rfmpm.preparation import Prepared, draw_xi, drawn, prepare, prepare_fields, realise_fields
from rfmpm.random_fields import properties as random_properties
from rfmpm.random_fields.property import Properties
from rfmpm.stability import METHODS, Strength, strength_of
from rfmpm.study import StudyError
from rfmpm.uncertainty import values
from rfmpm.variables import STATUS, failed_row

__all__ = [
    "Prepared",
    "as_row",
    "compile_kernels",
    "draw_xi",
    "drawn",
    "initial_balance",
    "prepare",
    "prepare_fields",
    "realise_fields",
    "residual_above_peak",
    "run",
    "simulate",
    "stability",
    "threads_for",
    "typical_strengths",
    "uncertain_values",
]

WORTH_SHARING = 20_000  # points from which threads that share a step gain more than they wait for each other


class OutOfTime(Exception):
    """Raised where a realisation takes longer than it may."""


def compile_kernels(prepared: Prepared, threads: int = 1) -> None:
    """Compile what the study needs, or load it from the cache, so that no realisation has to."""
    scene = prepared.scene
    advance = SOLVERS[prepared.study.time.scheme]
    own = scenes.release(scene, typical_strengths(prepared))
    advance(start(), 0.0, *scenes.arguments(scene, own, threads))
    _factor(prepared, typical_strengths(prepared))


def threads_for(prepared: Prepared) -> int:
    """How many threads a single realisation is worth: all cores for a large scene, else one."""
    return start_threads() if len(prepared.scene.points.mass) >= WORTH_SHARING else 1


def typical_strengths(prepared: Prepared) -> dict[str, np.ndarray]:
    """Mean of each random property at every point, shape (n,) each; kernels compile for what is random."""
    return random_properties.means(prepared.properties, len(prepared.scene.points.mass))


def residual_above_peak(prepared: Prepared, fields: dict[str, np.ndarray]) -> float | None:
    """Share of points whose random residual cohesion lies above their peak, so that the laws take the peak for it.

    Args:
        prepared: the prepared study.
        fields: of one realisation, as from `realise_fields`.

    Returns:
        the share [-]; None where the residual cohesion is not random.
    """
    if "residual_cohesion" not in fields:
        return None
    peak = fields.get("cohesion", own_cohesion(prepared.scene))
    above = fields["residual_cohesion"] > peak
    own = [above[one.where] for one in prepared.fields.values() if one.name == "residual_cohesion"]
    return float(np.mean(np.concatenate(own)))


def own_cohesion(scene: scenes.Scene) -> np.ndarray:
    """Peak cohesion of the materials at their points, shape (n,) [Pa]; NaN where a law has none."""
    values = [getattr(material, "cohesion_kpa", nan) * 1e3 for material in scene.soils.materials]
    return scene.soils.of_each(values)


def run(
    prepared: Prepared,
    index: int,
    level: int = 0,
    xi: np.ndarray | None = None,
    watch: Callable[[], None] | None = None,
) -> dict[str, Any]:
    """Simulate one realisation and make its row.

    Args:
        prepared: the prepared study.
        index: of the realisation.
        level: of the plan.
        xi: standard-normal vector, shape (n_variables,); None draws it from the stream of (seed, level, index).
        watch: called every now and then; what it raises ends the run and is passed on.

    Returns:
        Every active variable by name; a failure, by the numerics, by `failures.realisation_time_limit_s` or because the
        study is wrong at the values of its uncertain numbers, is a status with a reason, and its quantities are NaN.
    """
    limit = prepared.study.failures.realisation_time_limit_s or inf
    started = time.perf_counter()

    def look() -> None:
        if time.perf_counter() - started > limit:
            raise OutOfTime
        if watch is not None:
            watch()

    xi = draw_xi(prepared, index, level) if xi is None else xi
    try:
        outcome = _simulate(prepared, xi, frames=0, threads=1, look=look, keep_motion=False)
    except OutOfTime:
        reason = f"took longer than failures.realisation_time_limit_s = {limit:g} s"
        row = failed_row(prepared.study, index, "timeout", reason, level, time.perf_counter() - started)
    except StudyError as error:
        reason = "; ".join(error.problems)
        row = failed_row(prepared.study, index, "refused", reason, level, time.perf_counter() - started)
    else:
        return as_row(outcome, index, level)
    return row | uncertain_values(prepared, xi)


def uncertain_values(prepared: Prepared, xi: np.ndarray) -> dict[str, np.ndarray]:
    """What a row says about the uncertain numbers: their values, shape (k,); nothing where there are none."""
    return {"uncertain_value": values(prepared.uncertain, xi)} if prepared.uncertain else {}


def as_row(outcome: Outcome, index: int, level: int = 0) -> dict[str, Any]:
    """Make the row of a simulated realisation: every active variable by name."""
    return outcome.quantities | {
        "realisation": index,
        "level": level,
        "status": STATUS[outcome.status],
        "status_reason": outcome.reason,
        "step_count": outcome.step_count,
        "wall_time": outcome.wall_time,
    }


def simulate(
    prepared: Prepared,
    index: int = 0,
    level: int = 0,
    frames: int = 0,
    homogeneous: bool = False,
    xi: np.ndarray | None = None,
    threads: int = 1,
) -> Outcome:
    """Simulate one realisation and keep its points, histories and, if asked, snapshots.

    Args:
        prepared: the prepared study.
        index: of the realisation.
        level: of the plan.
        frames: snapshots, evenly spread over the time up to rest; 0 for none.
        homogeneous: leave the random fields out, and take the study's own value of what is uncertain.
        xi: as for `run`.
        threads: that share every step; results of more than one differ by rounding from the row of a campaign, which
            gives each realisation one thread.

    Returns:
        The outcome.

    Raises:
        StudyError: if there are no threads, or more than points; if the study is wrong at the values of its uncertain
            numbers.
    """
    most = len(prepared.scene.points.mass)
    if not 1 <= threads <= most:
        raise StudyError([f"threads = {threads}: must be between 1 and {most}, the number of points"])
    if homogeneous:
        prepared, xi = _without_chance(prepared), None
    compile_kernels(prepared, threads)
    return _simulate(prepared, draw_xi(prepared, index, level) if xi is None else xi, frames, threads)


def initial_balance(prepared: Prepared) -> float:
    """What is out of balance at the start, with typical strengths.

    Args:
        prepared: the prepared study.

    Returns:
        Unbalanced over gravity's forces on the nodes [-].

    Raises:
        StudyError: if it is large, unless strength varies or soil is cut away: neither is a fault of the study's.
    """
    scene = prepared.scene
    own = scenes.release(scene, typical_strengths(prepared))
    _, _, ratio = begin(prepared.study, scene, own, start(), threads=1)
    if not prepared.n_variables and prepared.scene.removed is None:
        refuse_large(prepared.study, ratio)
    return ratio


def stability(
    prepared: Prepared,
    method: str,
    index: int = 0,
    level: int = 0,
    homogeneous: bool = False,
    xi: np.ndarray | None = None,
) -> tuple[Any, Strength]:
    """Find the factor of safety of one realisation; nothing is simulated.

    Args:
        prepared: the prepared study.
        method: a name of `METHODS`.
        index: of the realisation.
        level: of the plan.
        homogeneous: as for `simulate`.
        xi: as for `run`.

    Returns:
        The method's record, with the `factor`, and the strength of the material points.

    Raises:
        StudyError: if the soil has no strength or the ground is level; if the study is wrong at the values of its
            uncertain numbers.
    """
    if homogeneous:
        prepared, xi = _without_chance(prepared), None
    own, of_fields = drawn(prepared, draw_xi(prepared, index, level) if xi is None else xi)
    fields = random_properties.realise(own.properties, of_fields)
    try:
        return METHODS[method](own, fields), strength_of(own, fields)
    except ValueError as error:
        raise StudyError([str(error)]) from None


def _without_chance(prepared: Prepared) -> Prepared:
    return replace(prepared, properties=Properties({}, None), uncertain=())


def _factor(prepared: Prepared, fields: dict[str, np.ndarray]) -> dict[str, float]:
    method = prepared.study.quantities.safety_method
    if method is None:
        return {}
    factor = METHODS[method](prepared, fields).factor
    return {"factor_of_safety": factor if factor < inf else nan}


def _simulate(
    prepared: Prepared,
    xi: np.ndarray,
    frames: int,
    threads: int,
    look: Callable[[], None] = lambda: None,
    keep_motion: bool = True,
) -> Outcome:
    started = time.perf_counter()
    at_values, of_fields = drawn(prepared, xi)
    study, scene = at_values.study, at_values.scene
    fields = random_properties.realise(at_values.properties, of_fields)
    own, now = scenes.release(scene, fields), start()
    balance = {}
    if study.time.initial_stress != "elastic":
        scene, now, balance["out_of_balance"] = begin(study, scene, own, now, threads)
        if not prepared.n_variables and prepared.scene.removed is None:
            refuse_large(study, balance["out_of_balance"])
    advance, arguments = SOLVERS[study.time.scheme], scenes.arguments(scene, own, threads)
    motion = Motion(study, own.points) if keep_motion and study.history else None
    observer, end = Observer(scene, study, own.points, own.history, frames, motion, own.obstacle), study.time.end_s
    while now.status == RUNNING and now.time < end:
        look()
        now = advance(now, min(observer.next_look, end), *arguments)
        observer.look(now, is_over=now.status != RUNNING or now.time >= end)
    final = observer.points()
    status, reason = verdict(now, study, scene, final)
    final |= {"cohesion": own_cohesion(scene)} | fields
    quantities = measure(study, scene, own, final, observer, now, status) | uncertain_values(prepared, xi)
    quantities |= _factor(at_values, fields) | balance
    return Outcome(
        quantities,
        status,
        reason,
        now.step_count,
        time.perf_counter() - started,
        final,
        {name: np.array(values) for name, values in observer.history.items()},
        observer.kept_frames(),
        motion.history() if motion else {},
    )
