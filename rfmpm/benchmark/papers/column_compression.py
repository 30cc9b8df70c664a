"""One-dimensional compression of a column by its own weight: linear shapes as points cross cells, and smoother ones."""

from math import isfinite
from pathlib import Path

import numpy as np

from rfmpm.benchmark.engine.column import HEIGHT, WIDTH_IN_CELLS, Compression, compress
from rfmpm.benchmark.engine.schemes import SHAPE_LABELS, Scheme
from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction, study
from rfmpm.report.slope_figures import WIDTH
from rfmpm.report.style import BLUE, GREY, ORANGE, VERMILION, drawing, new_figure, save

STUDY = "vardon_2016_column_compression"
COUNTS, COARSE, SHOWN = (10, 20, 40, 80, 160), (10, 20, 40), 80  # cells over the height; those of the profile
SHAPES = dict(zip(SHAPE_LABELS, (GREY, ORANGE, BLUE, VERMILION), strict=True))
QUICK = ("linear", "quadratic_bspline")
MANY = 16  # points per cell, to see what is left to them
EXACT, CROSSING = 0.005, 10.0  # error that counts as none; ratio of errors that counts as another kind
Runs = dict[tuple[str, int], Compression]  # by shape and cells over the height


def reproduce(coarse: bool) -> Reproduction:
    """Compress the column with every shape on ever finer cells."""
    shapes, counts = (QUICK, COARSE) if coarse else (tuple(SHAPES), COUNTS)
    runs = {(shape, count): compressed(shape, count) for shape in shapes for count in counts}
    shown = counts[-1] if coarse else SHOWN
    many = compressed("quadratic_bspline", shown, MANY)
    figures = [
        Figure(PROFILE.format(shown=shown), lambda path: _draw_profile(runs, shapes, shown, path)),
        Figure(CONVERGENCE, lambda path: _draw_errors(runs, shapes, counts, path)),
    ]
    return Reproduction(_findings(runs, shapes, counts), figures, _text(runs, shapes, counts, shown, many))


def compressed(shape: str, count: int, points: int = 4) -> Compression:
    """Compress the column on so many cells over its height, with so many points per cell."""
    cell = HEIGHT / count
    changes = {
        "discretisation.cell_m": cell,
        "geometry.width_m": WIDTH_IN_CELLS * cell,
        "discretisation.shape": shape,
        "discretisation.points_per_cell": points,
    }
    return compress(study(STUDY, changes), Scheme(shape, engine="fast", points_per_cell=points))


def _findings(runs: Runs, shapes, counts) -> list[Finding]:
    fine, coarse = counts[-1], counts[0]
    errors = {shape: [runs[shape, count].error for count in counts] for shape in shapes}
    best = {shape: errors[shape][-1] for shape in shapes}
    smooth = [shape for shape in shapes if shape != "linear"]
    ratio = best["linear"] / max(best[shape] for shape in smooth)
    return [
        Finding(
            "the method gives the analytic stress of the column, rho0 g (l0 - Y)",
            f"GIMP and B-splines: error under {100 * EXACT:g} % of the stress at the base on the finest cells",
            ", ".join(f"{SHAPE_LABELS[shape]} {100 * best[shape]:.2g} %" for shape in smooth),
            all(isfinite(best[shape]) and best[shape] < EXACT for shape in smooth),
        ),
        Finding(
            "finer cells come closer to it",
            f"GIMP and B-splines: smaller on {fine} cells than on {coarse}",
            ", ".join(f"{errors[shape][0] / best[shape]:.0f} times" for shape in smooth),
            all(best[shape] < errors[shape][0] for shape in smooth),
        ),
        Finding(
            "with linear shapes the stress is wrong as points cross cells",
            f"on the finest cells more than {CROSSING:g} times the others' error, and more than on {coarse} cells",
            f"{100 * best['linear']:.0f} %, {ratio:.0f} times, and {100 * errors['linear'][0]:.0f} % on {coarse} cells",
            best["linear"] > errors["linear"][0] and ratio > CROSSING,
        ),
    ]


def _text(runs: Runs, shapes, counts, shown: int, many: Compression) -> str:
    rows = [
        f"{count} | {_crossed(runs['quadratic_bspline', count], count):.1f} | "
        + " | ".join(f"{100 * runs[shape, count].error:.2g}" for shape in shapes)
        for count in counts
    ]
    head = "cells | sinks by [cells] | " + " | ".join(f"{SHAPE_LABELS[shape]} [%]" for shape in shapes)
    few = runs["quadratic_bspline", shown].error
    return TEXT.format(
        rows=table(head, rows), shown=shown, few=f"{100 * few:.2g}", many=f"{100 * many.error:.2g}", count=MANY
    )


def _crossed(one: Compression, count: int) -> float:
    """By how many cells the top sinks."""
    return float((one.y_initial - one.y).max()) * count / HEIGHT


def _draw_profile(runs: Runs, shapes, count: int, path: Path) -> None:
    """Draw the stress of every point over the height at which it lay, and the exact line."""
    with drawing():
        figure = new_figure(WIDTH, 3.6)
        panels = figure.subplots(1, len(shapes), sharex=True, sharey=True)
        for axes, shape in zip(panels, shapes, strict=True):
            one = runs[shape, count]
            axes.plot(1e-3 * one.stress, one.y_initial, ".", ms=2.5, color=SHAPES[shape])
            axes.plot([1e-3 * one.exact.min(), 0.0], [0.0, HEIGHT], color="black", lw=0.8)
            axes.set(title=SHAPE_LABELS[shape], xlabel="stress [kPa]")
        panels[0].set_ylabel("initial height Y [m]")
        save(figure, path)


def _draw_errors(runs: Runs, shapes, counts, path: Path) -> None:
    with drawing():
        figure = new_figure(5.4, 3.4)
        axes = figure.add_subplot()
        for shape in shapes:
            errors = [100 * runs[shape, count].error for count in counts]
            axes.loglog(counts, errors, "o-", ms=4, color=SHAPES[shape], label=SHAPE_LABELS[shape])
        low = np.array([counts[0], counts[-1]], float)
        axes.loglog(low, 3.0 * low[0] / low, color="black", lw=0.8, ls="--", label="first order")
        axes.set(xlabel="cells over the height", ylabel="error of the stress [%]")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        save(figure, path)


PROFILE = (
    "Stress of every point on {shown} cells, over the height at which it lay; the line is the exact stress. With "
    "linear shapes it scatters about the line, the more the deeper, where points have been moved furthest through "
    "strained soil; the other shapes lie on it."
)
CONVERGENCE = "Root mean square of the error over the stress at the base."
TEXT = """{rows}

The column is squeezed by four per cent at its base and its top sinks by 1 m, which is many cells where they are small.
A linear shape has a slope that jumps at the side of a cell: a point that passes it takes its whole force from one node
to the next at once, and the two cells, one with a point too many and one with a point too few, are strained until the
forces balance again. So what is computed is a saw. On finer cells more points cross more sides, so that the error does
not fall. GIMP and B-splines have slopes without jumps.

What is left to them on fine cells is that points are the places of quadrature and no longer lie where they were: on
{shown} cells quadratic B-splines have {few} % with four points per cell and {many} % with {count}.
"""

CASE = Case(
    title="Compression of a column",
    document="Vardon (2016), The Material Point Method, lecture, TU Delft",
    says=(
        "A column that is compressed by its own weight has an exact answer; linear shapes lose it as points cross the "
        "sides of cells."
    ),
    studies=(STUDY,),
    left_open=(
        "The lecture gives no numbers. Taken are those of Bardenhagen and Kober (2004), section 5.1: 50 m, density 80 "
        "kg/m3, Young's modulus 1 MPa, Poisson's ratio 0, gravity 10 m/s2, which comes on over ten periods of the "
        "column, so that the swing left over is 0.02 % of the stress."
    ),
    reproduce=reproduce,
)
