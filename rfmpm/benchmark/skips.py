"""Each thing that a scene does not need and the program skips, measured by doing it all the same."""

import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.field_cost import prepare_field, realise_field, without_fields
from rfmpm.benchmark.stability.case import SLOPE, random_strength
from rfmpm.kernel_tools import Tensor
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.initial_stress import elastic_gravity_stress
from rfmpm.mpm.laws.elastic import hooke
from rfmpm.mpm.soils import soils_of
from rfmpm.mpm.solvers import advance
from rfmpm.mpm.solvers.grid import clear, update_grid
from rfmpm.mpm.state import start
from rfmpm.realisation import Prepared
from rfmpm.study import Study

HEAVY = "import numba, scipy, xarray, netCDF4, pandas, matplotlib.figure, mpi4py, jinja2; "
FRAMES = 60
STILL = 1e-3  # [m] of movement, and of plastic strain [-]
CALLS = 200


class PerfectlyPlastic(NamedTuple):
    """Von Mises plasticity without softening and without history (radial return)."""

    lame: float  # [Pa]
    shear: float  # [Pa]
    cohesion: float  # [Pa]

    def update_stress(self, stress, strain_increment, history, dt):
        """Elastic predictor, return to sqrt(J2) = c."""
        trial = hooke(self.lame, self.shear, stress, strain_increment)
        mean = (trial.xx + trial.yy + trial.zz) / 3.0
        sxx, syy, szz = trial.xx - mean, trial.yy - mean, trial.zz - mean
        j2 = 0.5 * (sxx * sxx + syy * syy + szz * szz) + trial.xy * trial.xy
        if j2 <= self.cohesion * self.cohesion:
            return trial, history
        scale = self.cohesion / sqrt(j2)
        return Tensor(mean + scale * sxx, mean + scale * syy, mean + scale * szz, scale * trial.xy), history


@dataclass(frozen=True)
class Saving:
    """One thing that is skipped."""

    what: str
    skipped: float  # [s] as the program does it
    done: float  # [s] with the needless work
    remark: str = ""


class Bench:
    """A slope with a random strength, and the same slope without one, prepared."""

    def __init__(self, cell: float, end: float, repeats: int):
        self.repeats = repeats
        changes = {
            "discretisation.cell_m": cell,
            "time.end_s": end,
            "random_field.cohesion": random_strength(0.25, 6.0, 1.0),
        }
        self.study = Study(**SLOPE).with_changes(changes)
        self.random = realisation.prepare(self.study)
        self.plain = without_fields(self.random)
        self.outcome = realisation.simulate(self.plain)

    def least(self, *works: Callable[[], Any]) -> tuple[float, ...]:
        """The least time of each work [s]; they take turns, so that a busy machine slows all of them alike."""
        rounds = [[_seconds(work) for work in works] for _ in range(self.repeats)]
        return tuple(min(times) for times in zip(*rounds, strict=True))

    def simulate(self) -> None:
        """One realisation as the program does it."""
        realisation.simulate(self.plain)

    def of_residual(self, residual: float) -> Prepared:
        """The slope without a random strength, with another residual cohesion [kPa]."""
        study = self.study.with_changes({"material.0.residual_cohesion_kpa": residual})
        return replace(
            self.plain,
            study=study,
            scene=replace(self.plain.scene, soils=soils_of(study, self.plain.scene.soils.counts)),
        )


def with_controls(prepared: Prepared, **changes) -> Prepared:
    """The same with other numbers of the time integration."""
    return replace(prepared, scene=replace(prepared.scene, controls=prepared.scene.controls._replace(**changes)))


def _seconds(work: Callable[[], Any]) -> float:
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


def untouched_cells(bench: Bench) -> Saving:
    """The grid's work over the nodes that points touch, and over all of them."""
    scene = bench.plain.scene
    own = scenes.release(scene, None)
    grid, now = own.grid, advance(start(), 0.1, *scenes.arguments(scene, own))
    rows, columns = grid.mass.shape
    touched = now.first_column, now.last_column, now.first_row, now.last_row

    def sweep(box):
        for _ in range(CALLS):
            update_grid(grid, scene.walls, box, 0.0, 0.0, 0.0, 1e-9)
            clear(grid.sums, box)
            clear(grid.parts, box)

    whole = 0, columns - 1, 0, rows - 1
    skipped, tight, wide = bench.least(bench.simulate, lambda: sweep(touched), lambda: sweep(whole))
    done = skipped + (wide - tight) * bench.outcome.step_count / CALLS
    share = (touched[1] - touched[0] + 1) * (touched[3] - touched[2] + 1) / (rows * columns)
    remark = f"{100 * share:.0f} % of the nodes are touched at the start"
    return Saving("grid cells that no point touches", skipped, done, remark)


def shared_stress(bench: Bench) -> Saving:
    """The elastic solve for the initial stresses, once for each realisation."""
    scene = bench.plain.scene
    position = np.column_stack(scene.points.position)

    def solve():
        elastic_gravity_stress(
            position, scene.points.mass, scene.points.volume, scene.axes, scene.walls, scene.lame, scene.shear, 9.81,
            scene.cell_means,
        )  # fmt: skip

    skipped, extra = bench.least(bench.simulate, solve)
    return Saving("initial stresses shared by an ensemble", skipped, skipped + extra, "per realisation")


def shared_factor(bench: Bench) -> Saving:
    """The factor of the correlation matrix, once for each realisation."""
    skipped, extra = bench.least(lambda: realisation.simulate(bench.random), lambda: prepare_field(bench.random))
    return Saving("factor of the field shared by an ensemble", skipped, skipped + extra, "per realisation")


def no_field(bench: Bench) -> Saving:
    """A homogeneous slope that makes a field all the same, with the factor at hand."""
    skipped, extra = bench.least(bench.simulate, lambda: realise_field(bench.random))
    return Saving("no field code for a homogeneous slope", skipped, skipped + extra)


def stop_at_rest(bench: Bench, residual: float) -> Saving:
    """On to the end of the study's time, at rest or not."""
    plain = bench.of_residual(residual)
    rest = realisation.simulate(plain).history["time"][-1]
    times = bench.least(
        lambda: realisation.simulate(plain), lambda: realisation.simulate(with_controls(plain, rest_time=inf))
    )
    remark = f"at rest or at its end after {rest:.3g} s of {plain.study.time.end_s:g} s"
    return Saving(f"no steps after rest, residual cohesion {residual:g} kPa", *times, remark)


def damp_what_swings(bench: Bench, residual: float) -> Saving:
    """Waiting until what swings elastically after the last flow has come to rest by itself."""
    plain = bench.of_residual(residual)
    swinging = with_controls(plain, settling_rate=0.0)
    settled, rung = realisation.simulate(plain), realisation.simulate(swinging)
    times = bench.least(lambda: realisation.simulate(plain), lambda: realisation.simulate(swinging))
    moved = 1e3 * abs(settled.quantities["run_out"] - rung.quantities["run_out"])
    ends = [outcome.history["time"][-1] for outcome in (settled, rung)]
    remark = f"ends after {ends[0]:.3g} instead of {ends[1]:.3g} s; run-out differs by {moved:.1f} mm"
    return Saving(f"swinging after the last flow damped, residual cohesion {residual:g} kPa", *times, remark)


def step_of_the_moment(bench: Bench) -> Saving:
    """One step for the whole run, that of its fastest moment."""
    scene, fastest = bench.plain.scene, 0.0
    arguments, now = scenes.arguments(scene, scenes.release(scene, None)), start()
    while now.time < bench.outcome.history["time"][-1]:
        now = advance(now, now.time + 0.05, *arguments)
        fastest = max(fastest, now.fastest)
    controls = scene.controls
    steps = now.time * (controls.wave_speed + fastest) / (controls.courant * controls.cell)
    (skipped,) = bench.least(bench.simulate)
    remark = f"{steps:,.0f} steps instead of {now.step_count:,}, time in proportion"
    return Saving("a step as large as the moment allows", skipped, skipped * steps / now.step_count, remark)


def filter_at_intervals(bench: Bench) -> Saving:
    """The filter of the transfer at every step."""
    times = bench.least(bench.simulate, lambda: realisation.simulate(with_controls(bench.plain, filter_interval=1)))
    remark = f"every {bench.plain.scene.controls.filter_interval} steps against every step"
    return Saving("filter at intervals, at the same rate", *times, remark)


def no_snapshots(bench: Bench) -> Saving:
    """Snapshots that nobody asked for."""
    times = bench.least(bench.simulate, lambda: realisation.simulate(bench.plain, frames=FRAMES))
    return Saving("no snapshot arrays unless asked", *times, f"against {FRAMES} snapshots")


def no_history(bench: Bench) -> Saving:
    """Perfect plasticity with the history of the softening law, and without."""
    law = bench.study.material[0].model_copy(update={"softening_modulus_kpa": 0.0, "cohesion_kpa": 10.0,
                                                     "residual_cohesion_kpa": 10.0})  # fmt: skip
    scene = replace(bench.plain.scene, soils=bench.plain.scene.soils._replace(materials=(law,)))

    def steps(is_bare: bool):
        own = scenes.release(scene, None)._replace(averaging=None)
        if is_bare:
            own = own._replace(law=PerfectlyPlastic(own.law.lame, own.law.shear, 10e3), history=None)
        advance(start(), 2.0, *scenes.arguments(scene, own))

    steps(True)
    bare, full = bench.least(lambda: steps(True), lambda: steps(False))
    remark = "not skipped today: the plastic strain of the history is a result (blocks, pictures)"
    return Saving("no softening history for perfect plasticity", bare, full, remark)


def light_command(bench: Bench, arguments: list[str]) -> Saving:
    """A command with every library loaded."""
    call = f"import sys; sys.argv = ['rfmpm'] + {arguments!r}; from rfmpm.cli import main; main()"

    def start_process(code: str):
        subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.DEVNULL)

    light, heavy = bench.least(lambda: start_process(call), lambda: start_process(HEAVY + call))
    return Saving(f"imports that `rfmpm {' '.join(arguments[:1])}` does not use", light, heavy, f"{light:.2f} s")


def quiet_regions(bench: Bench) -> str:
    """What would be saved at most by leaving out points that neither yield nor move, in words."""
    lines = []
    for residual in (4.0, 8.0, 12.0):
        study = Study(**SLOPE).with_changes(
            {
                "discretisation.cell_m": bench.study.discretisation.cell_m,
                "time.end_s": bench.study.time.end_s,
                "material.0.residual_cohesion_kpa": residual,
            }
        )
        points = realisation.simulate(realisation.prepare(study)).points
        moved = np.hypot(points["displacement_x"], points["displacement_y"])
        share = np.mean((moved < STILL) & (points["plastic_strain"] < STILL))
        lines.append(f"{100 * share:.0f} % at a residual cohesion of {residual:g} kPa")
    return ", ".join(lines)
