"""How far the failed mass goes."""

import numpy as np

from rfmpm.quantities.retrogression import retrogression_distance
from rfmpm.quantities.state import FinalState, label_cells


def front(x: np.ndarray, volume: np.ndarray, quantile: float) -> float:
    """Coordinate behind which a share `quantile` of the volume lies.

    Args:
        x: positions, shape (n,), n > 0 [m].
        volume: initial volumes, which stand for mass, shape (n,) [m3/m].
        quantile: share; 1 gives the furthest point [-].

    Returns:
        x of the first point at which the share is reached [m].
    """
    order = np.argsort(x, kind="stable")
    share = np.cumsum(volume[order])
    return float(x[order[np.searchsorted(share, quantile * share[-1] * (1.0 - 1e-12))]])


def run_out(state: FinalState) -> float:
    """Distance of the front of the connected failed mass beyond the initial toe [m]; 0 where it stays behind."""
    return max(0.0, _front_of_failed_mass(state) - state.toe)


def run_out_censored(state: FinalState) -> int:
    """1 where the front came within a cell of the far wall, else 0."""
    return int(_front_of_failed_mass(state) > state.length - state.cell)


def influence_distance(state: FinalState) -> float:
    """Run-out plus width of the slope plus retrogression [m]."""
    return run_out(state) + state.toe - state.crest_edge + retrogression_distance(state)


def _front_of_failed_mass(state: FinalState) -> float:
    if not state.failed.any():
        return -np.inf
    x, volume = state.x[state.failed], state.volume_initial[state.failed]
    group = label_cells(x, state.y[state.failed], state.cell, diagonal=True)
    largest = group == np.bincount(group, weights=volume).argmax()
    return front(x[largest], volume[largest], state.front_quantile)
