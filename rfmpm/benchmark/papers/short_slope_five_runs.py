"""The five homogeneous runs of the short slope: residual cohesion and softening modulus."""

from math import atan2, degrees
from pathlib import Path

import numpy as np

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers import short_slope_crests as crests
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction
from rfmpm.benchmark.papers.short_slope import COARSE, FINER, MODULUS, RESIDUAL, STUDY, Run, run
from rfmpm.mpm.scene import outline
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, strain_limit, view
from rfmpm.report.style import drawing, new_figure, save

RESIDUALS, MODULI = (12.0, 8.0, 4.0), (25.0, 50.0, 75.0)  # [kPa]
RUNS = [*((residual, 50.0) for residual in RESIDUALS), (4.0, 25.0), (4.0, 75.0)]
FINER_RUNS = [(8.0, 50.0), *((4.0, modulus) for modulus in MODULI)]
FIRST_SLIDE = 2.5  # [s]: its band is complete, and no other one behind it
RIDGE = 0.05  # of the height, a cell of the paper: how far a ridge stands out of the troughs beside it
Runs = dict[tuple[float, float], Run]  # by residual cohesion and softening modulus [kPa]


def reproduce(coarse: bool) -> Reproduction:
    """Run the five slopes, and what tells why they are as they are: finer cells, longer crests."""
    cells = COARSE if coarse else {}
    runs = {key: _run(key, cells) for key in RUNS}
    finer = runs if coarse else {key: _run(key, FINER) for key in FINER_RUNS}
    stronger = run(cells | {RESIDUAL: 8.0, "material.0.cohesion_kpa": 20.2})
    reaches = crests.reaches(MODULI, cells, crests.FEW if coarse else crests.CRESTS)
    half_step = crests.reaches(MODULI, cells | {"time.step_fraction": 0.25}, [crests.OF_PAPER])
    figures = [
        Figure(CAPTION, lambda path: _draw(runs, path)),
        Figure(crests.CAPTION, lambda path: crests.draw(reaches, path)),
    ]
    return Reproduction(_findings(runs, finer, stronger, reaches, half_step), figures, _text(runs, finer, reaches))


def _run(key: tuple[float, float], cells: dict) -> Run:
    residual, modulus = key
    return run(cells | {RESIDUAL: residual, MODULUS: modulus})


def _findings(
    runs: Runs, finer: Runs, stronger: Run, reaches: crests.Reaches, half_step: crests.Reaches
) -> list[Finding]:
    stiff, middle, soft = (runs[residual, 50.0] for residual in RESIDUALS)
    run_outs = [one.quantities["run_out"] for one in (stiff, middle, soft)]
    sunk = [one.pieces(one.outcome.points)[-1].settlement for one in (stiff, middle, soft)]
    crumbled = _crumbled(middle)
    cell, ends = finer[4.0, 50.0].study.discretisation.cell_m, _ends(finer[4.0, 50.0])
    ridges = [ridge_count(runs[4.0, modulus]) for modulus in MODULI]
    return [
        Finding(
            "the lower the residual cohesion, the further the failure goes",
            "run-out grows from 12 to 8 to 4 kPa",
            _metres(run_outs),
            run_outs[0] < run_outs[1] < run_outs[2],
        ),
        Finding(
            "12 kPa: a complete shear band, very limited slumping at the crest",
            "one band cuts the crest; what it cuts off sinks less than with 8 and 4 kPa and than half of the height",
            f"{_cuts(stiff)}; sinks {_metres(sunk)}",
            len(stiff.cuts) == 1 and sunk[0] < min(*sunk[1:], 0.5 * stiff.study.geometry.height_m),
        ),
        _one_circle(middle, finer[8.0, 50.0], stronger),
        Finding(
            "8 kPa: small failures at the back scarp",
            f"at {FIRST_SLIDE:g} s less than a fifth of what the circle cut off has come apart from its largest piece",
            f"{100 * crumbled:.0f} %",
            0.0 < crumbled < 0.2,
            "" if 0.0 < crumbled < 0.2 else CRUMBLED,
        ),
        Finding(
            "4 kPa: retrogression until the boundary stops it",
            "the failure reaches the boundary behind the crest",
            f"{_cuts(soft)}; ends {_ends(soft):.1f} m back; on cells of {cell:g} m {ends:.1f} m back",
            bool(soft.quantities["retrogression_censored"]),
        ),
        Finding(
            "4 kPa: horsts and grabens, with every softening modulus",
            f"two or more ridges in what slid, {RIDGE:.0%} of the height or more above the troughs beside them",
            f"{', '.join(map(str, ridges))} ridges for 25, 50, 75 kPa; {ridge_count(stiff)} with 12 kPa residual",
            min(ridges) >= 2,
            "" if min(ridges) >= 2 else DROWNED,
        ),
        *crests.findings(reaches, half_step, [_ends(finer[4.0, modulus]) for modulus in MODULI]),
        _steepened(soft),
    ]


def _ends(own: Run) -> float:
    return own.quantities["retrogression_distance"]


def _one_circle(own: Run, finer: Run, stronger: Run) -> Finding:
    agrees = len(own.cuts) == 1
    cell = finer.study.discretisation.cell_m
    return Finding(
        "8 kPa: one complete slip circle",
        f"one band cuts the crest, by {FIRST_SLIDE:g} s, and none behind it",
        f"{_cuts(own)}; on cells of {cell:g} m {_cuts(finer)}; "
        f"with a peak of {stronger.study.material[0].cohesion_kpa:g} kPa {_cuts(stronger)}",
        agrees,
        "" if agrees else SECOND_CIRCLE,
    )


def _crumbled(own: Run) -> float:
    """Share of what the first band cut off the body that is not in the largest of its pieces, in area, initially."""
    points = own.at(FIRST_SLIDE)
    area = own.outcome.frames[0][1]["volume"].sum()
    standing, *slid = own.pieces(points)
    sheared = points["plastic_strain"] >= own.residual_strain
    apart = sum(piece.area for piece in slid) - max(piece.area for piece in slid)
    scarp = sheared & (points["x_initial"] < slid[-1].back) & (points["y_initial"] > 0.5 * own.study.geometry.height_m)
    return float((apart + scarp.sum() * area / len(sheared)) / (area - standing.area))


def scarp_angle(own: Run) -> float:
    """Slope of the face behind the first slide, over the upper half of its height [degrees]."""
    points, height = own.at(FIRST_SLIDE), own.study.geometry.height_m
    whole = points["plastic_strain"] < own.residual_strain
    back = own.standing(points)
    middle = whole & (np.abs(points["y_initial"] - 0.5 * height) < 0.5 * own.study.discretisation.cell_m)
    x = points["x_initial"][middle]
    gaps = np.flatnonzero(np.diff(np.sort(x)) > 1.5 * own.spacing)
    face = np.sort(x)[gaps[0] if len(gaps) else -1]
    return degrees(atan2(0.5 * height, face - back))


def _steepened(soft: Run) -> Finding:
    angle, before = scarp_angle(soft), soft.study.geometry.angle_deg
    return Finding(
        "a small slope is steepened by its first failure, and further ones retrogress (Wang, Vardon and Hicks 2016)",
        "the face behind the first slide of 4 kPa is steeper than the slope was, and another band cuts it off",
        f"{before:.0f} degrees, then {angle:.0f}; {_cuts(soft)}",
        angle > before and len(soft.cuts) > 1,
    )


def ridge_count(own: Run) -> int:
    """Ridges in the ground of what slid that stand out by RIDGE of the height."""
    from scipy.signal import find_peaks

    height = own.study.geometry.height_m
    surface = own.quantities["final_surface"]
    centres = (np.arange(len(surface)) + 0.5) * own.study.output.surface_bin_m
    slid = surface[centres > own.standing(own.outcome.points)]
    return len(find_peaks(slid, prominence=RIDGE * height)[0])


def _metres(values) -> str:
    return ", ".join(f"{value:.2f}" for value in values) + " m"


def _cuts(own: Run) -> str:
    return " and ".join(f"{cut.distance:.1f} m at {cut.time:.1f} s" for cut in own.cuts) or "none"


def _text(runs: Runs, finer: Runs, reaches: crests.Reaches) -> str:
    return f"{WHY}\n\n{_numbers(runs)}\n\n{FINER_HEAD}\n\n{_numbers(finer)}\n\n{NOTE}\n\n{crests.numbers(reaches)}\n"


def _numbers(runs: Runs) -> str:
    rows = []
    for (residual, modulus), own in runs.items():
        q, outcome = own.quantities, own.outcome
        reach = f"{q['retrogression_distance']:.2f}" + (" (boundary)" if q["retrogression_censored"] else "")
        rest = f"{q['time_at_rest']:.1f}" if outcome.status == "ok" else "no"
        rows.append(
            f"{residual:g} | {modulus:g} | {q['run_out']:.2f} | {reach} | {_cuts(own)} | {q['failure_volume']:.1f} "
            f"| {q['initial_failure_volume']:.1f} | {q['block_count']} | {rest} "
            f"| {100 * q['numerical_dissipation_share']:.1f} % | {100 * q['energy_balance_error']:.1f} %"
        )
    return table(HEAD, rows)


def _draw(runs: Runs, path: Path) -> None:
    """Draw the final plastic strain of the runs, one below the other, in one frame and one scale of colours."""
    polygon = outline(next(iter(runs.values())).study)
    points = [own.outcome.points for own in runs.values()]
    frame = view([polygon[:, 0], *(p["x"] for p in points)], [polygon[:, 1], *(p["y"] for p in points)])
    top = strain_limit(p["plastic_strain"] for p in points)
    with drawing():
        figure = new_figure(WIDTH, len(points) * (panel_height(frame) + 0.35))
        panels = figure.subplots(len(points), 1)
        for axes, (residual, modulus), p in zip(panels, runs, points, strict=True):
            axes.set_title(f"residual cohesion {residual:g} kPa, softening modulus {modulus:g} kPa")
            draw_panel(figure, axes, p, p["plastic_strain"], polygon, frame, (0.0, top), "plastic strain [-]")
        save(figure, path)


CAPTION = "Final plastic strain of the five runs over the initial outline: bright bands are where the soil sheared."
HEAD = (
    "residual cohesion [kPa] | softening modulus [kPa] | run-out [m] | retrogression [m] | bands cut the crest "
    "| failure volume [m3/m] | first slide [m3/m] | blocks | at rest [s] | numerical dissipation | energy error"
)
WHY = """Each slope begins alike: a band at the toe, where stresses are largest, softens and grows up to the crest as an
arc; what it cuts off turns on it and runs out. With 12 kPa what is left in the band carries the block after two metres.
With 8 kPa it slides on and takes the soil at its scarp with it, a wedge between two bands. With 4 kPa the block
leaves so far that the face behind it stands alone, steeper than the slope was, and fails as the slope did; the second
block takes the same way. Blocks tilt backwards and part along bands that dip the other way: their edges are ridges,
horsts, and what sinks between them are troughs, grabens. Yellow soil has been sheared through and through."""
FINER_HEAD = "The same on cells of half the size, with the same energy to soften a metre of band:"
NOTE = """Numerical dissipation and energy error are shares of the work of gravity. The first slide is what has failed
at the first minimum of the kinetic energy, which is a weak mark: where two slides overlap it moves with the time step.

How far back the slope of 4 kPa fails, what the second slide leaves of the crest up to the boundary, and the lowest
ground 3 to 5 m in front of the face that it leaves, 2.5 s after its band is complete:"""
SECOND_CIRCLE = (
    "the face behind the circle is within a percent of standing: for some seconds next to nothing moves, then a second "
    "band forms slowly, and its block stops after less than a metre. With 1 % more peak strength it does not come, nor "
    "on cells of half the size: there one circle is all, as in the paper."
)
CRUMBLED = "the band of coarse cells is so wide that what it shears is no small part of the slide."
DROWNED = "its blocks lie in sheared soil of their own height, so that few stand out."
CASE = Case(
    title="The short slope: five runs",
    document=(
        "Vardon, Wang and Hicks (2017), 15th IACMAG, Wuhan; the same slope as in Wang, Vardon and Hicks (2016), "
        "Computers and Geotechnics 78"
    ),
    says=(
        "The residual strength decides whether a slope slumps, slides once or retrogresses; with the lowest one "
        "retrogression grows with the rate of softening."
    ),
    studies=(STUDY,),
    left_open=(
        "The paper's grid is 20 m long, which an undamped run-out passes: here 40 m. Its yield condition and its "
        "factor of safety of 0.96 do not go together; sqrt(J2) = c is taken, with which limit analysis gives 1.10."
    ),
    reproduce=reproduce,
)
