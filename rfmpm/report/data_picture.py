"""A field conditioned on data: what it makes of them, in a picture and in words."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rfmpm.report.correlation_figure import draw_correlations
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import (
    BLUE,
    DOTS_PER_INCH,
    GREY,
    ORANGE,
    STRAIN_MAP,
    STRENGTH_MAP,
    VERMILION,
    drawing,
    new_figure,
)


def data_lines(field, xis: Sequence[np.ndarray]) -> list[str]:
    """Say how the data are honoured; nothing for a field without data.

    Args:
        field: the prepared field.
        xis: vectors of realisations, each of shape (n_variables,) [-].
    """
    from rfmpm.random_fields.field import realise

    if field.conditioning is None:
        return []
    conditioning = field.conditioning
    exact = conditioning.data.error_variances == 0.0
    on_points = conditioning.on_points >= 0
    lines = [
        f"conditioned on {len(exact)} data, {exact.sum()} of them exact, {on_points.sum()} on points; "
        "asked: the conditional distribution, averaged over the points",
        f"largest error of the conditional covariance beyond that of the method {conditioning.covariance_error:.1e}",
        f"data up to {np.abs(conditioning.data.values).max():.2f} standard deviations from the median of the field",
    ]
    if np.any(held := exact & on_points):
        measured, points = field.data.values[held], conditioning.on_points[held]
        misfit = max(float(np.abs(realise(field, xi)[points] / measured - 1.0).max()) for xi in xis)
        lines.append(f"largest relative misfit at exact data on points {misfit:.1e}, over {len(xis)} realisations")
    return lines


def draw_conditional(
    study, index: int, look, points: np.ndarray, field, sample: np.ndarray, records: Sequence, path: Path
) -> None:
    """Draw data, conditional mean and standard deviation, two realisations, and the statistics.

    Args:
        study: the Study.
        index: of the first realisation.
        look: title, name and units of the property.
        points: positions, shape (n, 2) [m].
        field: the prepared field.
        sample: realisations from that index on, shape (count, n), in the unit of the look.
        records: their statistics.
        path: gets the picture.
    """
    from rfmpm.mpm.scene import outline
    from rfmpm.random_fields.measurements import conditional_moments

    conditioning = field.conditioning
    mean, deviation = conditional_moments(field.marginal, conditioning.mean, conditioning.deviation)
    places = conditioning.data.places
    label, unit = f"{look.field} [{look.unit}]", look.per_field_unit
    polygon = outline(study)
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    height = panel_height(frame) + 0.35
    low, high = np.reshape(frame, (2, 2)).T
    inside = np.all((places >= low) & (places <= high), axis=1)
    ends = tuple(np.percentile(sample[:2], [1.0, 99.0]))
    spread = (0.0, float(np.max(deviation)) / unit)
    panels = [
        ("Conditional mean", mean / unit, ends, label, STRENGTH_MAP),
        (f"Realisation {index}", sample[0], ends, label, STRENGTH_MAP),
        (f"Realisation {index + 1}", sample[1], ends, label, STRENGTH_MAP),
        ("Conditional standard deviation", deviation / unit, spread, f"[{look.unit}]", STRAIN_MAP),
    ]
    with drawing():
        figure = new_figure(WIDTH, 4.0 * height + 3.3)
        grid = figure.add_gridspec(5, 2, height_ratios=[height] * 4 + [3.3])
        for row, (title, values, colours, words, colour_map) in enumerate(panels):
            axes = figure.add_subplot(grid[row, :])
            axes.set_title(f"{title}; circles: data, {inside.sum()} of {len(inside)} in the frame")
            cloud = {"x": points[:, 0], "y": points[:, 1]}
            draw_panel(figure, axes, cloud, values, polygon, frame, colours, words, colour_map)
            circle = {"s": 26, "edgecolors": VERMILION, "lw": 1.0}
            if colours is spread:
                axes.scatter(*places[inside].T, facecolors="none", **circle)
            else:
                measured, (low, high) = field.data.values[inside] / unit, colours
                axes.scatter(*places[inside].T, c=measured, vmin=low, vmax=high, cmap=colour_map, **circle)
        _draw_profile(figure.add_subplot(grid[4, 0]), field, index, look, sample, points)
        draw_correlations(figure.add_subplot(grid[4, 1]), records)
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH)


def _draw_profile(axes, field, index: int, look, sample: np.ndarray, points: np.ndarray) -> None:
    """Values down the column of points that is nearest to the vertical line with most data."""
    from rfmpm.random_fields.measurements import conditional_moments

    places, values = field.data.places, field.data.values / look.per_field_unit
    lines, counts = np.unique(np.round(places[:, 0], 6), return_counts=True)
    line = lines[np.argmax(counts)]
    nearest = points[np.argmin(np.abs(points[:, 0] - line)), 0]
    column = np.flatnonzero(np.abs(points[:, 0] - nearest) < 1e-6)
    column = column[np.argsort(points[column, 1])]
    y = points[column, 1]
    mean, deviation = conditional_moments(field.marginal, field.conditioning.mean, field.conditioning.deviation)
    mean, deviation = mean[column] / look.per_field_unit, deviation[column] / look.per_field_unit
    axes.fill_betweenx(y, mean - 2.0 * deviation, mean + 2.0 * deviation, color=BLUE, alpha=0.15, lw=0)
    axes.plot(mean, y, color=BLUE, label="conditional mean ± 2 std. dev.")
    for k, colour in ((0, GREY), (1, ORANGE)):
        axes.plot(sample[k, column], y, color=colour, lw=0.9, label=f"realisation {index + k}")
    there = np.round(places[:, 0], 6) == line
    axes.plot(values[there], places[there, 1], "o", ms=4, color=VERMILION, label=f"data at x = {line:g} m")
    axes.set(xlabel=f"{look.field} [{look.unit}]", ylabel="y [m]", title=f"Points at x = {nearest:.4g} m")
    axes.legend(loc="best", fontsize=7)
