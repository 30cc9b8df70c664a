"""Studies of elastic blocks, for the scenes whose answer is known in closed form."""

from rfmpm.mpm.scene import GRAVITY
from rfmpm.study import Study


def elastic_block(
    width: float,
    height: float,
    cell: float,
    shape: str,
    points_per_cell: int,
    density: float,
    youngs_modulus: float,
    poissons_ratio: float,
) -> Study:
    """Study of an elastic block between rollers that fills its domain from side to side; SI units."""
    return Study(
        study={"name": "block", "seed": 0},
        geometry={"kind": "block", "width_m": width, "height_m": height, "foreland_m": 0.0},
        discretisation={
            "cell_m": cell,
            "points_per_cell": points_per_cell,
            "shape": shape,
            "volumetric_strain": "point",
        },
        boundary={"base": {"kind": "roller"}, "sides": {"kind": "roller"}},
        material=[
            {
                "name": "rubber",
                "law": "elastic",
                "unit_weight_kn_m3": density * GRAVITY / 1e3,
                "youngs_modulus_kpa": youngs_modulus / 1e3,
                "poissons_ratio": poissons_ratio,
            }
        ],
        time={"end_s": 1.0},
        output={"directory": "unused"},
    )
