"""Rows of an ensemble -> estimates with their errors, and the plan of what to run next; pure."""

from rfmpm.estimators.curves import Band, exceedance_curve, running_exceedance, running_mean
from rfmpm.estimators.monte_carlo import Estimate, contiguous_prefix, exceedance, mean, missing, quantile
from rfmpm.estimators.multilevel import ControlVariate, Multilevel
from rfmpm.estimators.pairs import exceedance_difference, mean_difference
from rfmpm.estimators.plain import MonteCarlo
from rfmpm.estimators.question import Exceedances, Question, Value
from rfmpm.estimators.replicated import Replicated
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.spread import standard_deviation
from rfmpm.estimators.stratified import Stratified
from rfmpm.estimators.subset_simulation import SubsetSimulation
from rfmpm.estimators.two_phase import TwoPhase

ESTIMATORS = {
    "monte_carlo": MonteCarlo,
    "replicated": Replicated,
    "multilevel": Multilevel,
    "control_variate": ControlVariate,
    "two_phase": TwoPhase,
    "stratified": Stratified,
    "subset_simulation": SubsetSimulation,
}

__all__ = [
    "ESTIMATORS",
    "Band",
    "ControlVariate",
    "Estimate",
    "Exceedances",
    "MonteCarlo",
    "Multilevel",
    "Question",
    "Replicated",
    "Rows",
    "Stratified",
    "SubsetSimulation",
    "TwoPhase",
    "Value",
    "contiguous_prefix",
    "exceedance",
    "exceedance_curve",
    "exceedance_difference",
    "mean",
    "mean_difference",
    "missing",
    "quantile",
    "running_exceedance",
    "running_mean",
    "standard_deviation",
]
