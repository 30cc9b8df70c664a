"""The picture of the estimators: root-mean-square error over cost."""

from pathlib import Path

from rfmpm.benchmark.probabilities.repeats import Judged
from rfmpm.report.style import BLUE, DOTS_PER_INCH, GREEN, GREY, ORANGE, VERMILION, drawing, new_figure

COLOURS = (GREY, ORANGE, BLUE, GREEN, VERMILION)
UNITS = {"mean": "m", "P(> 5 m)": "-", "95 % quantile": "m"}


def draw(judged: dict[str, dict[str, list[Judged]]], path: Path) -> None:
    """Draw the error over the cost.

    Args:
        judged: by question, by estimator, for each size.
        path: the picture.
    """
    with drawing():
        figure = new_figure(11.0, 3.9)
        for axes, (question, found) in zip(figure.subplots(1, len(judged)), judged.items(), strict=True):
            for colour, (name, points) in zip(COLOURS, found.items(), strict=True):
                cost = [point.cost for point in points]
                axes.plot(cost, [point.root_mean_square_error for point in points], "o-", color=colour, label=name)
            axes.set(xscale="log", yscale="log", title=question, xlabel="cost in realisations on cells of 0.25 m")
            axes.set_ylabel(f"root-mean-square error [{UNITS[question]}]")
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=5)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)
