"""The scenes that come as study files: the short slope and the pile of aluminium bars."""

from dataclasses import replace
from math import nan
from pathlib import Path

import numpy as np

from rfmpm import observer
from rfmpm.benchmark.engine.runs import Measurement, Run, timed
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.energy import kinetic_energy
from rfmpm.quantities import QUANTITIES
from rfmpm.study import Study, StudyError, load_study

REPOSITORY = Path(__file__).parents[3]
SLOPE = REPOSITORY / "configs" / "short_slope.toml"
BARS = REPOSITORY / "configs" / "papers" / "bui_2008_aluminium_bars.toml"
BARS_SURFACE = REPOSITORY / "tests" / "papers" / "bui_2008" / "surface.csv"
RESIDUAL = 12.0  # [kPa]: the slope that slides once and stays in one piece, so that there is something to converge to
SAMPLE, QUIET, REST_SHARE = 0.25, 1.0, 1e-3  # [s], [s], of the largest kinetic energy: at rest
TITLES = {"slope": "Short slope, run-out", "bars": "Aluminium bars, final surface"}
ERRORS = {
    "slope": {"run_out": "difference of the run-out from the extrapolated one [m]"},
    "bars": {"surface": "error of the surface, root mean square [m]"},
}


class Missing(Exception):
    """A scene cannot be run here; says why."""


def slope_study() -> Study:
    """The short slope with a residual cohesion at which it slides once."""
    if not SLOPE.is_file():
        raise Missing(f"{SLOPE.name} is not here: run the benchmark from a clone of the repository")
    return load_study(SLOPE).with_changes({"material.0.residual_cohesion_kpa": RESIDUAL, "time.end_s": 10.0})


def bars_study() -> Study:
    """The pile of aluminium bars."""
    if not BARS.is_file() or not BARS_SURFACE.is_file():
        raise Missing(f"the study {BARS.name} or its surface is not here")
    try:
        return load_study(BARS)
    except StudyError as error:
        raise Missing(f"{BARS.name}: {error}") from None


def measure_slope(study: Study, scheme: Scheme, cell: float, repeats: int) -> tuple[Measurement, float]:
    """Run the slope to its rest. Returns the measurement, without an error yet, and the run-out [m]."""
    cpu_time, run, study = _collapse(study, scheme, cell, repeats)
    value = nan if run.is_broken else float(QUANTITIES["run_out"](_final(run, study)))
    return Measurement("slope", scheme, cell, cpu_time), value


def measure_bars(study: Study, scheme: Scheme, cell: float, repeats: int) -> Measurement:
    """Run the pile and compare its surface with the measured one."""
    cpu_time, run, study = _collapse(study.with_changes({"output.surface_bin_m": cell}), scheme, cell, repeats)
    if run.is_broken:
        return Measurement("bars", scheme, cell, cpu_time, {"surface": nan})
    surface = np.nan_to_num(QUANTITIES["final_surface"](_final(run, study)))
    middle = (np.arange(len(surface)) + 0.5) * cell
    x, y = 1e-3 * np.loadtxt(BARS_SURFACE, delimiter=",", comments="#").T
    error = float(np.sqrt(np.mean((np.interp(x, middle, surface) - y) ** 2)))
    return Measurement("bars", scheme, cell, cpu_time, {"surface": error})


def _collapse(study: Study, scheme: Scheme, cell: float, repeats: int) -> tuple[float, Run, Study]:
    study = study.with_changes(
        {
            "discretisation.cell_m": cell,
            "discretisation.shape": scheme.shape,
            "discretisation.points_per_cell": scheme.points_per_cell,
        }
    )
    scene = scenes.build(study)

    def settle(run: Run) -> None:
        peak = quiet = 0.0
        sample = SAMPLE * study.time.end_s / 10.0
        while run.time < study.time.end_s and not run.is_broken and quiet < QUIET:
            run.until(run.time + sample)
            energy = kinetic_energy(run.points)
            peak = max(peak, energy)
            quiet = quiet + sample if energy < REST_SHARE * peak else 0.0

    cpu_time, run, _ = timed(lambda: Run(scene, scheme), settle, repeats)
    return cpu_time, run, study


def _final(run: Run, study: Study):
    seen = observer.Observer(run.scene, study, run.points, run.history, frames=0)
    return observer.final_state(run.scene, study, seen.points())


def extrapolate(cells: list[float], values: list[float]) -> tuple[float, float]:
    """Richardson: the value on cells of no size from the three finest grids, each half as coarse as the one
    before.

    Returns:
        The value, and its uncertainty: how far it is from the finest grid's. Where the differences do not fall, there
        is no order to go by; then the finest value with the last difference.
    """
    coarse, middle, fine = (value for _, value in sorted(zip(cells, values, strict=True), reverse=True)[-3:])
    before, last = middle - coarse, fine - middle
    if not 0.0 < last * before < 0.9 * before**2:
        return fine, abs(last)
    limit = fine + last / (before / last - 1.0)
    return limit, abs(limit - fine)


def with_errors(measured: list[tuple[Measurement, float]], limit: float) -> list[Measurement]:
    """Give the measurements of the slope their error against a limit [m]."""
    return [replace(one, errors={"run_out": abs(value - limit)}) for one, value in measured]
