"""How much comes down, in all and in the first slide."""

import numpy as np

from rfmpm.quantities.state import FinalState

PROMINENCE = 0.05  # of the largest kinetic energy; smaller dips are vibration


def failure_volume(state: FinalState) -> float:
    """Initial volume of the failed set [m3/m]."""
    return float(state.volume_initial[state.failed].sum())


def first_minimum(kinetic_energy: np.ndarray) -> int:
    """Find the first minimum of the kinetic energy: the end of the first slide.

    Args:
        kinetic_energy: history, shape (k,) [J/m].

    Returns:
        Index of the first minimum between a fall and a rise of 5 % of the largest value or more; else the last index.
    """
    from scipy.signal import find_peaks

    minima, _ = find_peaks(-kinetic_energy, prominence=PROMINENCE * kinetic_energy.max())
    return int(minima[0]) if len(minima) else len(kinetic_energy) - 1
