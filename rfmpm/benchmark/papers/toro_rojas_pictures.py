"""Pictures of the slope of Toro Rojas et al."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from rfmpm.benchmark.papers import toro_rojas_runs as slope
from rfmpm.benchmark.papers.case import study
from rfmpm.benchmark.papers.toro_rojas_runs import Studies
from rfmpm.mpm.scene import outline
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height
from rfmpm.report.style import BLUE, GREY, ORANGE, VERMILION, drawing, new_figure, save

FRAME = (4.0, 17.5, -0.2, 3.5)  # [m]: where soil moves
PUBLISHED, EQUILIBRIUM = 1.25, 1.8  # [kPa]


def draw_slide(found: Studies, path: Path) -> None:
    """Draw how far the points have moved, on the finest cells."""
    points = list(found.finer.values())[-1].points
    moved = np.hypot(points["displacement_x"], points["displacement_y"])
    with drawing():
        figure = new_figure(WIDTH, panel_height(FRAME))
        draw_panel(
            figure, figure.add_subplot(), points, moved, outline(study(slope.NAME)), FRAME,
            (0.0, float(np.ceil(moved.max()))), "displacement [m]",
        )  # fmt: skip
        save(figure, path)


def draw_studies(found: Studies, path: Path) -> None:
    """Draw what cells, cohesion and stiffness change."""
    with drawing():
        figure = new_figure(WIDTH, 3.0)
        held, reach, travel = figure.subplots(1, 3)
        for shape, colour in (("quadratic_bspline", BLUE), ("linear", ORANGE)):
            held.plot(list(found.held), [one[shape] for one in found.held.values()], "o-", ms=4, color=colour)
        for level, words in ((PUBLISHED, "published"), (EQUILIBRIUM, "limit equilibrium")):
            held.axhline(level, color=GREY, lw=1.0, ls="--")
            held.text(max(found.held), level + 0.02, words, ha="right", fontsize=8)
        held.set(xlabel="cell [m]", ylabel="cohesion that holds [kPa]", ylim=(-0.1, 2.1))
        reach.plot(list(found.finer), [one.run_out for one in found.finer.values()], "o-", ms=4, color=BLUE)
        reach.set(xlabel="cell [m]", ylabel="run-out [m]", ylim=(0.0, None))
        means = [one.mean for one in found.stronger.values()]
        travel.semilogy(list(found.stronger), means, "o-", ms=4, color=BLUE, label="30 MPa")
        at = [min(found.stronger)] * (len(found.softer) - 1)
        travel.semilogy(at, [one.mean for one in found.softer[1:]], "x", color=VERMILION, label="60, 150, 300 MPa")
        travel.set(xlabel="cohesion [kPa]", ylabel="mean travel [m]")
        travel.legend(loc="lower left")
        save(figure, path)


def draw_histories(histories: Mapping[float, Mapping[str, np.ndarray]], path: Path) -> None:
    """Draw displacement, speed and acceleration of the named places, by stiffness [kPa]."""
    labels = ("displacement [m]", "speed [m/s]", "acceleration [m/s2]")
    with drawing():
        figure = new_figure(WIDTH, 2.7)
        for k, (axes, label) in enumerate(zip(figure.subplots(1, 3), labels, strict=True)):
            for (stiffness, seen), style in zip(histories.items(), ("-", "--"), strict=True):
                for place, colour in zip(slope.PLACES, (BLUE, ORANGE, VERMILION), strict=True):
                    words = f"{place}, {1e-3 * stiffness:g} MPa"
                    axes.plot(seen["time"], seen[place][k], style, color=colour, lw=1.3, label=words)
            axes.set(xlabel="time [s]", ylabel=label)
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        save(figure, path)
