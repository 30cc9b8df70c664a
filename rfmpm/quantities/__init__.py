"""Quantities of interest by name: functions of the final state, defined in the table of variables."""

from rfmpm.quantities.blocks import block_count
from rfmpm.quantities.failure_mode import failure_mode
from rfmpm.quantities.retrogression import retrogression_censored, retrogression_distance
from rfmpm.quantities.run_out import front, influence_distance, run_out, run_out_censored
from rfmpm.quantities.state import FinalState
from rfmpm.quantities.surface import final_surface
from rfmpm.quantities.volume import failure_volume, first_minimum

QUANTITIES = {
    "run_out": run_out,
    "run_out_censored": run_out_censored,
    "retrogression_distance": retrogression_distance,
    "retrogression_censored": retrogression_censored,
    "failure_volume": failure_volume,
    "influence_distance": influence_distance,
    "block_count": block_count,
    "failure_mode": failure_mode,
    "final_surface": final_surface,
}

__all__ = ["QUANTITIES", "FinalState", "first_minimum", "front"]
