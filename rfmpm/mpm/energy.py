"""Energies of the points that a run does not need at every step."""

import numpy as np

from rfmpm.mpm.state import Points


def elastic_energy(points: Points, lame: float, shear: float) -> float:
    """Elastic energy stored in the stresses.

    Args:
        points: the points.
        lame, shear: elastic constants [Pa].

    Returns:
        Sum over points of V sigma : C^-1 : sigma / 2 [J/m].
    """
    stress = points.stress
    mean = (stress.xx + stress.yy + stress.zz) / 3.0
    bulk = lame + 2.0 / 3.0 * shear
    j2 = 0.5 * sum((s - mean) ** 2 for s in (stress.xx, stress.yy, stress.zz)) + stress.xy**2
    return float(np.sum(points.volume * (0.5 * mean**2 / bulk + 0.5 * j2 / shear)))


def kinetic_energy(points: Points) -> float:
    """Kinetic energy of the points [J/m]."""
    return float(0.5 * np.sum(points.mass * (points.velocity.x**2 + points.velocity.y**2)))
