"""What a study asks, and the answer to it, in words."""

from dataclasses import replace
from math import isnan

from rfmpm.estimators.monte_carlo import Estimate
from rfmpm.estimators.question import Question
from rfmpm.variables import VARIABLES

NOUNS = {
    "run_out": "run-out",
    "retrogression_distance": "retrogression distance",
    "influence_distance": "influence distance",
    "failure_volume": "failure volume",
    "initial_failure_volume": "volume of the first slide",
}


def question_of(study) -> Question:
    """What a study asks; with a fixed number of realisations, P(run-out > quantities.run_out_limit_m).

    Args:
        study: the study.

    Returns:
        The question.
    """
    asked = study.study.until
    if asked is None:
        limit = study.quantities.run_out_limit_m
        return Question("run_out", "exceedance", limit=limit, at_most=study.study.realisations)
    kind = "exceedance" if asked.limit is not None else "mean" if asked.quantile is None else "quantile"
    return Question(
        asked.quantity,
        kind,
        limit=asked.limit,
        probability=asked.quantile,
        half_width=asked.width,
        relative_half_width=asked.relative_half_width,
        at_most=asked.at_most,
    )


def in_words(question: Question) -> str:
    """Say a question in words: "P(run-out > 5 m) to within 0.05"."""
    name, unit = NOUNS[question.quantity], unit_of(question.quantity)
    if question.kind == "exceedance":
        words, unit = f"P({name} > {question.limit:g} {unit})", ""
    elif question.kind == "quantile":
        words = f"{100.0 * question.probability:g} % quantile of the {name}"
    else:
        words = f"mean {name}"
    if question.half_width is not None:
        return f"{words} to within {question.half_width:g} {unit}".rstrip()
    if question.relative_half_width is not None:
        return f"{words} to within {100.0 * question.relative_half_width:g} %"
    return words


def answer_lines(study, found: Estimate) -> list[str]:
    """Say an answer in words: the estimate and its interval; how near that is to what was wanted; what to know of it.

    Args:
        study: the study.
        found: the answer to its question.

    Returns:
        Lines of text.
    """
    question = question_of(study)
    plain_question = replace(question, half_width=None, relative_half_width=None)
    interval = f"{100.0 * found.confidence:.0f} % interval {found.lower:.4g} to {found.upper:.4g}"
    unit = "" if question.kind == "exceedance" else f" {unit_of(question.quantity)}"
    value = "unknown" if isnan(found.value) else f"= {found.value:.4g}{unit}"
    basis = f"{found.n} realisations on the study's own cells"
    lines = [f"{in_words(plain_question)} {value}, {interval}{unit} ({found.method}; {basis})"]
    if question.is_open_ended and question.excess(found) > 1.0:
        half = 0.5 * (found.upper - found.lower)
        wanted = in_words(question).removeprefix(f"{in_words(plain_question)} ")
        lines.append(f"not known {wanted}, as was asked, but {half:.3g}{unit}: study.until.at_most ended it")
    return lines + ([_with_sizes(found.note, study)] if found.note else [])


def _with_sizes(note: str, study) -> str:
    """Say the size of coarser cells where a note says their number."""
    for number, cell in enumerate(study.estimator.coarser_cells_m or () if study.estimator else (), 1):
        note = note.replace(f"coarser cells no. {number}", f"coarser ones of {cell:g} m")
    return note


def unit_of(quantity: str) -> str:
    """Unit of a quantity as one writes it: "m", "m3/m"."""
    unit = VARIABLES[quantity].unit
    return {"m3 m-1": "m3/m"}.get(unit, unit)
