"""The picture of the estimators: root-mean-square error over cost."""

from pathlib import Path

import numpy as np

from rfmpm.benchmark.probabilities.repeats import Judged
from rfmpm.benchmark.probabilities.slope import Reference
from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREY, ORANGE, VERMILION, drawing, new_figure

COLOURS = (GREY, ORANGE, BLUE, VERMILION)
UNITS = {"mean": "m", "P(> 5 m)": "-", "95 % quantile": "m"}


def draw(judged: dict[str, dict[str, list[Judged]]], references: dict[str, Reference], path: Path) -> None:
    """Draw the error over the cost.

    Args:
        judged: by question, by estimator, for each size.
        references: by question.
        path: the picture.
    """
    with drawing():
        figure = new_figure(11.0, 3.9)
        for axes, (question, found) in zip(figure.subplots(1, len(judged)), judged.items(), strict=True):
            for colour, (name, points) in zip(COLOURS, found.items(), strict=True):
                cost = [point.cost for point in points]
                axes.plot(cost, [point.root_mean_square_error for point in points], "o-", color=colour, label=name)
            span = np.array(sorted({point.cost for points in found.values() for point in points}))[[0, -1]]
            if np.isfinite(deviation := references[question].deviation):
                axes.plot(span, deviation / np.sqrt(span), "--", color=GREY, lw=1.0)
            axes.set(xscale="log", yscale="log", title=question, xlabel="cost in realisations on cells of 0.25 m")
            axes.set_ylabel(f"root-mean-square error [{UNITS[question]}]")
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)
