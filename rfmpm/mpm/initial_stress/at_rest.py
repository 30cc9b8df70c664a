"""Stresses of ground at rest from the depth alone (K0), and the absence of stress from which gravity is raised."""

from math import radians, sin

import numpy as np

from rfmpm.kernel_tools import Tensor


def lateral_coefficient(study) -> float:
    """Coefficient of earth pressure at rest, K0 [-].

    Args:
        study: the study; `time.k0` where given, else of its material: 1 - sin(phi) with friction (Jaky 1944), and
            poissons_ratio / (1 - poissons_ratio) without, that of elastic soil that cannot spread.
    """
    if study.time.k0 is not None:
        return study.time.k0
    material = study.material[0]
    friction = getattr(material, "friction_angle_deg", 0.0)
    if friction > 0.0:
        return 1.0 - sin(radians(friction))
    return material.poissons_ratio / (1.0 - material.poissons_ratio)


def k0_stress(position: np.ndarray, outline: np.ndarray, unit_weight, coefficient: float) -> Tensor:
    """Stresses of level ground: the weight above, and K0 times it sideways.

    Args:
        position: shape (n, 2) [m].
        outline: corners of the body, shape (k, 2) [m].
        unit_weight: of the soil, one for all points or shape (n,) [N/m3].
        coefficient: K0 [-].

    Returns:
        Stress at the points, arrays of shape (n,) [Pa].
    """
    vertical = -unit_weight * (surface(outline, position[:, 0]) - position[:, 1])
    sideways = coefficient * vertical
    return Tensor(sideways, vertical, sideways.copy(), np.zeros_like(vertical))


def no_stress(count: int) -> Tensor:
    """No stress at `count` points, arrays of shape (count,) [Pa]."""
    return Tensor(*(np.zeros(count) for _ in range(4)))


def surface(outline: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Height of the ground surface above places `x`, shape (n,) [m], of an outline with corners (k, 2) [m]."""
    height = np.full(len(x), -np.inf)
    for (x0, y0), (x1, y1) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        if x0 == x1:
            continue
        share = (x - x0) / (x1 - x0)
        crosses = (share >= 0.0) & (share <= 1.0)
        height[crosses] = np.maximum(height, y0 + share * (y1 - y0))[crosses]
    return height
