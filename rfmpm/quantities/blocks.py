"""How many blocks the failed mass broke into."""

import numpy as np

from rfmpm.quantities.state import FinalState, label_cells


def block_count(state: FinalState) -> int:
    """Count the connected parts of the failed set with little plastic strain and enough area."""
    return len(block_areas(state))


def block_areas(state: FinalState) -> np.ndarray:
    """Areas of the blocks, shape (blocks,) [m2]; empty where there are none."""
    intact = state.failed & (state.plastic_strain < state.block_plastic_strain)
    if not intact.any():
        return np.zeros(0)
    group = label_cells(state.x[intact], state.y[intact], state.cell, diagonal=False)
    area = np.bincount(group, weights=state.volume_initial[intact])
    return area[area >= state.block_minimum_area]
