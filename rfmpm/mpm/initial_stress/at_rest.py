"""Stresses of ground at rest from the depth alone (K0), and the absence of stress from which gravity is raised."""

from math import radians, sin

import numpy as np

from rfmpm.ground import is_plain, regions_of
from rfmpm.kernel_tools import Tensor


def lateral_coefficients(study) -> np.ndarray:
    """Coefficient of earth pressure at rest of each material, K0, shape (materials,) [-].

    Args:
        study: the study; `time.k0` where given, else of a material 1 - sin(phi) with friction (Jaky 1944), and
            poissons_ratio / (1 - poissons_ratio) without, that of elastic soil that cannot spread.
    """
    return np.array([_lateral_coefficient(material, study.time.k0) for material in study.material])


def _lateral_coefficient(material, given: float | None) -> float:
    if given is not None:
        return given
    friction = getattr(material, "friction_angle_deg", 0.0)
    if friction > 0.0:
        return 1.0 - sin(radians(friction))
    return material.poissons_ratio / (1.0 - material.poissons_ratio)


def k0_stress(overburden: np.ndarray, coefficient: np.ndarray) -> Tensor:
    """Stresses of level ground: the weight above, and K0 times it sideways.

    Args:
        overburden: weight of the soil above, shape (n,) [Pa].
        coefficient: K0, shape (n,) [-].

    Returns:
        Stress at the points, arrays of shape (n,) [Pa].
    """
    sideways = -coefficient * overburden
    return Tensor(sideways, -overburden, sideways.copy(), np.zeros_like(overburden))


def weight_above(study, outline: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Weight of the soil above each point, with what is going to be cut away, shape (n,) [Pa].

    Args:
        study: the study.
        outline: corners of a body of one soil, shape (k, 2) [m].
        position: shape (n, 2) [m].
    """
    weights = {material.name: material.unit_weight_kn_m3 * 1e3 for material in study.material}
    if is_plain(study.geometry):
        return study.material[0].unit_weight_kn_m3 * 1e3 * (surface(outline, position[:, 0]) - position[:, 1])
    import shapely

    regions = regions_of(study.geometry, study.material[0].name, study.discretisation.cell_m)
    top = max(region.polygon.bounds[3] for region in regions)
    rays = shapely.linestrings(np.stack([position, np.column_stack([position[:, 0], np.full(len(position), top)])], 1))
    return sum(
        weights[region.material] * shapely.length(shapely.intersection(region.polygon, rays)) for region in regions
    )


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
