"""Compiling ahead of time."""

from collections.abc import Iterator
from itertools import product

from rfmpm import realisation
from rfmpm.mpm.boundary import WALLS
from rfmpm.mpm.laws import LAWS
from rfmpm.mpm.shapes import SHAPES
from rfmpm.stability.limit_equilibrium import ASSUMPTIONS
from rfmpm.study import Study

FRICTIONAL = ("mohr_coulomb", "drucker_prager")
RANDOM_FRICTION = "random friction"
TINY_FIELD = {
    "material": "soil",
    "distribution": "lognormal",
    "coefficient_of_variation": 0.1,
    "correlation": "markov_separable",
    "scale_of_fluctuation_h_m": 1.0,
    "scale_of_fluctuation_v_m": 1.0,
}


def warmup() -> Iterator[str]:
    """Compile and cache the kernels of every combination of shape, law and walls, and those of limit equilibrium.

    Yields:
        The name of each combination, once it is ready.
    """
    slope = realisation.prepare(_tiny_study(next(iter(SHAPES)), "mohr_coulomb", "fixed", "roller"))
    for method in ASSUMPTIONS:
        realisation.stability(slope, method)
        yield f"factor of safety, {method}"
    soils = [*LAWS, *(f"{law} with {RANDOM_FRICTION}" for law in FRICTIONAL)]
    combinations = list(product(SHAPES, soils, WALLS, WALLS))
    for number, (shape, soil, base, sides) in enumerate(combinations, start=1):
        law = soil.split()[0]
        study = _tiny_study(shape, law, base, sides)
        if soil != law:
            study = study.with_changes({"random_field.friction_angle": TINY_FIELD})
        realisation.compile_kernels(realisation.prepare(study))
        yield f"{number}/{len(combinations)}  {shape}, {soil}, {base} base, {sides} sides"


def _tiny_study(shape: str, law: str, base: str, sides: str) -> Study:
    material = {
        "name": "soil",
        "law": law,
        "unit_weight_kn_m3": 20.0,
        "youngs_modulus_kpa": 1e3,
        "poissons_ratio": 0.3,
    }
    if law != "elastic":
        material["cohesion_kpa"] = 20.0
    if law in FRICTIONAL:
        material["friction_angle_deg"] = 30.0
    return Study(
        study={"name": "warm-up", "seed": 0},
        geometry={"kind": "block", "width_m": 2.0, "height_m": 2.0, "foreland_m": 2.0},
        discretisation={"cell_m": 1.0, "points_per_cell": 4, "shape": shape},
        boundary={"base": _boundary(base), "sides": _boundary(sides)},
        material=[material],
        time={"end_s": 1.0},
        output={"directory": "unused"},
    )


def _boundary(kind: str) -> dict:
    return {"kind": kind, "coefficient": 0.3} if kind == "friction" else {"kind": kind}
