"""A random field without data: one realisation, and the statistics of many soil by soil."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rfmpm.report.correlation_figure import draw_correlations
from rfmpm.report.field_table import soil_name
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import BLUE, STRENGTH_MAP, VERMILION, drawing, new_figure, save

CHART_HEIGHT = 3.3  # inches


def draw_field(study, index: int, look, drawn: tuple[np.ndarray, np.ndarray], soils: Sequence, path: Path) -> None:
    """Draw the whole body, and below it distribution and correlation of each soil.

    Args:
        study: the Study.
        index: of the realisation drawn, the first of those compared.
        look: title, names and units of the property.
        drawn: positions of the material points, shape (n, 2) [m], and values, shape (n,), in the unit of its label.
        soils: its soils, compared.
        path: gets the picture.
    """
    from rfmpm.mpm.scene import outline

    polygon = outline(study)
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    height = panel_height(frame) + 0.35
    rows = [height] + [CHART_HEIGHT] * len(soils)
    with drawing():
        figure = new_figure(WIDTH, sum(rows))
        grid = figure.add_gridspec(len(rows), 2, height_ratios=rows)
        axes = figure.add_subplot(grid[0, :])
        axes.set_title(f"{look.title}, realisation {index}")
        (x, y), values = drawn[0].T, drawn[1]
        ends = tuple(np.percentile(values, [1.0, 99.0]))
        draw_panel(figure, axes, {"x": x, "y": y}, values, polygon, frame, ends, look.label, STRENGTH_MAP)
        for row, soil in enumerate(soils, start=1):
            of = f", {soil_name(soil.part.soil)}" if len(soils) > 1 else ""
            _histogram(figure.add_subplot(grid[row, 0]), index, look, soil, of)
            draw_correlations(figure.add_subplot(grid[row, 1]), soil.statistics, of)
        save(figure, path)


def _histogram(axes, index: int, look, soil, of: str) -> None:
    # The asked density by change of variable from the standard normal: it needs no formula of each distribution.
    z = np.linspace(-4.0, 4.0, 801)
    value, sample = soil.part.at_crest.marginal.transform(z) / look.per_field_unit, soil.sample / look.per_field_unit
    density = np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi) / np.gradient(value, z)
    edges = np.linspace(*np.percentile(sample, [0.05, 99.95]), 41)
    axes.hist(sample.ravel(), bins=edges, density=True, color=BLUE, alpha=0.3, label=f"{len(sample)} realisations")
    axes.hist(sample[0], bins=edges, density=True, histtype="step", color=BLUE, label=f"realisation {index}")
    axes.plot(value, density, color=VERMILION, label="asked")
    axes.set(xlabel=f"{look.field} [{look.unit}]", ylabel="density", title=f"Distribution{of}", xlim=edges[[0, -1]])
    axes.legend(loc="upper right")
