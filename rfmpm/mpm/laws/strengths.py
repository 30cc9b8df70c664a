"""Cohesions of the points: the material's own, or what varies from point to point."""

import numpy as np


def cohesions(material, count, strengths):
    """Peak and residual cohesion of each point.

    Args:
        material: the study's material.
        count: number of points.
        strengths: arrays of shape (count,) by name; cohesion and residual_cohesion [Pa] are read where given.

    Returns:
        Peak and residual, shape (count,) each [Pa]. A residual that is not given is proportional to the peak; one that
        is given counts as far as it is below the peak.
    """
    own = material.cohesion_kpa * 1e3
    peak = np.asarray(strengths["cohesion"]) if "cohesion" in strengths else np.full(count, own)
    if "residual_cohesion" in strengths:
        return peak, np.minimum(peak, strengths["residual_cohesion"])
    ratio = material.residual_cohesion_kpa / material.cohesion_kpa if material.cohesion_kpa > 0.0 else 1.0
    return peak, peak * ratio
