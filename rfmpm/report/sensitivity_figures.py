"""Pictures of what drives a quantity: shares of its variance by uncertain number, and places where its field does."""

import numpy as np

from rfmpm.estimators.influence import Influence
from rfmpm.estimators.sensitivity import GivenData, SobolIndices
from rfmpm.report import words
from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import BLUE, CHART, GREY, ORANGE, VERMILION, Picture, drawing, encode, new_figure

FIELDS = "random fields"  # the group of all that the fields take
INFLUENCE_MAP = "PuOr"  # orange below zero, purple above, white between
INSIGNIFICANT = "#d4d4d4"
UNITS = ("kpa_per_m", "kpa_s", "kn_m3", "kpa", "deg", "m")
DIRECTIONS = {" h": ", horizontal", " v": ", vertical"}
BAR = 0.36  # of the distance between two groups
ROW = 0.42  # inches for a group


def label_of(key: str) -> str:
    """Say an uncertain number in words: 'cohesion: scale of fluctuation, horizontal' for one of a random field."""
    *places, name = key.split(".")
    for unit in UNITS:
        if name.endswith(f"_{unit}"):
            name = name.removesuffix(f"_{unit}")
            break
    name = name.replace("_", " ")
    name = name[:-2] + DIRECTIONS.get(name[-2:], name[-2:])
    if places[0] == "boundary":
        return f"friction of the {places[1]}"
    if "random_field" not in places:
        return name
    at = places.index("random_field")
    layer = f", layer {int(places[at + 3]) + 1}" if "layer" in places else ""
    soil = f" of material {int(places[1]) + 1}" if at else ""
    return f"{places[at + 1].replace('_', ' ')}{soil}{layer}: {name}"


def group_labels(keys: list[str], has_fields: bool) -> list[str]:
    """Labels of the groups of a design: the uncertain numbers, then the random fields where there are some."""
    return [label_of(key) for key in keys] + ([FIELDS] if has_fields else [])


def sobol_chart(labels: list[str], indices: SobolIndices, quantity: str) -> Picture:
    """Draw first-order and total indices with their intervals.

    Args:
        labels: of the groups.
        indices: of the groups.
        quantity: in words, e.g. "run-out" or "P(run-out > 5 m)".

    Returns:
        The picture.
    """
    series = [
        ("alone (first order)", indices.first, indices.first_interval, BLUE),
        ("with all it acts with (total)", indices.total, indices.total_interval, ORANGE),
    ]
    with drawing():
        figure, axes = _bars(labels, series)
        axes.set(xlabel=f"share of the variance of {quantity}")
        source = encode(figure)
    left_out = (
        f" {words.count(indices.dropped, 'base point')} with a failed simulation left out." if indices.dropped else ""
    )
    strongest = labels[int(np.nanargmax(indices.total))] if np.isfinite(indices.total).any() else "nothing"
    return Picture(
        f"What the variance of {quantity} comes from",
        source,
        f"Bars of the first-order and total Sobol index of {', '.join(labels)}; the largest total one is that of "
        f"{strongest}.",
        f"{words.count(indices.base_points, 'base point')}; lines: 95 % intervals from resampled base points. The "
        f"variance would fall by the first share if that number were known.{left_out}",
    )


def given_data_chart(labels: list[str], found: GivenData, quantity: str) -> Picture:
    """Draw first-order indices from an ordinary campaign, with what chance alone would show; arguments as above."""
    with drawing():
        figure, axes = _bars(labels, [("share of the variance", found.first, found.interval, BLUE)])
        places = np.arange(len(labels))
        axes.plot(found.noise, places, "|", color=VERMILION, ms=16, mew=2, label="chance stays below this (95 %)")
        axes.set(xlabel=f"share of the variance of {quantity}")
        _legend(figure)
        source = encode(figure)
    above = [label for label, is_above in zip(labels, found.first > found.noise, strict=True) if is_above]
    left_out = f" {words.count(found.dropped, 'failed realisation')} left out." if found.dropped else ""
    return Picture(
        f"What the variance of {quantity} comes from",
        source,
        f"Bars of the share of the variance that {', '.join(labels)} have alone; above what chance shows: "
        f"{', '.join(above) or 'none'}.",
        f"First-order indices from {words.count(found.rows, 'realisation')}, by classes of each number; lines: 95 % "
        f"intervals. What is left comes from the random fields and from numbers acting together.{left_out}",
    )


def influence_map(
    points: np.ndarray, found: Influence, outline: np.ndarray, field: str = "cohesion", quantity: str = "run-out"
) -> Picture:
    """Draw where in the slope a field drives a quantity; what chance alone may show is grey.

    Args:
        points: material points, shape (n, 2) [m].
        found: correlation at these points.
        outline: polygon of the initial body, shape (k, 2) [m].
        field: in words.
        quantity: in words.

    Returns:
        The picture.
    """
    frame = view([points[:, 0], outline[:, 0]], [points[:, 1], outline[:, 1]])
    shown = np.where(found.is_significant, found.correlation, np.nan)
    end = float(np.max(np.abs(found.correlation), initial=0.1))
    with drawing():
        figure = new_figure(WIDTH, panel_height(frame))
        axes = figure.add_subplot()
        place = {"x": points[:, 0], "y": points[:, 1]}
        label = "correlation [-]"
        cloud = draw_panel(figure, axes, place, shown, outline, frame, (-end, end), label, INFLUENCE_MAP)
        rest = ~found.is_significant
        size = float(cloud.get_sizes()[0])
        axes.scatter(points[rest, 0], points[rest, 1], s=size, color=INSIGNIFICANT, lw=0, rasterized=True, zorder=0.9)
        source = encode(figure)
    return Picture(
        f"Where {field} drives {quantity}",
        source,
        _spoken(points, found, field, quantity),
        f"Correlation of {field} at each place with {quantity}, {words.count(found.rows, 'realisation')}. Grey: below "
        f"{found.noise_anywhere:.2f}, which chance alone exceeds somewhere in the slope in 5 % of cases.",
    )


def _spoken(points: np.ndarray, found: Influence, field: str, quantity: str) -> str:
    if not found.is_significant.any():
        return f"Cross-section of the slope, all grey: no place where {field} is seen to drive {quantity}."
    most = int(np.argmax(np.abs(found.correlation)))
    x, y = points[most]
    return (
        f"Cross-section of the slope coloured by correlation; it is strongest, {found.correlation[most]:.2f}, at "
        f"x = {x:.1f} m, y = {y:.1f} m, and beyond chance at {np.mean(found.is_significant):.0%} of the places."
    )


def _bars(labels: list[str], series):
    width, height = CHART
    figure = new_figure(width, max(0.6 * height, 1.1 + ROW * len(labels)))
    axes = figure.add_subplot()
    places, thick = np.arange(len(labels)), 2.0 * BAR / len(series)
    for number, (name, value, interval, colour) in enumerate(series):
        at = places + (number - 0.5 * (len(series) - 1)) * thick
        axes.barh(at, np.nan_to_num(value), 0.9 * thick, color=colour, label=name)
        axes.hlines(at, interval[:, 0], interval[:, 1], color=GREY, lw=1.4)
    axes.axvline(0.0, color=GREY, lw=0.8)
    axes.set_yticks(places, labels)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    if len(series) > 1:
        _legend(figure)
    return figure, axes


def _legend(figure) -> None:
    figure.legend(loc="outside lower center", ncols=2, handlelength=1.4, columnspacing=1.4)
