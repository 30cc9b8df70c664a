"""The long slope in random soil: where it fails first, and which way its band takes."""

from math import cos, inf, radians
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction
from rfmpm.benchmark.papers.long_slopes import ALONG, COARSE, STUDY, TOP, Slide, bed_at, draw, geometry, slide
from rfmpm.quantities.state import label_cells

ANGLE = 20.0  # [degrees]
DEPTHS = (3.5, 5.0)  # of this case; of the homogeneous slopes [m]
MEMBERS, FEW = 8, 2  # realisations; on coarse cells
END = 3.5  # [s]
KNEE = TOP + ALONG * cos(radians(ANGLE))  # x of the foot of the slope [m]
FIELD = {
    "random_field.cohesion": {
        "material": "clay",
        "distribution": "lognormal",
        "coefficient_of_variation": 0.25,
        "correlation": "markov_separable",
        "scale_of_fluctuation_h_m": 12.0,
        "scale_of_fluctuation_v_m": 1.0,
    },
    "material.0.softening_modulus_kpa": 50.0,
    "time.end_s": END,
}
SHEARED = 0.1  # plastic strain of soil that is failing; it has lost a third of what it can lose [-]
ZONE_AREA = 1.0  # of failing soil, initial, from which it is a zone [m2]
NEAR = 0.75  # height above the bed up to which a band follows it: three cells [m]
WHOLE = 0.95  # share of the bed from which a band follows it entirely [-]
HALF = 0.5  # share of the layer that has failed when the band is looked at [-]


class Course(NamedTuple):
    """How one realisation fails."""

    run: Slide
    time: float  # last moment with several zones; infinite: never [s]
    zones: tuple[tuple[float, float], ...]  # their extents at that moment, from the toe upwards, x [m]
    half: float  # moment at which half of the layer has failed; infinite: never [s]
    along_bed: float  # share of the bed that the band follows then [-]

    @property
    def is_several(self) -> bool:
        """Whether one zone started at the toe and another on the slope."""
        return self.time < inf

    @property
    def leaves_bed(self) -> bool:
        """Whether the slope fails, and its band leaves the bed somewhere."""
        return self.half < inf and self.along_bed < WHOLE


def reproduce(coarse: bool) -> Reproduction:
    """Run some realisations of layers of both depths."""
    cell = {"discretisation.cell_m": COARSE} if coarse else {}
    members = range(FEW if coarse else MEMBERS)
    courses = {depth: [course(slide(geometry(ANGLE, depth) | FIELD | cell, k)) for k in members] for depth in DEPTHS}
    return Reproduction(_findings(courses), [_figure(courses[DEPTHS[0]])], _numbers(courses))


def course(run: Slide) -> Course:
    """Find the zones in which a realisation fails, and what its band does."""
    first, cell, n = run.scene.points.position, run.scene.cell, run.layer
    x, y, volume = first.x[:n], first.y[:n], run.scene.points.volume[:n]
    time, zones = inf, ()
    half = next((t for t, _ in run.outcome.frames if run.failed_share_at(t) >= HALF), inf)
    for at, points in run.outcome.frames:
        failing = points["plastic_strain"][:n] > SHEARED
        zone = label_cells(x[failing], y[failing], cell, diagonal=True)
        areas = np.bincount(zone, weights=volume[failing]) if zone.size else np.zeros(0)
        parts = [x[failing][zone == k] for k in np.flatnonzero(areas >= ZONE_AREA)]
        extents = tuple(sorted(((part.min(), part.max()) for part in parts), reverse=True))
        if at <= half and len(extents) > 1 and extents[0][1] > KNEE and extents[1][1] < KNEE:
            time, zones = at, extents
    return Course(run, time, zones, half, _along_bed(run, half) if half < inf else 0.0)


def _along_bed(run: Slide, time: float) -> float:
    n, cell = run.layer, run.scene.cell
    first, strain = run.scene.points.position, run.frame_at(time)[1]["plastic_strain"][:n]
    x, residual = first.x[:n], (20.0 - 5.0) / 50.0 * 0.25 / cell  # plastic strain at which the mean soil has softened
    low = (first.y[:n] - bed_at(x, ANGLE) < max(NEAR, 1.5 * cell)) & (x > TOP) & (x < KNEE)
    column = np.floor(x[low] / cell).astype(int)
    return float(len(np.unique(column[strain[low] > residual])) / len(np.unique(column)))


def _findings(courses: dict[float, list[Course]]) -> list[Finding]:
    several = {depth: sum(one.is_several for one in members) for depth, members in courses.items()}
    leaves = {depth: sum(one.leaves_bed for one in members) for depth, members in courses.items()}
    count = len(courses[DEPTHS[0]])
    where = f"of {count} realisations with a layer of {DEPTHS[0]:g} m"
    return [
        Finding(
            "several failure zones, one from the toe and one from mid-slope",
            f"before half of the layer has failed: zones of {ZONE_AREA:g} m2 or more with a plastic strain above "
            f"{SHEARED:g}, one that reaches the toe and one on the slope, in one realisation at least",
            f"in {several[DEPTHS[0]]} {where}, in {several[DEPTHS[1]]} with {DEPTHS[1]:g} m",
            several[DEPTHS[0]] > 0,
            "" if several[DEPTHS[0]] else REASON,
        ),
        Finding(
            "no main band follows the base entirely",
            f"as half of the layer has failed, soil at its residual strength lies within {NEAR:g} m of the bed on less "
            f"than {100 * WHOLE:.0f} % of its length, in one realisation at least",
            f"in {leaves[DEPTHS[0]]} {where}, in {leaves[DEPTHS[1]]} with {DEPTHS[1]:g} m",
            leaves[DEPTHS[0]] > 0,
            "" if leaves[DEPTHS[0]] else REASON,
        ),
    ]


def _figure(members: list[Course]) -> Figure:
    number, shown = min(enumerate(members), key=lambda one: (not one[1].is_several, one[1].along_bed))
    times = [min(shown.time, END) if shown.is_several else 1.0, min(shown.half, END), END]
    pictures = [(f"realisation {number}, {time:.1f} s", shown.run, time) for time in times]
    return Figure(
        f"Plastic strain of realisation {number} of the layer of {DEPTHS[0]:g} m: its zones; half of it has failed; "
        "the end of the run.",
        lambda path: draw(pictures, path),
    )


def _numbers(courses: dict[float, list[Course]]) -> str:
    rows = []
    for depth, members in courses.items():
        for number, one in enumerate(members):
            zones = ", ".join(f"{left:.1f} to {right:.1f}" for left, right in one.zones)
            several = f"{zones} m at {one.time:.1f} s" if one.is_several else "one"
            half = f"{one.half:.1f} s" if one.half < inf else f"not within {END:g} s"
            bed = f"{100 * one.along_bed:.0f} %" if one.half < inf else ""
            rows.append(f"{depth:g} | {number} | {several} | {half} | {bed}")
    return f"{table(HEAD, rows)}\n\n{WHY}"


HEAD = "layer [m] | realisation | zones along x | half has failed | bed followed by the band"
WHY = """Why: weak soil yields first where it lies, at the toe and on the slope, and where the strong soil between lies
on the bed the band passes above it, through weak layers, which lie level and cross the slope. The mean strength over
the shear stress on the bed is 0.9 with a layer of 3.5 m and 0.6 with one of 5 m: the nearer it is to 1, the longer the
zones stay apart and the further the band leaves the bed.
"""
REASON = "The layer is overstressed along its bed by so much that the bed is the weakest way; see the table."

CASE = Case(
    title="The long slope in random soil",
    document="Vardon, Wang and Hicks (2017), Slope failure simulations with MPM, case 2",
    says="Where strength varies, several zones fail, and the band between them seeks the weak layers.",
    studies=(STUDY,),
    left_open=(
        "The vertical scale of fluctuation, of which the horizontal one is 12 times: here 1 m. The law of the field: "
        f"here lognormal, separable Markov, layers level. The realisation: here {MEMBERS} of them, and what one of "
        f"them does can be what the paper shows. The depth of the layer: that of the homogeneous slopes, {DEPTHS[1]:g} "
        f"m, and {DEPTHS[0]:g} m, with which its mean strength is nearer to the stress on the bed."
    ),
    reproduce=reproduce,
)
