"""From a study to who plans and answers: its question, estimator and levels; and from rows to what these see."""

from rfmpm.planning.estimation import (
    NOT_AGAIN,
    NOT_DIVISIBLE,
    answer,
    approaches_limit,
    estimator_of,
    is_divisible,
    is_random,
    sampler_of,
)
from rfmpm.planning.levels import on_own_cells, point_counts, run_options, studies_by_level, with_own_bins
from rfmpm.planning.questions import answer_lines, in_words, question_of
from rfmpm.planning.records import as_rows, outcomes, rows_of
from rfmpm.planning.replay import Replay

__all__ = [
    "NOT_AGAIN",
    "NOT_DIVISIBLE",
    "Replay",
    "answer",
    "answer_lines",
    "approaches_limit",
    "as_rows",
    "estimator_of",
    "in_words",
    "is_divisible",
    "is_random",
    "on_own_cells",
    "outcomes",
    "point_counts",
    "question_of",
    "rows_of",
    "run_options",
    "sampler_of",
    "studies_by_level",
    "with_own_bins",
]
