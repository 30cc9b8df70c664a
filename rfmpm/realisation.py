"""One realisation: from (study, level, index) to one row; the only place where fields and mechanics meet."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, nan, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import seeds
from rfmpm.kernel_tools import start_threads
from rfmpm.mpm import geometry
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import RUNNING, start
from rfmpm.observer import Observer
from rfmpm.outcome import Outcome, measure, verdict
from rfmpm.random_fields import properties as random_properties
from rfmpm.study import StudyError
from rfmpm.variables import STATUS, failed_row

WORTH_SHARING = 20_000  # points from which threads that share a step gain more than they wait for each other


class OutOfTime(Exception):
    """Raised where a realisation takes longer than it may."""


@dataclass(frozen=True)
class Prepared:
    """What realisations of one study share."""

    study: Any
    scene: scenes.Scene
    properties: random_properties.Properties

    @property
    def fields(self) -> dict[str, random_properties.Property]:
        """The random properties by name."""
        return self.properties.entries


def prepare(study, store: Path | None = None) -> Prepared:
    """Make what all realisations of a study share: the scene, its initial stresses, the factor of its fields.

    Args:
        study: the study.
        store: folder in which the factor is kept for other processes; None keeps it in memory.

    Returns:
        The prepared study.

    Raises:
        OSError: if the store cannot be written.
        StudyError: if a field cannot be made as asked, or its data contradict what is asked.
    """
    scene = scenes.build(study)
    points = np.column_stack(scene.points.position)
    return Prepared(study, scene, _properties(study, scene.body, points, store))


def prepare_fields(study) -> random_properties.Properties:
    """Prepare the random fields of a study alone, without the scene in which they vary.

    Raises:
        StudyError: as for `prepare`.
    """
    shape = geometry.body(study)
    points, _ = geometry.fill(shape.outline, study.discretisation.cell_m, study.discretisation.points_per_cell)
    return _properties(study, shape, points, None)


def _properties(study, shape: geometry.Body, points: np.ndarray, store: Path | None) -> random_properties.Properties:
    try:
        return random_properties.prepare(study, _site(study, shape, points), store)
    except ValueError as error:
        raise StudyError([str(error)]) from None


def compile_kernels(prepared: Prepared, threads: int = 1) -> None:
    """Compile what the study needs, or load it from the cache, so that no realisation has to."""
    scene = prepared.scene
    advance = SOLVERS[prepared.study.time.scheme]
    own = scenes.release(scene, typical_strengths(prepared))
    advance(start(), 0.0, *scenes.arguments(scene, own, threads))


def threads_for(prepared: Prepared) -> int:
    """How many threads a single realisation is worth: all cores for a large scene, else one."""
    return start_threads() if len(prepared.scene.points.mass) >= WORTH_SHARING else 1


def typical_strengths(prepared: Prepared) -> dict[str, np.ndarray]:
    """Mean of each random property at every point, shape (n,) each; kernels compile for what is random."""
    return random_properties.means(prepared.properties, len(prepared.scene.points.mass))


def draw_xi(prepared: Prepared, index: int, level: int = 0) -> np.ndarray:
    """Draw the vector `xi` of one realisation from the stream of (seed, level, index), shape (n_variables,) [-]."""
    return seeds.standard_normal(prepared.study.study.seed, level, index, prepared.properties.n_variables)


def realise_fields(study, index: int, level: int = 0, xi: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Make the random fields of one realisation alone.

    Args:
        study: the study.
        index: of the realisation.
        level: of the plan.
        xi: standard-normal vector, shape (n_variables,); None draws it from the stream of (seed, level, index).

    Returns:
        Field by name, shape (n,) each, in SI units; empty for a homogeneous study.

    Raises:
        ValueError: if `xi` has another length than the study's fields take.
    """
    return _fields(prepare(study), index, level, xi)


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
    peak = fields.get("cohesion", prepared.scene.material.cohesion_kpa * 1e3)
    return float(np.mean(fields["residual_cohesion"] > peak))


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
        Every active variable by name; a failure, by the numerics or by `failures.realisation_time_limit_s`, is a status
        with a reason, and its quantities are NaN.
    """
    limit = prepared.study.failures.realisation_time_limit_s or inf
    started = time.perf_counter()

    def look() -> None:
        if time.perf_counter() - started > limit:
            raise OutOfTime
        if watch is not None:
            watch()

    try:
        outcome = _simulate(prepared, _fields(prepared, index, level, xi), frames=0, threads=1, look=look)
    except OutOfTime:
        reason = f"took longer than failures.realisation_time_limit_s = {limit:g} s"
        return failed_row(prepared.study, index, "timeout", reason, level, time.perf_counter() - started)
    return as_row(outcome, index, level)


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
        homogeneous: leave the random fields out.
        xi: as for `run`.
        threads: that share every step; results of more than one differ by rounding from the row of a campaign, which
            gives each realisation one thread.

    Returns:
        The outcome.

    Raises:
        StudyError: if there are no threads, or more than points.
    """
    most = len(prepared.scene.points.mass)
    if not 1 <= threads <= most:
        raise StudyError([f"threads = {threads}: must be between 1 and {most}, the number of points"])
    if homogeneous:
        prepared = replace(prepared, properties=random_properties.Properties({}, None))
        xi = None
    compile_kernels(prepared, threads)
    return _simulate(prepared, _fields(prepared, index, level, xi), frames, threads)


def _fields(prepared: Prepared, index: int, level: int, xi: np.ndarray | None) -> dict[str, np.ndarray]:
    return random_properties.realise(prepared.properties, draw_xi(prepared, index, level) if xi is None else xi)


def _site(study, body: geometry.Body, points: np.ndarray) -> random_properties.Site:
    """Where the fields of a study are needed; a slope is at least four cells high, so no square reaches further."""
    cell = study.discretisation.cell_m
    beyond = 0.25 * body.height if body.toe > body.crest_edge else 0.0
    return random_properties.Site(
        points,
        cell,
        cell / sqrt(study.discretisation.points_per_cell),
        body.height,
        (body.toe + beyond, body.height),
    )


def _simulate(
    prepared: Prepared,
    fields: dict[str, np.ndarray],
    frames: int,
    threads: int,
    look: Callable[[], None] = lambda: None,
) -> Outcome:
    started = time.perf_counter()
    study, scene = prepared.study, prepared.scene
    own, now = scenes.release(scene, fields), start()
    advance, arguments = SOLVERS[study.time.scheme], scenes.arguments(scene, own, threads)
    observer = Observer(scene, study, own.points, own.history, frames)
    while now.status == RUNNING and now.time < study.time.end_s:
        look()
        until = min(observer.next_sample, study.time.end_s)
        now = advance(now, until, *arguments)
        observer.sample(now)
    final = observer.points()
    status, reason = verdict(now, study, scene, final)
    cohesion = {"cohesion": np.full(final["x"].shape, getattr(scene.material, "cohesion_kpa", nan) * 1e3)}
    final |= cohesion | fields
    quantities = measure(study, scene, own, final, observer, now, status)
    return Outcome(
        quantities,
        status,
        reason,
        now.step_count,
        time.perf_counter() - started,
        final,
        {name: np.array(values) for name, values in observer.history.items()},
        observer.kept_frames(),
    )
