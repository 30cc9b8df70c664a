"""A field conditioned on data: what it makes of them, in a picture of the whole body."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm.report.correlation_figure import draw_correlations
from rfmpm.report.field_table import soil_name
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import (
    BLUE,
    GREY,
    ORANGE,
    STRAIN_MAP,
    STRENGTH_MAP,
    VERMILION,
    drawing,
    new_figure,
    save,
)

CHART_HEIGHT = 3.3  # inches


class Body(NamedTuple):
    """A property of the whole body, in the unit of its field's picture.

    Attributes:
        carriers: what the points are called.
        points: those that carry the field and are used, shape (n, 2) [m].
        mean: conditional mean, shape (n,).
        deviation: conditional standard deviation, shape (n,).
        sample: two realisations, shape (2, n).
        places: of the data, shape (d, 2) [m]; those of an earlier property if only that has data.
        values: measured, shape (d,); None where the data are of another property.
    """

    carriers: str
    points: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray
    sample: np.ndarray
    places: np.ndarray
    values: np.ndarray | None


def draw_conditional(study, index: int, look, entry, soils: Sequence, fields: Sequence[np.ndarray], path: Path) -> None:
    """Draw data, conditional mean and standard deviation, two realisations, and the statistics of each soil.

    Args:
        study: the Study.
        index: of the first realisation.
        look: title, name and units of the property.
        entry: the prepared property.
        soils: its soils, compared.
        fields: two standard-normal fields from that index on, each of shape (count of the property,) [-].
        path: gets the picture.
    """
    from rfmpm.mpm.scene import outline

    body = _body(entry, soils, fields, look.per_field_unit)
    polygon = outline(study)
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    height = panel_height(frame) + 0.35
    charts = 1 + len(soils)
    rows = [height] * 4 + [CHART_HEIGHT] * (-(-charts // 2))
    with drawing():
        figure = new_figure(WIDTH, sum(rows))
        grid = figure.add_gridspec(len(rows), 2, height_ratios=rows)
        _draw_maps(figure, grid, body, index, look, polygon, frame)
        places = iter([(4 + k // 2, k % 2) for k in range(charts)])
        _draw_profile(figure.add_subplot(grid[next(places)]), body, index, look)
        for soil in soils:
            of = f", {soil_name(soil.part.soil)}" if len(soils) > 1 else ""
            draw_correlations(figure.add_subplot(grid[next(places)]), soil.statistics, of)
        save(figure, path)


def _body(entry, soils: Sequence, fields: Sequence[np.ndarray], unit: float) -> Body:
    """Put the soils together."""
    from rfmpm.random_fields.measurements import conditional_moments
    from rfmpm.random_fields.statistics import conditional_normal, is_conditional

    points, columns = np.empty((entry.count, 2)), np.empty((4, entry.count))
    known = [share.conditioning.data.places for soil in soils for share in soil.shares if share.conditioning]
    values = [soil.part.field.data.values / unit for soil in soils if soil.part.field.data is not None]
    for soil in soils:
        part = soil.part
        marginal, nothing = part.field.marginal, np.zeros(len(part.points))
        moments = conditional_normal(soil.shares) if is_conditional(soil.shares) else (nothing, nothing + 1.0)
        points[part.members] = part.points
        columns[:2, part.members] = conditional_moments(marginal, *moments)
        columns[2:, part.members] = [marginal.transform(z[part.members]) for z in fields]
    used = slice(None) if entry.taken is None else np.unique(entry.taken)
    mean, deviation, *sample = columns[:, used] / unit
    measured = np.concatenate(values) if values else None
    carriers = "Points" if entry.taken is None else "Reference points"
    return Body(carriers, points[used], mean, deviation, np.array(sample), np.vstack(known), measured)


def _draw_maps(figure, grid, body: Body, index: int, look, polygon: np.ndarray, frame: tuple) -> None:
    low, high = np.reshape(frame, (2, 2)).T
    inside = np.all((body.places >= low) & (body.places <= high), axis=1)
    label = f"{look.field} [{look.unit}]"
    ends = tuple(np.percentile(body.sample, [1.0, 99.0]))
    spread = (0.0, float(np.max(body.deviation)))
    panels = [
        ("Conditional mean", body.mean, ends, label, STRENGTH_MAP),
        (f"Realisation {index}", body.sample[0], ends, label, STRENGTH_MAP),
        (f"Realisation {index + 1}", body.sample[1], ends, label, STRENGTH_MAP),
        ("Conditional standard deviation", body.deviation, spread, f"[{look.unit}]", STRAIN_MAP),
    ]
    of = "data" if body.values is not None else "data of what it is correlated with"
    shown = f"; circles: {of}, {inside.sum()} of {len(inside)} in the frame"
    cloud = {"x": body.points[:, 0], "y": body.points[:, 1]}
    circle = {"s": 26, "edgecolors": VERMILION, "lw": 1.0}
    for row, (title, values, colours, words, colour_map) in enumerate(panels):
        axes = figure.add_subplot(grid[row, :])
        axes.set_title(title + shown)
        draw_panel(figure, axes, cloud, values, polygon, frame, colours, words, colour_map)
        if colours is spread or body.values is None:
            axes.scatter(*body.places[inside].T, facecolors="none", **circle)
        else:
            colour = {"c": body.values[inside], "vmin": colours[0], "vmax": colours[1], "cmap": colour_map}
            axes.scatter(*body.places[inside].T, **colour, **circle)


def _draw_profile(axes, body: Body, index: int, look) -> None:
    """Values down the column of points that is nearest to the vertical line with most data."""
    lines, counts = np.unique(np.round(body.places[:, 0], 6), return_counts=True)
    line = lines[np.argmax(counts)]
    nearest = body.points[np.argmin(np.abs(body.points[:, 0] - line)), 0]
    column = np.flatnonzero(np.abs(body.points[:, 0] - nearest) < 1e-6)
    column = column[np.argsort(body.points[column, 1])]
    y, mean, deviation = body.points[column, 1], body.mean[column], body.deviation[column]
    axes.fill_betweenx(y, mean - 2.0 * deviation, mean + 2.0 * deviation, color=BLUE, alpha=0.15, lw=0)
    axes.plot(mean, y, color=BLUE, label="conditional mean ± 2 std. dev.")
    for k, colour in ((0, GREY), (1, ORANGE)):
        axes.plot(body.sample[k, column], y, color=colour, lw=0.9, label=f"realisation {index + k}")
    there = np.round(body.places[:, 0], 6) == line
    if body.values is not None:
        label = f"data at x = {line:g} m"
        axes.plot(body.values[there], body.places[there, 1], "o", ms=4, color=VERMILION, label=label)
    axes.set(xlabel=f"{look.field} [{look.unit}]", ylabel="y [m]", title=f"{body.carriers} at x = {nearest:.4g} m")
    axes.legend(loc="best", fontsize=7)
