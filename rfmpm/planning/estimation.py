"""Who answers the question of a study, and who says what its realisations are made of."""

from rfmpm.estimators import ControlVariate, Estimate, MonteCarlo, Multilevel, Replicated, Rows
from rfmpm.estimators.protocol import Estimator
from rfmpm.planning.questions import question_of

NOT_DIVISIBLE = (
    "only a study with a fixed number of independent realisations can be run in parts: one with study.realisations, "
    'without study.until and with estimator.sampling = "random"'
)
NOT_AGAIN = (
    "later realisations of subset_simulation follow from those that failed, as they failed; run the campaign anew with "
    "--fresh"
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
        return Replicated(question, table.replicate_size, number)
    levels = len(table.coarser_cells_m or ())
    if table.method == "multilevel":
        return Multilevel(question, levels, number)
    return ControlVariate(question, levels, realisations=number)


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
    return table is None or (table.sampling == "random" and not has_chains(study))


def has_chains(study) -> bool:
    """Whether realisations follow from others before them."""
    return study.estimator is not None and study.estimator.method == "subset_simulation"


def is_divisible(study) -> bool:
    """Whether the campaign can be run in parts."""
    return study.study.until is None and is_random(study)


def sampler_of(study, prepared):
    """Make what says the random vectors of a study for which `is_random` is false.

    Args:
        study: the study.
        prepared: it, on its own cells.

    Returns:
        The sampler.
    """
    raise NotImplementedError
