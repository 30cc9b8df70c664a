"""How far back the crest fails."""

from rfmpm.quantities.state import FinalState


def retrogression_distance(state: FinalState) -> float:
    """Crest edge minus the smallest initial x of a failed point in the top row [m]; 0 where none failed."""
    failed = state.top_row & state.failed
    return float(state.crest_edge - state.x_initial[failed].min()) if failed.any() else 0.0


def retrogression_censored(state: FinalState) -> int:
    """1 where the failure reached the boundary behind the crest, else 0."""
    failed = state.top_row & state.failed
    return int(failed.any() and state.x_initial[failed].min() < state.spacing)
