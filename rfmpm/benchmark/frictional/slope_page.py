"""The page's section on the slope of Toro Rojas et al."""

import os
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from rfmpm.benchmark.frictional import slope
from rfmpm.benchmark.frictional.cases import CELL, Section, finding
from rfmpm.benchmark.frictional.slope import COHESION, Cost, Travel, travel
from rfmpm.benchmark.markdown import table
from rfmpm.report.slope_figures import WIDTH
from rfmpm.report.style import BLUE, ORANGE, VERMILION, drawing, new_figure, save

STIFFNESSES = (30e3, 60e3, 150e3, 300e3)  # [kPa]
COHESIONS = (0.1, 0.5, 1.0, 1.25, 1.5, 1.8)  # [kPa]
PACKINGS = (1, 4, 9)  # points per cell
SHAPES = ("quadratic_bspline", "linear")
STIFFNESS, POINTS = "material.0.youngs_modulus_kpa", "discretisation.points_per_cell"
FACTORS, HOLDS, NEAR = (0.66, 1.0), 1.25, 0.25  # published; [kPa], and what "about" is taken for
END, SHORT = 8.0, 0.02  # [s] of model time, and of the run from which the cost of many cells is reckoned
UNAFFECTED = 0.05  # relative spread that counts as none


def section(folder: Path) -> Section:
    """Find factors, the cohesion that holds, travel, histories and cost; draw the histories."""
    factors = [slope.factor(cohesion) for cohesion in (0.1, 1.8)]
    held = {theirs: [slope.holding_cohesion(ours, shape) for shape in SHAPES] for theirs, ours in slope.CELLS.items()}
    softer = [travel({STIFFNESS: value}) for value in STIFFNESSES]
    standing = [travel({STIFFNESS: value, COHESION: 1.8, CELL: slope.CELLS[0.4]}) for value in STIFFNESSES]
    stronger = [travel({COHESION: value}) for value in COHESIONS]
    finer = [travel({CELL: cell}) for cell in slope.CELLS.values()]
    packed = {
        (theirs, count): travel({CELL: slope.CELLS[theirs], POINTS: count})
        for theirs in (0.5, 0.3, 0.2)
        for count in PACKINGS
    }
    peaks = _draw(slope.histories({"time.end_s": 5.0}), folder / "frictional_histories.png")
    same, many = slope.cost(slope.CELLS[0.2], END), slope.cost(slope.AS_MANY, SHORT)
    rows = [
        *_rows("E = {:g} MPa", np.array(STIFFNESSES) / 1e3, softer),
        *_rows("c = {:g} kPa", COHESIONS, stronger),
        *_rows("cells of {:.3g} m", slope.CELLS.values(), finer),
        *(
            _row(f"cells of {slope.CELLS[theirs]:.3g} m, {count} points", one)
            for (theirs, count), one in packed.items()
        ),
        *_rows("c = 1.8 kPa, cells of 0.4 m, E = {:g} MPa", np.array(STIFFNESSES) / 1e3, standing),
    ]
    limits = [
        f"{slope.CELLS[theirs]:.3g} ({theirs:g}) | " + " | ".join(f"{c:.2f}" for c in found)
        for theirs, found in held.items()
    ]
    places = " | ".join(f"{place} [m]" for place in slope.PLACES)
    text = TEXT.format(
        held=slope.HELD,
        limits=table("cell (theirs) [m] | quadratic B-splines [kPa] | 4-node squares [kPa]", limits),
        travel=table(f"| {places} | mean of all soil [m] | run-out [m]", rows),
        peaks=peaks,
        costs=_costs(same, many),
    )
    return Section(text, [*_findings(factors, held, softer, stronger, finer, standing), *_timings(same, many)])


def _rows(label: str, values, found: Sequence[Travel]) -> list[str]:
    return [_row(label.format(value), one) for value, one in zip(values, found, strict=True)]


def _row(label: str, one: Travel) -> str:
    if one.status not in ("ok", "not_at_rest"):
        return f"{label} | refused: {one.status.replace('_', ' ')} |  |  |  | "
    at = " | ".join(f"{one.at[place]:.3g}" for place in slope.PLACES)
    return f"{label} | {at} | {one.mean:.3g} | {one.run_out:.2f}"


def _findings(factors, held, softer, stronger, finer, standing) -> list[str]:
    means, reaches = [one.mean for one in softer], [one.run_out for one in finer]
    spread = (max(means) - min(means)) / np.mean(means)
    first, last = held[0.5][0], held[0.2][0]
    ratio = standing[0].furthest / standing[-1].furthest
    return [
        finding(
            "slope: factors by Morgenstern and Price at 0.1 and 1.8 kPa",
            "0.66 and 1.0",
            " and ".join(f"{factor:.3f}" for factor in factors),
            all(abs(found - asked) < 0.005 for found, asked in zip(factors, FACTORS, strict=True)),
        ),
        finding(
            "slope: holds from",
            f"about {HOLDS} kPa",
            f"{first:.2f} kPa on cells of 0.53 m, {last:.2f} kPa on 0.2 m",
            abs(first - HOLDS) <= NEAR,
        ),
        finding(
            "slope: travel against stiffness, 30 to 300 MPa",
            "no dependence",
            f"mean travel varies by {100.0 * spread:.1f} %",
            spread < UNAFFECTED,
        ),
        finding(
            "slope: travel against cohesion",
            "falls",
            ", ".join(f"{one.mean:.2g}" for one in stronger) + " m in the mean",
            all(before.mean > after.mean for before, after in pairwise(stronger)),
        ),
        finding(
            "slope: travel on finer cells",
            "grows",
            "run-out " + ", ".join(f"{reach:.2f}" for reach in reaches) + " m",
            all(before < after for before, after in pairwise(reaches)),
        ),
        finding(
            "slope: displacement where it holds, against stiffness",
            "falls",
            f"by a factor of {ratio:.1f} from 30 to 300 MPa",
            all(before.furthest > after.furthest for before, after in pairwise(standing)),
        ),
    ]


def _whole(same: Cost, many: Cost) -> float:
    """Time of a whole run on many cells [s]: steps in inverse proportion to the cell, each as long as those of it."""
    steps = same.steps * slope.CELLS[0.2] / slope.AS_MANY
    return many.preparing + many.stepping * steps / many.steps


def _timings(same: Cost, many: Cost) -> list[str]:
    whole = {"cells of 0.2 m": same.preparing + same.stepping, f"{many.cells} cells": _whole(same, many)}
    return [
        finding(
            f"slope: time of a run, {name}",
            f"2 days ({slope.THEIR_ELEMENTS} elements); minutes",
            f"{seconds:.0f} s, a ratio of {slope.THEIR_TIME / seconds:.0f}",
            seconds < 3600.0,
        )
        for name, seconds in whole.items()
    ]


def _costs(same: Cost, many: Cost) -> str:
    return (
        f"Cells of 0.2 m: {same.cells} with soil, {same.points} points, {same.steps} steps for {END:g} s; "
        f"{same.preparing:.1f} s to prepare, {same.stepping:.1f} s to run. Cells of {1e3 * slope.AS_MANY:.1f} mm: "
        f"{many.cells}, {many.points} points; {many.preparing:.0f} s to prepare, {many.steps} steps in "
        f"{many.stepping:.1f} s, from which the whole is reckoned. Processor time, one core, load of the machine "
        f"{os.getloadavg()[0]:.1f}."
    )


def _draw(seen, path: Path) -> str:
    """Draw displacement, speed and acceleration of the named places. Returns their peaks in words."""
    labels = ("displacement [m]", "speed [m/s]", "acceleration [m/s2]")
    with drawing():
        figure = new_figure(WIDTH, 2.7)
        for k, (axes, label) in enumerate(zip(figure.subplots(1, 3), labels, strict=True)):
            for place, colour in zip(slope.PLACES, (BLUE, ORANGE, VERMILION), strict=True):
                axes.plot(seen["time"], seen[place][k], color=colour, label=place)
            axes.set(xlabel="time [s]", ylabel=label)
        axes.legend()
        save(figure, path)
    fastest = {place: (seen[place][1].max(), seen["time"][seen[place][1].argmax()]) for place in slope.PLACES}
    return "; ".join(f"{place} {speed:.2f} m/s at {time:.1f} s" for place, (speed, time) in fastest.items())


TEXT = """## The slope of Toro Rojas et al.

`configs/papers/toro_rojas_slope.toml`. Its size is not published; 44 degrees and 3.2 m meet both factors of safety.
Cells must divide 3.2 m, so that 0.8, 0.533 and 0.32 m stand for 1.0, 0.5 and 0.3 m, and points fill squares, so that
nine stand for eight. The foundation of 4 GPa is taken for rigid. No dilation. Unless said: E 30 MPa, c 0.1 kPa, cells
of 0.2 m, four points.

Cohesion from which no point moves by {held:g} m in 8 s:

{limits}

Limit equilibrium says 1.8 kPa. Coarse cells, and 4-node squares more so, hold a slope that should fail; the published
1.25 kPa is of that kind.

Displacement within a cell of crown, centre and foot of the face, and of all soil:

{travel}

![Histories at crown, centre and foot](frictional_histories.png)

Largest speeds: {peaks}. Crown and centre speed up, and slow down, once; the foot, on the rough base, moves little.

{costs}
"""
