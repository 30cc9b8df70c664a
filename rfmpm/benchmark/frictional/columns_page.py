"""The page's sections on granular columns."""

from pathlib import Path

import numpy as np

from rfmpm.benchmark.frictional import columns
from rfmpm.benchmark.frictional.cases import Section, finding
from rfmpm.benchmark.markdown import table
from rfmpm.report.style import BLUE, ORANGE, drawing, new_figure, save

COUNTS = (10, 20)  # cells in the half width


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


PLANAR = """## Planar columns

`configs/papers/lube_2005_columns.toml`: friction 31 degrees, rough base, half width L0. Laws of the run-out over L0:
1.2 a below an aspect ratio of 1.8, 1.9 a^(2/3) above 2.8, either of them between (Lube et al. 2005); 1.8 a below 3,
2.3 a^(2/3) above (Lajeunesse et al. 2005).

{rows}

![Run-out of the columns](frictional_columns.png)

On cells of a tenth flat columns stop short: the soil that flows is one or two cells thick.
"""
