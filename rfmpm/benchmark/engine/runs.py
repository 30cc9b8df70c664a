"""One run of a scene by one scheme, whichever solver carries it out."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

from rfmpm.benchmark.engine.schemes import TRANSFERS, Scheme
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.nonlocal_softening import average_softening
from rfmpm.mpm.scene import Scene
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.solvers.reference import ORDERS, Flip, Settings, advance, empty_nodes, still_gradient, wind_up
from rfmpm.mpm.state import RUNNING, start

STEP_FRACTION = 0.5  # of the critical time step, alike for all: stress last breaks at 0.8 with quadratic B-splines
ENOUGH = 1.5  # [s] of CPU time for the repeats of one measurement


@dataclass(frozen=True)
class Measurement:
    """One point of a figure."""

    scene: str
    scheme: Scheme
    cell: float  # [m]
    cpu_time: float  # [s], the least of the repeats; NaN where none was completed
    errors: dict[str, float] = field(default_factory=dict)  # by name; NaN where the run broke


class Run:
    """A scene on its way; `time` and `points` tell where it is.

    Args:
        scene: the scene; its points are copied.
        scheme: how it is solved; its shape is the scene's already.
        body_force: acceleration besides gravity, for the plain solver only.
        threads: that share every step, for the production engine only.
    """

    def __init__(self, scene: Scene, scheme: Scheme, body_force: Any = None, threads: int = 1):
        self.scene, self.body_force, self.threads = scene, body_force, threads
        self.transfer, dissipation_time = TRANSFERS[scheme.transfer]
        self.order = scheme.order
        self.own = scenes.release(scene, None)
        self.points, self.law, self.history = self.own.points, self.own.law, self.own.history
        controls = scene.controls._replace(dissipation_time=dissipation_time, courant=STEP_FRACTION)
        self.is_plain = scheme.engine == "plain"
        if self.is_plain:
            interval = 1 if dissipation_time == 0.0 else controls.filter_interval
            settings = Settings(**{name: getattr(controls, name) for name in Settings._fields})
            self.controls = settings._replace(filter_interval=interval)
            self.carried = None if isinstance(self.transfer, Flip) else still_gradient(len(self.points.mass))
            self.grid = empty_nodes(scene.axes)
            self.next_average = scene.controls.average_interval
            self.now = wind_up(self.points, self.law, self.history, scene.axes, self.grid)
        else:
            # Rest does not end a run that is to be compared, nor energy that a scene starts with; a blow-up does.
            self.controls = controls._replace(
                rest_time=inf,
                energy_scale=float(self.points.mass.sum()) * controls.wave_speed**2,
            )
            self.now = start()

    @property
    def time(self) -> float:
        """Model time [s]."""
        return self.now.time

    @property
    def is_broken(self) -> bool:
        """Whether a point has left the grid or is no number."""
        return self.now.lost >= 0 if self.is_plain else self.now.status != RUNNING

    def until(self, end: float, gravity: float | None = None) -> None:
        """Advance to a model time [s], or a step further; under another gravity [m/s2] if given."""
        scene = self.scene
        if gravity is not None:
            self.controls = self.controls._replace(gravity=gravity)
        if self.is_plain:
            self._until_plainly(end)
        else:
            arguments = scenes.arguments(replace(scene, controls=self.controls), self.own, self.threads)
            self.now = SOLVERS["explicit"](self.now, end, *arguments)

    def _until_plainly(self, end: float) -> None:
        """Advance the plain solver, and average the softening in between where it has a length."""
        scene, averaging = self.scene, self.own.averaging
        stop = end if averaging is None else min(end, self.next_average)
        while True:
            self.now = advance(
                self.now, stop, self.points, self.carried, self.law, self.history, scene.axes, self.grid, scene.walls,
                self.transfer, ORDERS[self.order], self.controls, self.body_force,
            )  # fmt: skip
            if self.is_broken or stop >= end:
                return
            average_softening(self.points, self.history, scene.axes, averaging, whole_grid(scene.axes))
            self.next_average = self.now.time + scene.controls.average_interval
            stop = min(end, self.next_average)


def whole_grid(axes) -> tuple[int, int, int, int]:
    """First and last column, first and last row."""
    return 0, axes.x.cells, 0, axes.y.cells


def timed(make: Callable[[], Run], drive: Callable[[Run], Any], repeats: int) -> tuple[float, Run, Any]:
    """Drive a run several times.

    Args:
        make: makes the run, not timed.
        drive: drives it to its end.
        repeats: how often at most; no more where the run breaks, or after ENOUGH seconds.

    Returns:
        Least CPU time of this process [s], the last run, and what `drive` returned last.
    """
    make().until(0.0)  # compiles
    least, total = inf, 0.0
    for _ in range(repeats):
        run = make()
        started = time.process_time()
        found = drive(run)
        spent = time.process_time() - started
        least, total = min(least, spent), total + spent
        if run.is_broken or total > ENOUGH:
            break
    return least, run, found
