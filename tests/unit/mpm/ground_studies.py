"""Small studies of regions, for the tests of geometry and of several materials."""

from copy import deepcopy
from typing import Any

CLAY = {
    "name": "clay",
    "law": "von_mises",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 1000.0,
    "poissons_ratio": 0.33,
    "cohesion_kpa": 8.0,
    "residual_cohesion_kpa": 2.0,
    "softening_modulus_kpa": 50.0,
    "softening_length_m": 0.5,
}
SAND = {
    "name": "sand",
    "law": "mohr_coulomb",
    "unit_weight_kn_m3": 18.0,
    "youngs_modulus_kpa": 3000.0,
    "poissons_ratio": 0.3,
    "cohesion_kpa": 1.0,
    "friction_angle_deg": 25.0,
}
ROCK = {
    "name": "rock",
    "law": "elastic",
    "unit_weight_kn_m3": 24.0,
    "youngs_modulus_kpa": 4000.0,
    "poissons_ratio": 0.0,
}
WHOLE = [[0, 0], [7, 0], [3, 4], [0, 4]]
UPPER, LOWER = [[0, 2], [5, 2], [3, 4], [0, 4]], [[0, 0], [7, 0], [5, 2], [0, 2]]


def region(name: str, corners: Any, material: str = "clay") -> dict[str, Any]:
    return {"name": name, "material": material, "corners_m": corners}


def tables(*regions: dict[str, Any], materials: Any = (CLAY,), cell: float = 0.5, **more: Any) -> dict[str, Any]:
    """Tables of a study of regions; `more` goes into its geometry."""
    return deepcopy(
        {
            "study": {"name": "regions", "seed": 1},
            "geometry": {"kind": "regions", "foreland_m": 6.0, "region": list(regions)} | more,
            "discretisation": {"cell_m": cell, "points_per_cell": 4, "shape": "quadratic_bspline"},
            "boundary": {"base": {"kind": "friction", "coefficient": 0.3}, "sides": {"kind": "roller"}},
            "material": list(materials),
            "time": {"end_s": 1.0},
            "output": {"directory": "results"},
        }
    )
