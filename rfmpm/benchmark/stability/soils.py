"""Random combinations over the ranges of soils and slopes that a campaign may ask for."""

from itertools import product
from math import sqrt

import numpy as np

from rfmpm.benchmark.stability.case import Case, Sweep

VARIATIONS = (0.1, 0.2, 0.3, 0.4, 0.5)  # coefficient of variation of an undrained strength [-]
SCALES = (0.5, 1.0, 2.0, 4.0, 6.0)  # vertical scale of fluctuation [m]
COMBINATIONS = 6  # of everything else, for each pair of the two above
SEED = 20170901


def random_soils() -> Sweep:
    """Soils and slopes drawn at random over their usual ranges, at the default step."""
    rng = np.random.default_rng(SEED)
    cases = [
        Case(f"{cov:g}", f"{scale:g} m", _draw(rng, cov, scale), index)
        for cov, scale, index in product(VARIATIONS, SCALES, range(COMBINATIONS))
    ]
    return Sweep(
        "random_soils",
        "Random soils at the default step",
        "coefficient of variation",
        "vertical scale of fluctuation",
        cases,
    )


def _draw(rng: np.random.Generator, cov: float, scale_v: float) -> dict:
    """A soil, a slope and a field; softening reaches up to 0.9 of the modulus of snap-back."""

    def even(lower: float, upper: float) -> float:
        return float(rng.uniform(lower, upper))

    def of_size(lower: float, upper: float) -> float:
        return float(np.exp(rng.uniform(np.log(lower), np.log(upper))))

    modulus, ratio = of_size(1e3, 5e4), even(0.2, 0.49)
    peak = of_size(5.0, 50.0)
    rough = {"kind": "friction", "coefficient": even(0.1, 0.8)}
    snap_back = sqrt(3.0) * 0.5 * modulus / (1.0 + ratio)
    own_length = {"material.0.softening_length_m": even(0.5, 1.5), "material.0.viscosity_kpa_s": even(0.0, 1.0)}
    by_cell = {
        "material.0.softening_length_m": None,
        "material.0.softening_reference_cell_m": 0.5,
        "material.0.viscosity_kpa_s": 0.0,
    }
    return {
        "geometry.height_m": 0.5 * int(rng.integers(6, 17)),
        "geometry.angle_deg": even(20.0, 90.0),
        "discretisation.points_per_cell": int(rng.choice([4, 9])),
        "material.0.youngs_modulus_kpa": modulus,
        "material.0.poissons_ratio": ratio,
        "material.0.unit_weight_kn_m3": even(15.0, 22.0),
        "material.0.cohesion_kpa": peak,
        "material.0.residual_cohesion_kpa": peak * even(0.1, 1.0),
        "material.0.softening_modulus_kpa": min(of_size(5.0, 200.0), 0.9 * snap_back),
        **(own_length if rng.random() < 0.5 else by_cell),
        "boundary.base": rough if rng.random() < 0.5 else {"kind": "fixed"},
        "random_field.cohesion": {
            "material": "clay",
            "distribution": str(rng.choice(["lognormal", "normal_truncated"])),
            "coefficient_of_variation": cov,
            "correlation": str(rng.choice(["markov_separable", "markov_ellipsoidal", "gaussian"])),
            "scale_of_fluctuation_h_m": even(20.0, 80.0),
            "scale_of_fluctuation_v_m": scale_v,
            "method": "cholesky",
        },
        "time.end_s": 15.0,
    }
