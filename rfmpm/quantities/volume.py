"""How much comes down, in all and in the first slide."""

from itertools import pairwise

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
    # As scipy.signal.find_peaks, whose import would cost every worker a second and 100 MB.
    last = len(kinetic_energy) - 1
    changes = np.flatnonzero(np.diff(kinetic_energy))
    for start, end in pairwise([0, *(changes + 1), last + 1]):  # stretches of one value
        if start > 0 and end <= last and _is_deep(kinetic_energy, start, end):
            return int(start + end - 1) // 2
    return last


def _is_deep(energy: np.ndarray, start: int, end: int) -> bool:
    """Whether a stretch of one value lies far enough below the highest points that part it from lower ones."""
    lowest = energy[start]
    if energy[start - 1] < lowest or energy[end] < lowest:
        return False
    left, right = _highest(energy[start - 1 :: -1], lowest), _highest(energy[end:], lowest)
    return min(left, right) - lowest >= PROMINENCE * energy.max()


def _highest(values: np.ndarray, lowest: float) -> float:
    """The largest of the values before the first one below `lowest`."""
    below = np.flatnonzero(values < lowest)
    return values[: below[0] if len(below) else None].max()
