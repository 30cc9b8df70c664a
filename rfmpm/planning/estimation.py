"""Who answers the question of a study, and who says what its realisations are made of."""

from pathlib import Path
from typing import TYPE_CHECKING

from rfmpm.estimators import ControlVariate, Estimate, MonteCarlo, Multilevel, Replicated, Rows, TwoPhase
from rfmpm.estimators.protocol import Estimator
from rfmpm.estimators.stratified import Stratified
from rfmpm.estimators.subset_simulation import SubsetSimulation
from rfmpm.planning.components import FieldFeatures, directions_of
from rfmpm.planning.questions import question_of
from rfmpm.study.question_checks import saltelli_size
from rfmpm.study.question_models import TOWARDS_LIMIT

if TYPE_CHECKING:
    from rfmpm.sampling import Sampler

NOT_DIVISIBLE = (
    "only a study with a fixed number of independent realisations can be run in parts: one with study.realisations, "
    'without study.until and with estimator.sampling = "random"'
)
NOT_AGAIN = (
    "later realisations of subset_simulation and stratified follow from those that failed, as they failed; run the "
    "campaign anew with --fresh"
)


def estimator_of(study) -> Estimator:
    """Make the estimator that plans a study's campaign and answers its question.

    Args:
        study: the study.

    Returns:
        The estimator.
    """
    question, table = question_of(study), study.estimator
    number = None if question.is_open_ended else question.at_most
    if table is None or (table.method == "monte_carlo" and table.sampling == "random"):
        return MonteCarlo(question, number)
    if table.method == "monte_carlo":
        size = table.replicate_size
        if table.sampling == "saltelli":  # base points are the independent ones
            size = saltelli_size(len(study.uncertain), bool(study.fields))
        return Replicated(question, size, number)
    if table.method == "stratified":
        return Stratified(question, FieldFeatures(study), table.pilot_size)
    if approaches_limit(study):
        return SubsetSimulation(question, table.level_size, table.level_probability)
    levels = len(table.coarser_cells_m or ())
    if table.method == "multilevel":
        return Multilevel(question, levels, number)
    features = FieldFeatures(study) if table.principal_components else None
    if table.method == "two_phase":
        return TwoPhase(question, features, number, table.fair_size)
    return ControlVariate(question, levels, features, number)


def answer(study, rows: Rows) -> Estimate:
    """Answer a study's question.

    Args:
        study: the study.
        rows: of its campaign.

    Returns:
        The estimate with its interval.
    """
    return estimator_of(study).estimate(rows)


def is_random(study) -> bool:
    """Whether the random vector of a realisation follows from seed and index alone, by its stream."""
    table = study.estimator
    return table is None or (table.sampling == "random" and not approaches_limit(study))


def approaches_limit(study) -> bool:
    """Whether realisations follow from others before them, nearer to the limit in question."""
    return study.estimator is not None and study.estimator.method in TOWARDS_LIMIT


def is_divisible(study) -> bool:
    """Whether the campaign can be run in parts."""
    return study.study.until is None and is_random(study)


def sampler_of(study, prepared, store: Path | None = None) -> "Sampler":
    """Make what says the random vectors of a study for which `is_random` is false.

    Args:
        study: the study.
        prepared: it, on its own cells.
        store: folder in which principal components are kept for another start; None keeps them in memory.

    Returns:
        The sampler.

    Raises:
        StudyError: if the fields have too many variables for their principal components to be found.
        OSError: if the store cannot be written.
    """
    from rfmpm.sampling import SAMPLERS, MarkovChains, Saltelli, StratifiedVectors

    table, seed, count = study.estimator, study.study.seed, prepared.n_variables
    if table.method == "stratified":
        return StratifiedVectors(directions_of(study, prepared, store), question_of(study), table.pilot_size)
    if approaches_limit(study):
        return MarkovChains(seed, count, estimator_of(study))
    scalars = len(prepared.uncertain)
    if table.sampling == "saltelli":
        return Saltelli(seed, scalars, count)
    return SAMPLERS[table.sampling](directions_of(study, prepared, store), table.replicate_size)
