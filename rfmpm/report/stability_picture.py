"""Picture of a factor of safety: the slope, the strength of its soil, and the surface on which it would slide."""

from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.report.slope_figures import WIDTH, draw_panel, panel_height, view
from rfmpm.report.style import STRENGTH_MAP, VERMILION, drawing, new_figure, save


def write_stability_picture(prepared: Any, strength: Any, found: Any, title: str, path: Path) -> None:
    """Picture the cohesion of a realisation, its angle of friction too where that varies, and the slip surface.

    Args:
        prepared: the prepared study.
        strength: of the material points: `cohesion` [Pa] and `friction_angle` [rad], shape (n,) each.
        found: what a method found: its `factor`, and the corners of its `surface`, shape (k, 2) [m], where it has one.
        title: method and realisation.
        path: PNG file to write.
    """
    polygon = prepared.scene.body.outline
    x, y = prepared.scene.points.position
    frame = view([polygon[:, 0]], [polygon[:, 1]])
    panels = [(strength.cohesion / 1e3, "cohesion [kPa]")]
    if np.ptp(strength.friction_angle) > 0.0:
        panels.append((np.degrees(strength.friction_angle), "angle of friction [degrees]"))
    factor = "no solution" if found.factor == inf else f"factor of safety {found.factor:.3f}"
    with drawing():
        figure = new_figure(WIDTH, len(panels) * (panel_height(frame) + 0.35))
        for axes, (values, label) in zip(figure.subplots(len(panels), 1, squeeze=False)[:, 0], panels, strict=True):
            low, high = np.percentile(values, [1.0, 99.0])
            ends = (low, high) if high > low else (0.0, 2.0 * max(high, 1e-3))  # one colour where nothing varies
            draw_panel(figure, axes, {"x": x, "y": y}, values, polygon, frame, ends, label, STRENGTH_MAP)
            axes.set_title(f"{factor}: {title}")
            surface = getattr(found, "surface", None)
            if surface is not None:
                axes.plot(*np.asarray(surface).T, color=VERMILION, linewidth=2.2)
        save(figure, path)
