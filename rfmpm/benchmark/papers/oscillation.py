"""A number for how much a field of stresses oscillates from point to point."""

from collections.abc import Mapping

import numpy as np

NEIGHBOURS = 12  # about those within a cell, at four points per cell


def components(points: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Isotropic, deviatoric (sqrt(J2)) and tangential (xy) stress, shape (n,) each [Pa]."""
    xx, yy, zz, xy = (points[f"stress_{name}"] for name in ("xx", "yy", "zz", "xy"))
    mean = (xx + yy + zz) / 3.0
    deviatoric = np.sqrt(0.5 * ((xx - mean) ** 2 + (yy - mean) ** 2 + (zz - mean) ** 2) + xy**2)
    return {"isotropic": mean, "deviatoric": deviatoric, "tangential": xy}


def oscillation(x: np.ndarray, y: np.ndarray, values: np.ndarray) -> float:
    """Root mean square of what a plane through a point's neighbours does not foresee, over that of the values.

    Args:
        x, y: places, shape (n,) [m].
        values: at them, shape (n,).

    Returns:
        The share [-]: 0 for a field that is linear from point to point, about 1 for noise.
    """
    from scipy.spatial import cKDTree

    places = np.column_stack([x, y])
    near = cKDTree(places).query(places, NEIGHBOURS + 1)[1][:, 1:]
    away = places[near] - places[:, None]
    planes = np.concatenate([np.ones((*near.shape, 1)), away], axis=2)
    foreseen = np.einsum("pk,pk->p", np.linalg.pinv(planes)[:, 0], values[near])
    return float(np.sqrt(np.mean((values - foreseen) ** 2) / np.mean(values**2)))
