"""Three soils and a field for any of them, for the tests of fields of several materials."""

FIELD = {
    "distribution": "lognormal",
    "coefficient_of_variation": 0.25,
    "correlation": "markov_separable",
    "scale_of_fluctuation_h_m": 6.0,
    "scale_of_fluctuation_v_m": 1.0,
}
CLAY = {
    "name": "clay",
    "law": "von_mises",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 1000.0,
    "poissons_ratio": 0.33,
    "cohesion_kpa": 17.0,
    "residual_cohesion_kpa": 4.0,
    "softening_modulus_kpa": 50.0,
}
SAND = {
    "name": "sand",
    "law": "mohr_coulomb",
    "unit_weight_kn_m3": 18.0,
    "youngs_modulus_kpa": 3000.0,
    "poissons_ratio": 0.3,
    "cohesion_kpa": 4.0,
    "friction_angle_deg": 25.0,
}
ROCK = {
    "name": "rock",
    "law": "elastic",
    "unit_weight_kn_m3": 22.0,
    "youngs_modulus_kpa": 20000.0,
    "poissons_ratio": 0.3,
}
