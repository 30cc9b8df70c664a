"""How wrong the run-out of the short slope is: time step, numerical constants, cells, and what keeps it from the grid.

`rfmpm benchmark slope` runs the homogeneous slope with three residual cohesions and writes the tables.
"""

from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.convergence import extrapolate
from rfmpm.benchmark.stability.case import SLOPE
from rfmpm.mpm.scene import Scene
from rfmpm.study import Study

RESIDUALS = (4.0, 8.0, 12.0)  # [kPa]
FRACTIONS = (0.1, 0.2, 0.4, 0.8)
CELLS = (0.5, 0.25, 0.125, 0.0625)  # [m]
QUANTITIES = {"run_out": "m", "retrogression_distance": "m", "failure_volume": "m3/m"}
END = 20.0  # [s]
SOFTENING = {
    "scaled modulus": {"softening_reference_cell_m": 0.25},
    "viscosity alone": {"viscosity_kpa_s": 0.3},
    "over a length": {"softening_length_m": 0.5},
    "over a length, and viscosity": {"softening_length_m": 0.5, "viscosity_kpa_s": 0.3},
}
PLAIN = {"softening_reference_cell_m": None, "softening_length_m": None, "viscosity_kpa_s": 0.0}


@dataclass(frozen=True)
class Result:
    """What one run of the slope came to."""

    values: dict[str, float]
    seconds: float
    share: float  # of gravity's work that the numerics took [-]
    unclosed: float  # energy balance error [-]
    restless: float  # kinetic energy at the end over its peak [-]


def run(study: Any, adapt: Callable[[Scene], Scene] = lambda scene: scene, **changes: Any) -> Result:
    """Run the homogeneous slope.

    Args:
        study: the study.
        adapt: changes the scene before the run, for constants that are no keys of a study.
        changes: by path, with `__` for the dots.

    Returns:
        The result.
    """
    changed = study.with_changes({key.replace("__", "."): value for key, value in changes.items()})
    prepared = realisation.prepare(changed)
    prepared = replace(prepared, scene=adapt(prepared.scene))
    outcome = realisation.simulate(prepared, homogeneous=True)
    q, kinetic = outcome.quantities, outcome.history["kinetic_energy"]
    return Result(
        {name: float(q[name]) for name in QUANTITIES},
        outcome.wall_time,
        q["numerical_dissipation_share"],
        q["energy_balance_error"],
        float(kinetic[-1] / kinetic.max()),
    )


def with_controls(**factors: float) -> Callable[[Scene], Scene]:
    """Change of a scene that multiplies numbers of its time integration."""

    def adapt(scene: Scene) -> Scene:
        numbers = {name: getattr(scene.controls, name) for name in factors}
        changed = {name: type(value)(value * factors[name]) for name, value in numbers.items()}
        return replace(scene, controls=scene.controls._replace(**changed))

    return adapt


CONSTANTS = {
    "as it is": {},
    "dissipation time halved": {"dissipation_time": 0.5},
    "dissipation time doubled": {"dissipation_time": 2.0},
    "own share halved": {"own_share": 0.5},
    "own share doubled": {"own_share": 2.0},
    "filter twice as often": {"filter_interval": 0.5},
    "filter half as often": {"filter_interval": 2.0},
    "softening averaged twice as often": {"average_interval": 0.5},
    "softening averaged half as often": {"average_interval": 2.0},
}


def time_step_rows(study: Any, fractions=FRACTIONS) -> Iterator[str]:
    """Rows of the table over the time step."""
    yield "| residual cohesion [kPa] | quantity | " + " | ".join(f"{f:g}" for f in fractions) + " | span |"
    yield "|---" * (len(fractions) + 3) + "|"
    for residual in RESIDUALS:
        results = [
            run(study, material__0__residual_cohesion_kpa=residual, time__step_fraction=fraction)
            for fraction in fractions
        ]
        for name, unit in QUANTITIES.items():
            yield _row(f"{residual:g}", name, unit, [result.values[name] for result in results])
        shares = " | ".join(f"{100 * result.share:.2f} %" for result in results)
        yield f"| | numerical dissipation | {shares} | |"


def constant_rows(study: Any) -> Iterator[str]:
    """Rows of the table over the numerical constants, each halved and doubled."""
    heads = " | ".join(_label(name, unit) for name, unit in QUANTITIES.items())
    yield f"| residual cohesion [kPa] | constant | {heads} |"
    yield "|---" * (len(QUANTITIES) + 2) + "|"
    for residual in RESIDUALS:
        base = None
        for label, factors in CONSTANTS.items():
            result = run(study, with_controls(**factors), material__0__residual_cohesion_kpa=residual)
            base = base or result
            cells = [f"{value:.3f} ({_off(value, base.values[name], 2)})" for name, value in result.values.items()]
            yield f"| {residual:g} | {label} | " + " | ".join(cells) + " |"


def cell_rows(study: Any, cells) -> Iterator[str]:
    """Rows of the table over the cells, with the extrapolated value, its band, and what a run takes."""
    heads = " | ".join(f"{cell:g} m" for cell in cells)
    last = f"last two | extrapolated | order | error at {cells[1]:g} m"
    yield f"| residual cohesion [kPa] | quantity | {heads} | {last} |"
    yield "|---" * (len(cells) + 6) + "|"
    for residual in RESIDUALS:
        results = [
            run(study, material__0__residual_cohesion_kpa=residual, discretisation__cell_m=cell) for cell in cells
        ]
        for name, unit in QUANTITIES.items():
            values = [result.values[name] for result in results]
            limit = extrapolate(values)
            listed = " | ".join(f"{value:.2f}" for value in values)
            order = f"{limit.order:.1f}" if np.isfinite(limit.order) else "none"
            yield (
                f"| {residual:g} | {_label(name, unit)} | {listed} | {_off(values[-1], values[-2])} "
                f"| {limit.value:.2f} ± {limit.band:.2f} | {order} | {_off(values[1], limit.value)} |"
            )
        for label, numbers in (
            ("numerical dissipation", [f"{100 * result.share:.2f} %" for result in results]),
            ("energy not closed", [f"{100 * result.unclosed:.2f} %" for result in results]),
            ("kinetic energy at the end over peak", [f"{result.restless:.1e}" for result in results]),
            ("seconds", [f"{result.seconds:.1f}" for result in results]),
        ):
            yield f"| | {label} | " + " | ".join(numbers) + " | | | | |"


def softening_rows(study: Any, cells) -> Iterator[str]:
    """Rows of the table that compares what may keep softening from following the grid."""
    yield "| softening | quantity | " + " | ".join(f"{cell:g} m" for cell in cells) + " | last two |"
    yield "|---" * (len(cells) + 3) + "|"
    for label, keys in SOFTENING.items():
        changes = {f"material__0__{key}": value for key, value in (PLAIN | keys).items()}
        results = [
            run(study, material__0__residual_cohesion_kpa=8.0, discretisation__cell_m=cell, **changes) for cell in cells
        ]
        for name, unit in QUANTITIES.items():
            values = [result.values[name] for result in results]
            listed = " | ".join(f"{value:.2f}" for value in values)
            yield f"| {label} | {_label(name, unit)} | {listed} | {_off(values[-1], values[-2])} |"


def _off(value: float, reference: float, digits: int = 1) -> str:
    """By how much a value is off, in per cent of the reference; nothing where that is zero."""
    return f"{100.0 * (value / reference - 1.0):+.{digits}f} %" if reference else ""


def _label(name: str, unit: str) -> str:
    return f"{name.replace('_', ' ')} [{unit}]"


def _row(head: str, name: str, unit: str, values: list[float]) -> str:
    span = 100 * np.ptp(values) / max(np.mean(values), 1e-300)
    return f"| {head} | {_label(name, unit)} | " + " | ".join(f"{v:.3f}" for v in values) + f" | {span:.2f} % |"


def slope(quick: bool) -> Study:
    """The homogeneous short slope, the same as in configs/short_slope.toml; coarse and for a second where quick."""
    cell, end = (CELLS[0], 1.0) if quick else (CELLS[1], END)
    return Study(**deepcopy(SLOPE)).with_changes({"discretisation.cell_m": cell, "time.end_s": end})


def write(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Run everything and write the report.

    Args:
        folder: where the report goes; made if missing.
        quick: coarse cells and a short time: a look at the machinery, whose figures mean nothing.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    study, cells = slope(quick), CELLS[:3] if quick else CELLS
    tables = {
        "steps": time_step_rows(study),
        "constants": constant_rows(study),
        "grids": cell_rows(study, cells),
        "softenings": softening_rows(study, cells[:3]),
    }
    texts = {name: "\n".join(_told(rows, tell)) for name, rows in tables.items()}
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "slope_error.md"
    text = TEXT.format(cell=study.discretisation.cell_m, end=study.time.end_s, **texts)
    path.write_text(text, encoding="utf-8")
    return path


def _told(rows: Iterator[str], tell: Callable[[str], None]) -> Iterator[str]:
    for row in rows:
        tell(row)
        yield row


TEXT = """# How wrong is the run-out of the short slope

Made by `rfmpm benchmark slope`: the homogeneous slope of `configs/short_slope.toml`, {end:g} s of model time at most,
cells of {cell:g} m unless another size is given, softening averaged over 0.5 m, viscosity 0.3 kPa s. Spans are largest
minus smallest over the mean.

## Time step, over the critical one

{steps}

## Numerical constants, halved and doubled

{constants}

## Cells

The extrapolated value and its band are Richardson's and Roache's, from the three finest grids; no order means that the
values do not approach from one side, and the band is then three times the last difference.

{grids}

## What keeps softening from following the grid

Residual cohesion 8 kPa; the modulus of 50 kPa is scaled with the cell in the first row alone.

{softenings}
"""
