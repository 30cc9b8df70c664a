"""Picture of a set-up before anything moves: soils, material points, boundaries, cuts, toe and crest."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.report.style import VERMILION, drawing, new_figure, save

WIDTH, SMALLEST_HEIGHT, LARGEST_HEIGHT = 8.0, 2.6, 7.0  # inches
FILLS = ("#d8c49b", "#b6c9a2", "#c3b4d0", "#a9c3d6", "#e2b59a", "#cfcfcf")
MOST_POINTS = 50_000  # that are drawn one by one


def write_setup_picture(study: Any, path: Path) -> None:
    """Draw the set-up of a study.

    Args:
        study: the Study.
        path: PNG file to write.
    """
    from rfmpm.mpm.geometry import body, fill_body

    shape = body(study)
    points, removed = fill_body(study, shape)
    height = np.clip(WIDTH * shape.top / shape.length + 1.4, SMALLEST_HEIGHT, LARGEST_HEIGHT)
    with drawing():
        figure = new_figure(WIDTH, height)
        axes = figure.subplots()
        _draw_soils(axes, study)
        for filling, colour in ((points, "black"), (removed, VERMILION)):
            if filling is not None and len(filling.volume) <= MOST_POINTS:
                axes.plot(*filling.position.T, ".", color=colour, markersize=0.8, zorder=3)
        for cut in getattr(study.geometry, "cut", None) or ():
            corners = np.array(cut.corners_m)
            axes.fill(*corners.T, fill=False, hatch="///", edgecolor=VERMILION, linewidth=1.0, label="cut at the start")
        for load in study.load or ():
            label = f"load {load.pressure_kpa:g} kPa"
            x = np.linspace(load.from_m, load.to_m, 50)
            axes.plot(x, ground_before(shape, x), color="black", linewidth=4.0, label=label, zorder=6)
        for obstacle in study.obstacle or ():
            axes.fill(*np.array(obstacle.corners_m).T, color="black", label=f"obstacle, friction {obstacle.friction:g}")
        _draw_domain(axes, study, shape)
        for x, name in ((shape.crest_edge, "crest edge"), (shape.toe, "toe")):
            axes.axvline(x, color=VERMILION, linestyle=":", linewidth=1.0)
            axes.annotate(name, (x, shape.top), ha="right", va="top", rotation=90, fontsize=7, color=VERMILION)
        axes.set_title(f"{study.study.name}: {len(points.volume):,} points, {points.volume.sum():.4g} m²", fontsize=9)
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        axes.set_aspect("equal")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=3, fontsize=7, frameon=False)
        save(figure, path)


def _draw_soils(axes: Any, study: Any) -> None:
    from rfmpm.ground import regions_of

    names = [material.name for material in study.material]
    seen = set()
    for region in regions_of(study.geometry, names[0], study.discretisation.cell_m):
        number = names.index(region.material)
        label = None if number in seen else f"{region.material} ({study.material[number].law})"
        seen.add(number)
        for ring in _rings(region.polygon):
            axes.fill(*ring.T, facecolor=FILLS[number % len(FILLS)], edgecolor="grey", linewidth=0.8, label=label)
            label = None
        place = region.polygon.representative_point()
        axes.annotate(region.name, (place.x, place.y), ha="center", va="center", fontsize=7, zorder=4)


def ground_before(shape: Any, x: np.ndarray) -> np.ndarray:
    """Height of the ground at some x, same shape [m]."""
    from rfmpm.ground import height_at

    if shape.ground is None:
        corners = [(0.0, shape.height), (shape.crest_edge, shape.height), (shape.toe, 0.0)]
        return height_at(np.array(corners), x)
    return height_at(shape.ground, x)


def _rings(polygon: Any) -> Iterator[np.ndarray]:
    import shapely

    for piece in shapely.get_parts(polygon):
        if piece.geom_type == "Polygon":
            yield shapely.get_coordinates(piece.exterior)


def _draw_domain(axes: Any, study: Any, shape: Any) -> None:
    """Edges of the domain, with what holds there; its top is open."""
    base, sides = (_in_words(boundary) for boundary in (study.boundary.base, study.boundary.sides))
    x, y = [0.0, 0.0, shape.length, shape.length], [shape.top, 0.0, 0.0, shape.top]
    axes.plot(x, y, color="black", linewidth=1.6, label=f"base {base}, sides {sides}", zorder=5)
    margin = 0.02 * shape.length
    axes.set_xlim(-margin, shape.length + margin)
    axes.set_ylim(-margin, shape.top + margin)


def _in_words(boundary: Any) -> str:
    return f"friction {boundary.coefficient:g}" if boundary.kind == "friction" else boundary.kind
