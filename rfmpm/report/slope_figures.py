"""Pictures of the slope: the initial outline and the points, coloured by what they carry."""

from collections.abc import Sequence

import numpy as np

from rfmpm.report import words
from rfmpm.report.snapshots import Snapshot
from rfmpm.report.style import GREY, STRAIN_MAP, Picture, drawing, encode, new_figure

WIDTH = 8.6  # inches
WIDEST_COLOUR_SPAN = 80.0  # percentile of the yielded points at the end of the colours, so that narrow bands show
THUMBNAIL = 3.4  # inches


def slope_pictures(chosen: Sequence[Snapshot], thumbs: Sequence[Snapshot], outline: np.ndarray):
    """Draw the final plastic strain of some realisations, all in the same frame and colours.

    Args:
        chosen: realisations to draw large.
        thumbs: realisations to draw small.
        outline: polygon of the initial body, shape (k, 2) [m].

    Returns:
        Two lists of pictures, one for each realisation.
    """
    every = [*chosen, *thumbs]
    if not every:
        return [], []
    frame = view([outline[:, 0], *(s.points["x"] for s in every)], [outline[:, 1], *(s.points["y"] for s in every)])
    top = strain_limit(s.points["plastic_strain"] for s in every)
    with drawing():
        return (
            [_picture(snapshot, outline, frame, top) for snapshot in chosen],
            [_thumbnail(snapshot, outline, frame, top) for snapshot in thumbs],
        )


def _picture(snapshot: Snapshot, outline: np.ndarray, frame, top: float) -> Picture:
    figure = new_figure(WIDTH, panel_height(frame))
    axes = figure.add_subplot()
    strain = snapshot.points["plastic_strain"]
    draw_panel(figure, axes, snapshot.points, strain, outline, frame, (0.0, top), "plastic strain [-]")
    return Picture(
        f"{snapshot.name[0].upper()}{snapshot.name[1:]} run-out: {words.number(snapshot.recorded)} m",
        encode(figure),
        _description(snapshot),
        f"Realisation {snapshot.index}. {_repetition(snapshot)}",
    )


def _thumbnail(snapshot: Snapshot, outline: np.ndarray, frame, top: float) -> Picture:
    left, right, bottom, above = frame
    figure = new_figure(THUMBNAIL, THUMBNAIL * (above - bottom) / (right - left) + 0.1)
    axes = figure.add_subplot()
    strain = snapshot.points["plastic_strain"]
    cloud = _draw_points(axes, snapshot.points, strain, outline, frame, (0.0, top), STRAIN_MAP)
    axes.set_axis_off()
    _fill(axes, cloud, outline)
    return Picture(
        snapshot.name,
        encode(figure),
        _description(snapshot),
        f"Typical: realisation {snapshot.index}, run-out {words.number(snapshot.recorded)} m.",
    )


def _description(snapshot: Snapshot) -> str:
    return (
        f"Cross-section of the slope at the end of realisation {snapshot.index}, run-out "
        f"{words.number(snapshot.recorded)} m: points coloured by plastic strain over the dashed initial outline; "
        "bright bands are where the soil sheared."
    )


def _repetition(snapshot: Snapshot) -> str:
    if snapshot.is_same:
        return "Simulated again for this picture; the run-out is the recorded one, bit for bit."
    return (
        f"Simulated again for this picture; the run-out came out as {snapshot.found!r} m instead of "
        f"{snapshot.recorded!r} m, so the picture is not exactly the realisation on record."
    )


def view(xs: Sequence[np.ndarray], ys: Sequence[np.ndarray]) -> tuple[float, float, float, float]:
    """Return the frame that holds all positions with a margin: left, right, bottom, top [m]."""
    x, y = np.concatenate(xs), np.concatenate(ys)
    margin = 0.02 * np.nanmax([np.nanmax(x) - np.nanmin(x), 1.0])
    return tuple(
        map(float, (np.nanmin(x) - margin, np.nanmax(x) + margin, np.nanmin(y) - margin, np.nanmax(y) + margin))
    )


def strain_limit(strains) -> float:
    """Return where the colours of plastic strain end: a high percentile of all points, or 1 if nothing has yielded."""
    together = np.concatenate([np.asarray(s)[np.isfinite(s)] for s in strains])
    yielded = together[together > 0.0]
    return float(f"{np.percentile(yielded, WIDEST_COLOUR_SPAN):.2g}") if yielded.size else 1.0


def panel_height(frame) -> float:
    """Return the height in inches that a panel of WIDTH needs to show its frame in equal aspect with labels."""
    left, right, bottom, top = frame
    return float(np.clip((WIDTH - 1.7) * (top - bottom) / (right - left), 0.9, 6.0)) + 0.75


def draw_panel(figure, axes, points, values, outline, frame, colours, label: str, colour_map: str = STRAIN_MAP):
    """Draw one cross-section: points in colour, the initial outline dashed, axes in metres, a colour bar.

    Args:
        figure: the figure.
        axes: the axes to draw in.
        points: x and y, each of shape (n,) [m].
        values: what the colours show, shape (n,).
        outline: polygon of the initial body, shape (k, 2) [m].
        frame: left, right, bottom and top [m].
        colours: values at the two ends of the colours.
        label: of the colour bar, with unit.
        colour_map: name of the colours.

    Returns:
        The drawn points.
    """
    values = np.asarray(values)
    cloud = _draw_points(axes, points, values, outline, frame, colours, colour_map)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    low, high = colours
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[
        (bool(np.any(values < low)), bool(np.any(values > high)))
    ]
    # Inside the axes' own frame, so that the bar is as tall as the panel whatever equal aspect makes of it.
    figure.colorbar(cloud, cax=axes.inset_axes((1.015, 0.0, 0.018, 1.0)), label=label, extend=extend)
    _fill(axes, cloud, outline)
    return cloud


def _draw_points(axes, points, values, outline, frame, colours, colour_map: str):
    """The points in colour over the initial outline; arguments as of `draw_panel`."""
    from matplotlib import patheffects

    axes.set_aspect("equal")
    axes.set(xlim=frame[:2], ylim=frame[2:])
    axes.grid(visible=False)
    low, high = colours
    cloud = axes.scatter(
        points["x"], points["y"], c=values, vmin=low, vmax=high, cmap=colour_map, lw=0, rasterized=True
    )
    closed = np.vstack([outline, outline[:1]])
    halo = [patheffects.withStroke(linewidth=2.6, foreground="white")]  # seen on dark points too
    axes.plot(closed[:, 0], closed[:, 1], color=GREY, lw=1.2, ls="--", path_effects=halo)
    return cloud


def _fill(axes, cloud, outline: np.ndarray) -> None:
    """Make the points so large that no gaps show where the soil has not spread."""
    axes.figure.draw_without_rendering()  # settles the layout, so that the size of a metre is known
    cloud.set_sizes([_marker_area(axes, outline, len(cloud.get_offsets()))])


def _marker_area(axes, outline: np.ndarray, n: int) -> float:
    """Area of a marker in points squared, such that no gaps show where the soil has not spread."""
    x, y = outline[:, 0], outline[:, 1]
    area = 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
    spacing = np.sqrt(area / max(n, 1))
    per_metre = axes.transData.transform([(0.0, 0.0), (1.0, 0.0)])
    size = (per_metre[1, 0] - per_metre[0, 0]) * 72.0 / axes.figure.dpi * spacing
    return float(max(1.45 * size, 0.6) ** 2)
