"""Independent random streams: one for each (study seed, level, realisation index)."""

import numpy as np


def standard_normal(seed: int, level: int, index: int, count: int) -> np.ndarray:
    """Draw the standard-normal vector `xi` of one realisation.

    The stream depends on its three integers alone, so a realisation is the same on any rank, in any order.

    Args:
        seed: seed of the study.
        level: level of a multilevel plan; 0 for plain Monte Carlo.
        index: realisation index.
        count: length of the vector.

    Returns:
        `xi`, shape (count,) [-].
    """
    sequence = np.random.SeedSequence(seed, spawn_key=(level, index))
    return np.random.Generator(np.random.PCG64(sequence)).standard_normal(count)
