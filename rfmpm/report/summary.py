"""The answer in a few lines, for the end of a campaign."""

import numpy as np

from rfmpm import planning
from rfmpm.report import words
from rfmpm.report.answering import Answers
from rfmpm.report.asked import asked
from rfmpm.report.costs import cost
from rfmpm.report.numbers import CONFIDENCE, analyse

LABEL = 18  # width of the first column
VALUE = 8  # width of the second


def summary_lines(dataset, study) -> list[str]:
    """Write the answer of a study in a few lines, the last of them what all its simulations cost.

    A study that asks a question, or says how it is answered, gets that answer and what is known of the error of its
    cells; any other one the mean run-out and the probability of exceeding the limit.

    Args:
        dataset: the ensemble, an xarray.Dataset as `open_ensemble` gives it.
        study: its Study.

    Returns:
        Lines of text.
    """
    if study.study.until is None and study.estimator is None:
        return [*_of_run_out(dataset, study), _cost_line(dataset)]
    answers = Answers(dataset, study, CONFIDENCE)
    found = planning.answer_lines(study, answers.estimate(answers.rows))
    return [*found, *_of_cells(answers), _cost_line(dataset)]


def _of_run_out(dataset, study) -> list[str]:
    numbers = analyse(dataset, study)
    mean, probability = numbers.mean_run_out, numbers.exceedance
    realisations = words.count(numbers.used, "realisation")
    censored = f", {numbers.censored} censored counted as exceeding" if numbers.censored else ""
    return [
        _line("mean run-out", words.with_unit(mean.value, "m"), f"{words.interval(mean, 'm')}, {realisations}"),
        _line(
            f"P(run-out > {numbers.limit:g} m)",
            words.share(probability.value),
            f"{words.share_interval(probability)}{censored}",
        ),
    ]


def _of_cells(answers: Answers) -> list[str]:
    """What two sizes of cells tell of their error."""
    if not answers.rows.level.any():
        return []
    if (cells := answers.discretisation()) is None:
        return ["error of the cells unknown: too few realisations completed on two sizes of cells"]
    unit = f" {asked(answers.question).answer_unit}".rstrip()
    side = "high" if cells.error >= 0.0 else "low"
    return [
        f"by {cells.n} realisations on several sizes of cells, the answer is {words.number(abs(cells.error), 2)}{unit} "
        f"too {side} (standard error {words.number(cells.standard_error, 2)}) compared with vanishing cells; the "
        "interval leaves this out, the report counts it"
    ]


def _line(label: str, value: str, remark: str) -> str:
    return f"{label:{LABEL - 2}}  {value:{VALUE - 2}}  ({remark})"


def _cost_line(dataset) -> str:
    """What the simulations on all sizes of cells took, and how many of them failed."""
    found, failed = cost(dataset), int(np.sum(np.isnan(dataset["run_out"].values)))
    parts = [f"computing time, {words.duration(found['per_realisation'])} per realisation"]
    if "coarser" in found:
        parts = [f"{parts[0]} on the study's own cells", f"{words.duration(found['coarser'])} of it on coarser ones"]
    if "elapsed" in found:
        parts.append(f"{words.duration(found['elapsed'])} from start to end")
    parts.append(f"{failed} of {dataset.sizes['realisation']} failed")
    return _line("cost", words.duration(found["computing"]), "; ".join(parts))
