"""The engine against exact and measured answers: `rfmpm benchmark verification` writes the table."""

import time
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import replace
from math import cos, inf, pi, radians, sin, tan
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.engine import bar, column, slopes, vortex
from rfmpm.benchmark.engine.blocks import elastic_block
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.benchmark.stability.case import SLOPE
from rfmpm.kernel_tools import Tensor, Vector
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import advance
from rfmpm.mpm.stages import rotate
from rfmpm.mpm.state import start
from rfmpm.study import Study

FAST, PLAIN = Scheme("quadratic_bspline", engine="fast"), Scheme("quadratic_bspline")
GRAVITY = scenes.GRAVITY
INCLINE, FRICTION = radians(24.0), tan(radians(15.0))
TAYLOR = 6.12  # stability number of a 45 degree slope on a firm base at the toe (Taylor 1937)


class Row(NamedTuple):
    """One line of the table."""

    test: str
    setting: str
    exact: str
    ours: str
    order: str = ""


def ladder(measure: Callable[[int], float], counts) -> tuple[str, str]:
    """Errors on so many cells in words, and the slope fitted through them."""
    errors = [measure(count) for count in counts]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    return ", ".join(f"{error:.2g} ({count})" for count, error in zip(counts, errors, strict=True)), f"{order:.2f}"


def self_weight(quick: bool) -> Row:
    """Column compressed by its own weight."""
    counts = (5, 10) if quick else (10, 20, 40, 80, 160, 320)
    ours, order = ladder(lambda cells: column.measure(FAST, cells, 1).errors["stress"], counts)
    return Row("column under self-weight, large strain", "50 m, E 1 MPa, nu 0; cells", "rho0 g (l0 - Y)", ours, order)


def elastic_column(quick: bool) -> Row:
    """Stress at the base of an elastic column."""

    def error(cells: int) -> float:
        cell = 0.1 / cells
        points = scenes.build(elastic_block(3.0 * cell, 0.1, cell, "quadratic_bspline", 4, 1800.0, 1e6, 0.0)).points
        depth = 0.1 - points.position.y
        low = depth > depth.max() - 0.6 * cell
        exact = -1800.0 * GRAVITY * depth[low]
        return float(abs(points.stress.yy[low].mean() / exact.mean() - 1.0))

    ours, order = ladder(error, (10, 20) if quick else (10, 20, 40))
    return Row("elastic column, gravity", "0.1 m, rho 1800, nu 0; lowest points", "-rho g H", ours, order)


def vibration(quick: bool) -> Iterator[Row]:
    """Axial vibration of a bar."""
    counts, periods = ((4, 8), 3) if quick else ((8, 16, 32), 100)
    found = {cells: bar.measure(FAST, cells, 1, periods).errors for cells in counts}
    for name, label in (("phase", "phase error per period"), ("energy", "energy lost per period")):
        ours, order = ladder(lambda cells, name=name: found[cells][name], counts)
        yield Row(
            f"axial vibration of an elastic bar: {label}", f"first mode, {periods} periods; cells", "0", ours, order
        )


def swirl(quick: bool) -> Row:
    """Generalised vortex, on the plain solver, which knows body forces."""
    counts = (13,) * 2 if quick else (26, 52, 104)
    if quick:
        return Row("generalised vortex", "not in the quick run", "", "")
    ours, order = ladder(lambda cells: vortex.measure(PLAIN, cells, 1).errors["position"], counts)
    return Row("generalised vortex (plain solver)", "R 0.75 to 1.25; position in m, cells", "manufactured", ours, order)


def rotation(quick: bool) -> Row:
    """A stressed block turned once round: what the rotation of the stress alone leaves."""
    stress = Tensor(*(np.array([value]) for value in (3e3, -1e3, 500.0, 2e3)))
    before, steps = [float(component[0]) for component in stress], 720
    half = tan(pi / steps)  # of the angle of one step: the skew part that the polar decomposition turns by it
    gradient = np.array([0.0, -half, half, 0.0])
    for _ in range(steps):
        rotate(stress, gradient, 1.0)
    off = max(abs(float(component[0]) - value) for component, value in zip(stress, before, strict=True))
    return Row("rigid rotation", f"one turn in {steps} steps", "the same stress", f"{off / 3e3:.1g} of the stress")


def sliding(quick: bool) -> Row:
    """A block that slides down an incline: weight and slope as seen from the incline.

    It starts with the shear that friction causes in it, else it takes a millisecond of elastic shearing to begin.
    """
    cell, until = 0.0125, 0.1 if quick else 1.0
    block = elastic_block(0.1, 0.05, cell, "quadratic_bspline", 4, 1000.0, 1e6, 0.3)
    study = block.with_changes(
        {
            "geometry.foreland_m": 1.5,
            "boundary.base": {"kind": "friction", "coefficient": FRICTION},
            "time.step_fraction": 0.4,
        }
    )
    scene = scenes.build(study)
    first = scene.points
    first = first._replace(stress=Tensor(*(cos(INCLINE) * component for component in first.stress)))
    shifted = first._replace(
        position=Vector(first.position.x + 4.0 * cell, first.position.y),
        stress=first.stress._replace(xy=-FRICTION * first.stress.yy),
    )
    controls = scene.controls._replace(gravity=GRAVITY * cos(INCLINE), energy_scale=inf, rest_time=inf)
    scene = replace(scene, points=shifted, controls=controls)
    own, now = scenes.release(scene, None), start()
    arguments, pull = scenes.arguments(scene, own), GRAVITY * sin(INCLINE)
    x0 = np.average(own.points.position.x, weights=own.points.mass)
    # Velocities belong to the middle of a step: the first one has friction for a whole step and the pull for none.
    step = controls.courant * cell / controls.wave_speed
    own.points.velocity.x[:] += 0.5 * step * (pull + FRICTION * controls.gravity)
    while now.time < until:
        before = now.time
        now = advance(now, np.nextafter(before, inf), *arguments)
        own.points.velocity.x[:] += pull * (now.time - before)
    moved = np.average(own.points.position.x, weights=own.points.mass) - x0
    exact = 0.5 * GRAVITY * now.time**2 * (sin(INCLINE) - FRICTION * cos(INCLINE))
    words = f"{moved:.4f} m, error {moved / exact - 1.0:+.1e}"
    return Row(
        "sliding block on an incline",
        f"24 degrees, mu = tan 15, {until} s, 0.4 of the critical step",
        f"{exact:.4f} m",
        words,
    )


def bars(quick: bool) -> Row:
    """Collapse of the aluminium bars."""
    found = []
    for cell in (0.02,) if quick else (0.01, 0.005, 0.0025):
        study = slopes.bars_study().with_changes({"time.end_s": 0.02} if quick else {})
        error = slopes.measure_bars(study, FAST, cell, 1).errors["surface"]
        found.append(f"{1e3 * error:.1f} mm ({1e3 * cell:g} mm)")
    return Row(
        "collapse of aluminium bars", "Mohr-Coulomb; highest point per cell", "best peer 1.7 mm", ", ".join(found)
    )


def undrained_slope(quick: bool) -> Row:
    """The cohesion at which a perfectly plastic slope on a rough base begins to flow, by bisection."""
    exact, found = 20.0 * 5.0 / TAYLOR, []
    for cell in (1.0,) if quick else (0.5, 0.25, 0.125):
        low, high = 12.0, 20.0
        for _ in range(2 if quick else 6):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if _flows(cell, middle) else (low, middle)
        critical = 0.5 * (low + high)
        found.append(f"{critical:.2f} kPa, {100 * (critical / exact - 1.0):+.1f} % ({cell:g} m)")
    return Row("undrained slope, Taylor's chart", "45 degrees, 5 m, rough base", f"{exact:.2f} kPa", ", ".join(found))


def _flows(cell: float, cohesion: float) -> bool:
    """Whether the slope still moves away after some seconds: a point further than half a metre."""
    study = Study(**deepcopy(SLOPE)).with_changes(
        {
            "discretisation.cell_m": cell,
            "boundary.base": {"kind": "fixed"},
            "material.0.softening_length_m": None,
            "material.0.softening_modulus_kpa": 0.0,
            "material.0.residual_cohesion_kpa": cohesion,
            "material.0.cohesion_kpa": cohesion,
            "material.0.viscosity_kpa_s": 0.0,
            "time.end_s": 8.0,
        }
    )
    points = realisation.simulate(realisation.prepare(study)).points
    return bool(np.hypot(points["displacement_x"], points["displacement_y"]).max() > 0.5)


def write(folder: Path, quick: bool, tell: Callable[[str], None]) -> Path:
    """Run every test and write the report.

    Args:
        folder: where verification.md goes; made if missing.
        quick: coarse and short runs: a look at the machinery.
        tell: is told the progress, line by line.

    Returns:
        The report's path.
    """
    lines = []
    tests = (self_weight, elastic_column, vibration, swirl, rotation, sliding, undrained_slope, bars)
    for test in tests:
        started = time.perf_counter()
        try:
            found = test(quick)
        except slopes.Missing as missing:
            found = Row(test.__doc__.strip("."), "", "", f"not run: {missing}")
        rows = [found] if isinstance(found, Row) else list(found)
        seconds = time.perf_counter() - started
        lines += [f"| {' | '.join(row)} | {seconds / len(rows):.1f} |" for row in rows]
        tell(lines[-1])
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "verification.md"
    path.write_text(TEXT.format(rows="\n".join(lines)), encoding="utf-8")
    return path


TEXT = """# Verification

Made by `rfmpm benchmark verification`: quadratic B-splines with the default transfer, on the production engine unless
said. Errors are relative unless a unit is given, with the number or size of cells in brackets; the order is fitted
through all of them. More closed forms (patch tests, laws, walls, free flight) are asserted in `tests/analytic`,
`tests/unit/mpm` and `tests/contracts`, granular columns in `tests/papers/lube_2005`.

| test | set-up | answer | ours | order | seconds |
|---|---|---|---|---|---|
{rows}
"""
