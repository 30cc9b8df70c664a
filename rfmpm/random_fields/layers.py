"""Layers of soil with their own fields: which points lie in which, and what each layer's field is.

Layers are listed from the top down, each by the straight line that is its upper border. A point belongs to the last
layer in the list whose line it lies below, so that a deeper layer cuts off a shallower one where their lines cross; a
point on a line belongs to the soil above it. The fields of different layers are independent.
"""

from math import radians, tan
from typing import Any

import numpy as np

BORDER = 1e-9  # [m]; a point that near to a line is on it
INHERITED = ("coefficient_of_variation", "scale_of_fluctuation_h_m", "scale_of_fluctuation_v_m")


def soil_of_points(layers: Any, points: np.ndarray) -> np.ndarray:
    """Number of the soil in which each point lies.

    Args:
        layers: the `layer` entries of a field; each has `top_m`, the height of its upper border at x = 0 [m], and
            `dip_deg`, the border's inclination, anticlockwise from the x axis [degrees].
        points: positions, shape (n, 2) [m].

    Returns:
        shape (n,): 0 above all lines, k in the k-th layer of the list.
    """
    x, y = np.asarray(points, dtype=float).T
    soil = np.zeros(len(points), dtype=int)
    for number, layer in enumerate(layers, start=1):
        soil[y < layer.top_m + x * tan(radians(layer.dip_deg)) - BORDER] = number
    return soil


def settings_of_soils(settings: Any) -> list[Any]:
    """Settings of the field in each soil: the field's own above all lines, then those of the layers.

    Args:
        settings: a `random_field` entry of a study.

    Returns:
        one entry per soil. What a layer leaves out is as above all lines, but for the rotation: that is its dip.
    """
    soils = [settings]
    for layer in settings.layer or ():
        changes = {name: value for name in INHERITED if (value := getattr(layer, name)) is not None}
        changes["rotation_deg"] = layer.dip_deg if layer.rotation_deg is None else layer.rotation_deg
        soils.append(settings.model_copy(update=changes))
    return soils
