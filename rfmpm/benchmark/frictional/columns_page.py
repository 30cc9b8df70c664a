"""The page's sections on granular columns."""

from pathlib import Path

import numpy as np

from rfmpm.benchmark.frictional import columns
from rfmpm.benchmark.frictional.cases import Section, finding
from rfmpm.benchmark.markdown import table
from rfmpm.report.slope_figures import WIDTH
from rfmpm.report.style import BLUE, GREY, ORANGE, drawing, new_figure, save

COUNTS = (10, 20)  # cells in the half width
OUTLINE = np.array([(0.0, 0.0), (0.09, 0.0), (0.09, 0.63), (0.0, 0.63)])  # of the column of 2268 points [m]
FRAME = (-0.02, 0.72, -0.02, 0.65)  # [m]
STRAIN = 3.0  # at the end of the colours


def planar(folder: Path) -> Section:
    """Run columns of every aspect ratio and draw their run-out over the two laws."""
    found = {count: [columns.run_out(aspect, count) for aspect in columns.ASPECTS] for count in COUNTS}
    spans = [columns.span(aspect) for aspect in columns.ASPECTS]
    inside = [low <= ours <= high for (low, high), ours in zip(spans, found[COUNTS[-1]], strict=True)]
    rows = [
        f"{aspect:g} | {low:.2f} to {high:.2f} | {coarse:.2f} | {fine:.2f} | {'yes' if is_inside else 'no'}"
        for aspect, (low, high), coarse, fine, is_inside in zip(
            columns.ASPECTS, spans, *found.values(), inside, strict=True
        )
    ]
    _draw_run_outs(found, folder / "frictional_columns.png")
    ours = f"{sum(inside)} of {len(inside)} inside, on cells of a twentieth of the half width"
    return Section(
        PLANAR.format(rows=table("a | two laws | L0 / 10 | L0 / 20 | L0 / 20 inside", rows)),
        [finding("columns, a = 0.5 to 8: run-out", "inside the span of two laws", ours, all(inside))],
    )


def stages(folder: Path) -> Section:
    """Run the column of 2268 points to each of its times and draw it."""
    outcomes = [columns.stage(time) for time in columns.TIMES]
    rows = [
        f"{time:g} | {theirs:g} | {len(one.points['x'])} | {one.points['x'].max():.3f} | {one.points['y'].max():.3f} "
        f"| {one.wall_time:.1f}"
        for time, theirs, one in zip(columns.TIMES, columns.EXPERIMENT, outcomes, strict=True)
    ]
    _draw_stages(outcomes, folder / "frictional_stages.png")
    head = "time [s] | in the experiment [s] | points | furthest point [m] | highest point [m] | run time [s]"
    is_whole = all(len(outcome.points["x"]) == 2268 and outcome.status == "not_at_rest" for outcome in outcomes)
    return Section(
        STAGES.format(rows=table(head, rows)),
        [finding("column of 2268 points at 0.25, 0.375, 0.5 s", "pictures, no numbers", "picture below", is_whole)],
    )


def _draw_run_outs(found, path: Path) -> None:
    with drawing():
        figure = new_figure(5.0, 3.4)
        axes, fine = figure.add_subplot(), np.geomspace(0.4, 10.0, 300)
        axes.fill_between(fine, *np.array([columns.span(a) for a in fine]).T, color="#d9d9d9", label="two laws")
        for (count, ours), colour in zip(found.items(), (ORANGE, BLUE), strict=True):
            axes.loglog(columns.ASPECTS, ours, "o", ms=4, color=colour, label=f"cells of L0 / {count}")
        axes.set(xlabel="height over half width, a", ylabel="run-out over half width")
        axes.legend()
        save(figure, path)


def _draw_stages(outcomes, path: Path) -> None:
    with drawing():
        figure = new_figure(WIDTH, 3.2)
        panels = figure.subplots(1, len(outcomes), sharey=True)
        for axes, time, outcome in zip(panels, columns.TIMES, outcomes, strict=True):
            p = outcome.points
            cloud = axes.scatter(p["x"], p["y"], c=p["plastic_strain"], s=2.0, lw=0, vmin=0.0, vmax=STRAIN)
            axes.plot(*OUTLINE.T, color=GREY, lw=1.0, ls="--")
            axes.set(title=f"{time:g} s", xlabel="x [m]", xlim=FRAME[:2], ylim=FRAME[2:], aspect="equal")
        panels[0].set_ylabel("y [m]")
        figure.colorbar(cloud, ax=panels, label="plastic strain [-]", extend="max")
        save(figure, path)


PLANAR = """## Planar columns

`configs/papers/lube_2005_columns.toml`: friction 31 degrees, rough base, half width L0. Laws of the run-out over L0:
1.2 a below an aspect ratio of 1.8, 1.9 a^(2/3) above 2.8, either of them between (Lube et al. 2005); 1.8 a below 3,
2.3 a^(2/3) above (Lajeunesse et al. 2005).

{rows}

![Run-out of the columns](frictional_columns.png)

On cells of a tenth flat columns stop short: the soil that flows is one or two cells thick.
"""

STAGES = """## The column of 2268 points

`configs/papers/vardon_2016_column_collapse.toml`: 4-node squares, Mohr-Coulomb. Neither size nor soil is given. Chosen:
9 x 63 cells of 1 cm with four points, which are 2268, so a half width of 0.09 m and a height of 0.63 m; friction 31
degrees.

{rows}

![The column at three times](frictional_stages.png)

The experiment comes to each stage 0.05 s later, as if its gate took that long to open.
"""
