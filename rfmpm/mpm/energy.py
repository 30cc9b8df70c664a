"""Energies of the points that a run does not need at every step, and where the work of gravity went."""

from math import isfinite, nan

import numpy as np

from rfmpm.mpm.state import Points, Progress


def energy_shares(now: Progress, stored_before: float, stored_now: float) -> dict[str, float]:
    """Say where the work of gravity went, as shares of it.

    Work of gravity = kinetic energy + elastic energy gained + plastic work + work of friction on walls + numerical
    dissipation. The last is what the transfer between points and grid and the integration in time take: gravity's work
    less kinetic energy, work of the stress and work of friction, each summed step by step. What does not close is that
    the elastic energy of the stresses and the plastic work, summed by themselves, miss the work of the stress.

    Args:
        now: progress of the run.
        stored_before, stored_now: elastic energy at the start and now [J/m].

    Returns:
        Shares by the names of the table of variables; NaN without work of gravity.
    """
    energies = {
        "plastic_work_share": now.plastic_work,
        "friction_work_share": now.friction_work,
        "numerical_dissipation_share": now.gravity_work - now.kinetic - now.stress_work - now.friction_work,
        "energy_balance_error": now.stress_work - now.plastic_work - (stored_now - stored_before),
    }
    work = abs(now.gravity_work)
    return {name: energy / work if isfinite(energy) and work > 0.0 else nan for name, energy in energies.items()}


def elastic_energy(points: Points, lame: float | np.ndarray, shear: float | np.ndarray) -> float:
    """Elastic energy stored in the stresses.

    Args:
        points: the points.
        lame, shear: elastic constants, one value or shape (n,) [Pa].

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
