"""Slopes of one strength everywhere beside the study: of the mean, and of a cautious value of the strength."""

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import ndtri

from rfmpm import realisation
from rfmpm.benchmark.variability.summary import QUANTITIES
from rfmpm.random_fields.marginals import MARGINALS

if TYPE_CHECKING:
    import xarray as xr

CAUTIOUS = 0.05  # share of the soil that is weaker
STRENGTHS = ("mean", "cautious")


def add_uniform(found: "xr.Dataset", study) -> "xr.Dataset":
    """Add what slopes of uniform strength do, for each coefficient of variation.

    Args:
        found: dataset of the study.
        study: with a random cohesion and one material.

    Returns:
        The dataset with `<quantity>_uniform(strength, coefficient_of_variation)` and `uniform_cohesion` [kPa] over the
        same: mean strength, and the strength that 5 % of the soil falls below.
    """
    variations = found["coefficient_of_variation"].values
    cohesion = np.array([[_cohesion(study, strength, v) for v in variations] for strength in STRENGTHS])
    outcomes = {value: _simulate(study, value) for value in np.unique(cohesion)}
    dimensions = ("strength", "coefficient_of_variation")
    found = found.assign_coords(strength=list(STRENGTHS))
    attributes = {"units": "kPa", "long_name": "peak cohesion of the whole slope"}
    found["uniform_cohesion"] = (dimensions, cohesion, attributes)
    for name, quantity in QUANTITIES.items():
        values = np.vectorize(lambda value, name=name: outcomes[value][name])(cohesion)
        attributes = {"units": quantity.unit, "long_name": f"{quantity.noun} of a slope of one strength"}
        found[f"{name}_uniform"] = (dimensions, values, attributes)
    return found


def _cohesion(study, strength: str, variation: float) -> float:
    mean = study.material[0].cohesion_kpa
    if strength == "mean":
        return mean
    distribution = MARGINALS[study.random_field["cohesion"].distribution].from_moments(mean, variation)
    return float(distribution.transform(ndtri(CAUTIOUS)))


def _simulate(study, cohesion: float) -> dict[str, Any]:
    material = study.material[0]
    residual = material.residual_cohesion_kpa * cohesion / material.cohesion_kpa
    changes = {"material.0.cohesion_kpa": cohesion, "material.0.residual_cohesion_kpa": residual}
    prepared = realisation.prepare(study.with_changes(changes))
    outcome = realisation.simulate(prepared, homogeneous=True)
    return {name: float(outcome.quantities[name]) for name in QUANTITIES}
