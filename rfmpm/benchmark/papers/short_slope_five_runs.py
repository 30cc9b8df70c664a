"""The five homogeneous runs of the short slope: residual cohesion and softening modulus."""

from itertools import pairwise
from pathlib import Path

from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction, simulate, study
from rfmpm.mpm.scene import outline
from rfmpm.outcome import Outcome
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, strain_limit, view
from rfmpm.report.style import drawing, new_figure, save

STUDY = "vardon_2017_short_slope"
RESIDUALS, MODULI = (12.0, 8.0, 4.0), (25.0, 50.0, 75.0)  # [kPa]
RUNS = [*((residual, 50.0) for residual in RESIDUALS), (4.0, 25.0), (4.0, 75.0)]
COARSE = 0.5  # [m]
Runs = dict[tuple[float, float], Outcome]  # by residual cohesion and softening modulus [kPa]


def reproduce(coarse: bool) -> Reproduction:
    """Run the five slopes and compare their order."""
    cell = {"discretisation.cell_m": COARSE} if coarse else {}
    runs = {
        (residual, modulus): simulate(
            study(
                STUDY,
                cell | {"material.0.residual_cohesion_kpa": residual, "material.0.softening_modulus_kpa": modulus},
            )
        )
        for residual, modulus in RUNS
    }
    return Reproduction(_findings(runs), [Figure(CAPTION, lambda path: _draw(runs, path))], _numbers(runs))


def _findings(runs: Runs) -> list[Finding]:
    by_residual = [runs[residual, 50.0].quantities for residual in RESIDUALS]
    stiff, middle, soft = by_residual
    lost = [runs[4.0, modulus].quantities["retrogression_distance"] for modulus in MODULI]
    run_outs = [found["run_out"] for found in by_residual]
    grows = all(shorter <= longer for shorter, longer in pairwise(lost))
    return [
        Finding(
            "the lower the residual cohesion, the further the failure goes",
            "run-out grows from 12 to 8 to 4 kPa",
            ", ".join(f"{value:.2f}" for value in run_outs) + " m",
            run_outs[0] < run_outs[1] < run_outs[2],
        ),
        Finding(
            "12 kPa: a complete shear band, very limited slumping at the crest",
            "one block, and not more than a tenth fails after the first slide",
            f"{stiff['block_count']} block, {_later(stiff):.0f} %",
            stiff["block_count"] == 1 and _later(stiff) < 10.0,
        ),
        Finding(
            "8 kPa: one complete slip circle with small failures at the back scarp",
            "fails on after the first slide, but not to the boundary",
            f"{_later(middle):.0f} % more, {middle['retrogression_distance']:.1f} m back",
            _later(middle) > 10.0 and not middle["retrogression_censored"],
        ),
        Finding(
            "4 kPa: retrogression until the boundary stops it; horsts and grabens",
            "reaches the boundary, three or more blocks",
            f"{soft['retrogression_distance']:.1f} m back, {soft['block_count']} blocks",
            bool(soft["retrogression_censored"]) and soft["block_count"] >= 3,
        ),
        Finding(
            "4 kPa: retrogression grows with the softening modulus",
            "grows from 25 to 50 to 75 kPa",
            ", ".join(f"{value:.2f}" for value in lost) + " m",
            grows,
            "" if grows else MODULUS,
        ),
    ]


def _later(found) -> float:
    """What failed after the first slide, in per cent of that."""
    return 100.0 * (found["failure_volume"] / found["initial_failure_volume"] - 1.0)


def _numbers(runs: Runs) -> str:
    rows = []
    for (residual, modulus), outcome in runs.items():
        q = outcome.quantities
        reach = f"{q['retrogression_distance']:.2f}" + (" (boundary)" if q["retrogression_censored"] else "")
        rest = f"{q['time_at_rest']:.1f}" if outcome.status == "ok" else "no"
        rows.append(
            f"{residual:g} | {modulus:g} | {q['run_out']:.2f} | {reach} | {q['failure_volume']:.1f} "
            f"| {q['initial_failure_volume']:.1f} | {q['block_count']} | {rest} "
            f"| {100 * q['numerical_dissipation_share']:.1f} % | {100 * q['energy_balance_error']:.1f} %"
        )
    return f"{table(HEAD, rows)}\n\nNumerical dissipation and energy error are shares of the work of gravity.\n"


def _draw(runs: Runs, path: Path) -> None:
    """Draw the final plastic strain of the runs, one below the other, in one frame and one scale of colours."""
    polygon, points = outline(study(STUDY)), [outcome.points for outcome in runs.values()]
    frame = view([polygon[:, 0], *(p["x"] for p in points)], [polygon[:, 1], *(p["y"] for p in points)])
    top = strain_limit(p["plastic_strain"] for p in points)
    with drawing():
        figure = new_figure(WIDTH, len(points) * (panel_height(frame) + 0.35))
        panels = figure.subplots(len(points), 1)
        for axes, (residual, modulus), p in zip(panels, runs, points, strict=True):
            axes.set_title(f"residual cohesion {residual:g} kPa, softening modulus {modulus:g} kPa")
            draw_panel(figure, axes, p, p["plastic_strain"], polygon, frame, (0.0, top), "plastic strain [-]")
        save(figure, path)


HEAD = (
    "residual cohesion [kPa] | softening modulus [kPa] | run-out [m] | retrogression [m] | failure volume [m3/m] "
    "| first slide [m3/m] | blocks | at rest [s] | numerical dissipation | energy error"
)
CAPTION = "Final plastic strain of the five runs over the initial outline: bright bands are where the soil sheared."
MODULUS = (
    "With 75 kPa the soil softens before the second slide has its full height: more of the crest goes with the first "
    "slide, and what it leaves behind stands."
)

CASE = Case(
    title="The short slope: five runs",
    document="Vardon, Wang and Hicks (2017), 15th IACMAG, Wuhan",
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
