"""Rows of an ensemble -> estimates with their errors, and the plan of what to run next; pure."""

from rfmpm.estimators.curves import Band, exceedance_curve, running_exceedance, running_mean
from rfmpm.estimators.monte_carlo import Estimate, MonteCarlo, contiguous_prefix, exceedance, mean, quantile

ESTIMATORS = {"monte_carlo": MonteCarlo}

__all__ = [
    "ESTIMATORS",
    "Band",
    "Estimate",
    "MonteCarlo",
    "contiguous_prefix",
    "exceedance",
    "exceedance_curve",
    "mean",
    "quantile",
    "running_exceedance",
    "running_mean",
]
