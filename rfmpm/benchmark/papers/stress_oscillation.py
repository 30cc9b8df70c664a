"""Oscillation of stresses with linear and higher-order shape functions, elastic and in a slide."""

from pathlib import Path

import numpy as np

from rfmpm.benchmark.engine.runs import Run
from rfmpm.benchmark.engine.schemes import SHAPE_LABELS, Scheme
from rfmpm.benchmark.engine.settling import settle, unstressed
from rfmpm.benchmark.markdown import table
from rfmpm.benchmark.papers.case import Case, Figure, Finding, Reproduction, simulate, study
from rfmpm.benchmark.papers.oscillation import components, oscillation
from rfmpm.mpm import scene as scenes
from rfmpm.observer import Observer
from rfmpm.report.slope_figures import WIDTH
from rfmpm.report.style import drawing, new_figure, save

SETTLING, SLIDING = "vardon_2016_stress_oscillation", "vardon_2017_short_slope"
PERIODS = 5  # in which the weight comes on
SLIDE = {"material.0.residual_cohesion_kpa": 8.0, "time.end_s": 2.5}  # the slip circle is complete
STRAINS = {"point": "each point's own", "cell_mean": "mean of a cell"}
SHAPE, STRAIN = "discretisation.shape", "discretisation.volumetric_strain"
COARSE, QUICK = 0.5, ("linear", "quadratic_bspline")  # [m], and shapes
SEVERAL = 3.0
States = dict[tuple[str, str], dict[str, np.ndarray]]  # points by shape and volumetric strain
COLOURS = {"isotropic": (-100.0, 0.0), "deviatoric": (0.0, 50.0), "tangential": (-20.0, 20.0)}  # [kPa]
SLIDE_COLOURS = {"isotropic": (-100.0, 0.0), "deviatoric": (0.0, 25.0), "tangential": (-20.0, 20.0)}  # [kPa]
MAPS = {"isotropic": "viridis", "deviatoric": "viridis", "tangential": "RdBu"}


def reproduce(coarse: bool) -> Reproduction:
    """Let the elastic slope settle and the short slope slide, with every shape."""
    cell = {"discretisation.cell_m": COARSE} if coarse else {}
    shapes, strains = (QUICK, ("point",)) if coarse else (SHAPE_LABELS, STRAINS)
    kinds = [(shape, strain) for strain in strains for shape in shapes]
    elastic = {kind: settled(cell | {SHAPE: kind[0], STRAIN: kind[1]}) for kind in kinds}
    slid = {
        (shape, strain): simulate(study(SLIDING, cell | SLIDE | {SHAPE: shape, STRAIN: strain})).points
        for shape, strain in kinds
    }
    found, moving = _measure(elastic), _measure(slid)
    figures = [
        Figure(ELASTIC, lambda path: _draw(elastic, "point", COLOURS, path)),
        Figure(MOVING, lambda path: _draw(slid, "point", SLIDE_COLOURS, path)),
    ]
    text = TEXT.format(settled=_rows(found), slid=_rows(moving), sunk=_sunk(elastic["linear", "point"], coarse))
    return Reproduction(_findings(found, moving), figures, text)


def settled(changes) -> dict[str, np.ndarray]:
    """The elastic slope under its weight, with some keys of its study changed: points by name."""
    asked = study(SETTLING, changes)
    run = Run(unstressed(asked), Scheme(asked.discretisation.shape, engine="fast"))
    settle(run, asked.geometry.height_m, scenes.GRAVITY, PERIODS)
    return Observer(run.scene, asked, run.points, run.history, frames=0).points()


def _sunk(points, coarse: bool) -> float:
    """Largest displacement over the side of a cell."""
    cell = COARSE if coarse else study(SETTLING).discretisation.cell_m
    return float(np.hypot(points["displacement_x"], points["displacement_y"]).max() / cell)


def _measure(states: States) -> dict[tuple[str, str], dict[str, float]]:
    return {
        kind: {name: oscillation(p["x"], p["y"], values) for name, values in components(p).items()}
        for kind, p in states.items()
    }


def _findings(found, moving) -> list[Finding]:
    smooth = [shape for shape, strain in found if strain == "point" and shape != "linear"]
    linear = found["linear", "point"]
    ratios = {name: linear[name] / max(found[shape, "point"][name] for shape in smooth) for name in linear}
    slide = {name: moving["linear", "point"][name] / moving["quadratic_bspline", "point"][name] for name in linear}
    is_same = all(ratio > SEVERAL for ratio in slide.values())
    return [
        *(
            Finding(
                f"linear elements oscillate: {name} stress",
                f"elastic slope: more than {SEVERAL:g} times the oscillation of any higher-order shape",
                f"{100 * linear[name]:.0f} % against "
                + ", ".join(f"{100 * found[shape, 'point'][name]:.2g} %" for shape in smooth)
                + f": {ratio:.0f} times or more",
                ratio > SEVERAL,
                "" if ratio > SEVERAL else "On these cells points cross hardly any side.",
            )
            for name, ratio in ratios.items()
        ),
        Finding(
            "higher-order elements take the oscillation away, in a slide too",
            f"slide at {SLIDE['time.end_s']:g} s: linear more than {SEVERAL:g} times quadratic in all three stresses",
            ", ".join(f"{name} {ratio:.1f}" for name, ratio in slide.items()) + " times",
            is_same,
            "" if is_same else LOCKING,
        ),
    ]


def _rows(measured) -> str:
    names = list(next(iter(measured.values())))
    head = "shape | volumetric strain | " + " | ".join(f"{name} [%]" for name in names)
    return table(
        head,
        [
            f"{SHAPE_LABELS[shape]} | {STRAINS[strain]} | " + " | ".join(f"{100 * one[name]:.2g}" for name in names)
            for (shape, strain), one in measured.items()
        ],
    )


def _draw(states: States, strain: str, colours, path: Path) -> None:
    """Draw the three stresses, a row each, with every shape, a column each."""
    with drawing():
        figure = new_figure(WIDTH + 2.0, 3.6)
        shapes = [shape for shape, of_shape in states if of_shape == strain]
        panels = figure.subplots(len(colours), len(shapes), sharex=True, sharey=True)
        for row, (name, (low, high)) in zip(panels, colours.items(), strict=True):
            for axes, shape in zip(row, shapes, strict=True):
                points = states[shape, strain]
                cloud = axes.scatter(
                    points["x"], points["y"], c=1e-3 * components(points)[name], s=1.2, lw=0, vmin=low, vmax=high,
                    cmap=MAPS[name], rasterized=True,
                )  # fmt: skip
                axes.set(aspect="equal")
                axes.grid(visible=False)
            row[0].set_ylabel("y [m]")
            figure.colorbar(cloud, ax=row, label=f"{name} [kPa]", extend="both")
        for axes, shape in zip(panels[0], shapes, strict=True):
            axes.set_title(SHAPE_LABELS[shape])
        for axes in panels[-1]:
            axes.set_xlabel("x [m]")
        save(figure, path)


ELASTIC = (
    "The elastic slope under its weight: isotropic stress (tension positive), deviatoric stress sqrt(J2) and "
    "tangential stress xy with each shape function. All are of one and the same slope: speckles are not soil."
)
MOVING = (
    "The short slope 2.5 s after its release, in the midst of its slide: what is smooth in the elastic slope has "
    "speckles in the isotropic stress of every shape once soil yields."
)
LOCKING = (
    "Soil that yields keeps its volume, and four points in a cell ask that of more places than the cell has freedom to "
    "give: its pressures swing from point to point with any shape. That oscillation is of the quadrature, not of the "
    "shape; means of volumetric strain and pressure over a cell, which are the default of undrained soil, take most of "
    "it away, as the table shows. What crossing adds comes on top with linear shapes."
)
TEXT = """The number: the stress of a point is foreseen from its twelve nearest neighbours, about those within a cell,
by the plane of least squares through them; the root mean square of what is not foreseen, over that of the stress. A
field that changes evenly has 0, noise about 1. Gradients that are real, at the toe and beside shear bands, count a
little too, with every shape alike.

The elastic slope, which moves by up to {sunk:.1f} cells as its weight comes on:

{settled}

The slide at 2.5 s, residual cohesion 8 kPa:

{slid}

A linear shape has a slope that jumps at the side of a cell, so that a point which crosses it moves its force from one
node to another at once: neighbours are strained against each other until the forces balance. B-splines and GIMP have
continuous slopes, so that in elastic soil next to nothing is left. In soil that yields there is a second oscillation,
of the isotropic stress alone, from keeping the volume at every point: it is in every shape, and is taken away by means
over cells, not by order.
"""

CASE = Case(
    title="Oscillation of stresses",
    document="Vardon (2016), The Material Point Method, lecture, TU Delft",
    says="Stresses of linear elements oscillate; those of higher-order elements do not.",
    studies=(SETTLING, SLIDING),
    left_open=(
        "Scene, size and time are not given, nor a number. Taken are the short slope made elastic and soft, whose "
        "exact stresses are smooth, and the short slope in the midst of its slide. Higher-order is quadratic in the "
        "lecture; GIMP and cubic B-splines are shown beside."
    ),
    reproduce=reproduce,
)
