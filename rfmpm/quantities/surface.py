"""The ground surface at the end."""

from math import ceil

import numpy as np

from rfmpm.quantities.state import FinalState


def bin_centres(length: float, surface_bin: float) -> np.ndarray:
    """Centres of the bins over a domain of that length, shape (bins,) [m]; the last bin may reach beyond it."""
    return (np.arange(ceil(length / surface_bin - 1e-9)) + 0.5) * surface_bin


def final_surface(state: FinalState) -> np.ndarray:
    """Highest ground in each bin, shape (bins,) [m]: the top of the highest point, 0 where the base is bare."""
    height = np.zeros(len(bin_centres(state.length, state.surface_bin)))
    column = np.minimum((state.x / state.surface_bin).astype(int), len(height) - 1)
    np.maximum.at(height, column, state.y + 0.5 * np.sqrt(state.volume))
    return height
