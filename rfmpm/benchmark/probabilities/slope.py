"""The short slope as a bank of rows, its references, and the estimators that are judged on it."""

import time
from collections.abc import Callable

import numpy as np

from rfmpm import planning, realisation
from rfmpm.benchmark.probabilities.bank import Column
from rfmpm.benchmark.probabilities.cases import COARSE, COMPONENTS, FINE, REPLICATE
from rfmpm.benchmark.probabilities.repeats import Bank, Make
from rfmpm.estimators import ControlVariate, MonteCarlo, Multilevel, Question, Replicated, TwoPhase
from rfmpm.planning.components import FieldFeatures
from rfmpm.study import Study

LIMIT = 5.0  # [m]
QUESTIONS = {
    "mean": Question("run_out", "mean"),
    "P(> 5 m)": Question("run_out", "exceedance", limit=LIMIT),
    "95 % quantile": Question("run_out", "quantile", probability=0.95),
}
TRIALS = 12  # realisations whose processor time on both cell sizes is compared


def banks(studies: dict[str, Study], columns: dict[str, Column]) -> dict[str, Bank]:
    """Make the banks: both cell sizes ("pair"), the coarse one ("coarse") and its designs.

    Args:
        studies: by name.
        columns: their rows.

    Returns:
        Banks by name.
    """
    features = FieldFeatures(_asking(studies["fine"]))
    scores = features(range(len(columns["coarse"].run_out)))
    pairs = len(columns["fine"].run_out)
    points = planning.point_counts(studies["fine"])[0], planning.point_counts(studies["coarse"])[0]
    both = [columns["fine"], columns["coarse"]]
    value = [column.run_out for column in both]
    work = [column.steps * count for column, count in zip(both, points, strict=True)]
    cut = [[column[:pairs] for column in per_level] for per_level in (value, work)]
    found = {"pair": Bank(*cut, (1.0, cost_ratio(studies)), whitened(scores[:pairs]))}
    found["coarse"] = Bank(value[1:], work[1:], (1.0,), whitened(scores))
    none = np.zeros((0, 0))
    for name in ("latin_hypercube", "sobol"):
        column = columns[name]
        found[name] = Bank([column.run_out], [column.steps * points[1]], (1.0,), none, REPLICATE)
    return found


def _asking(study: Study) -> Study:
    """The study with the question and the estimator whose features the banks hold."""
    until = {"quantity": "run_out", "half_width_m": 0.1, "at_most": study.study.realisations}
    return study.with_changes(
        {
            "study": {"name": study.study.name, "seed": study.study.seed, "until": until},
            "estimator.method": "control_variate",
            "estimator.coarser_cells_m": [COARSE],
            "estimator.principal_components": COMPONENTS,
        }
    )


def cost_ratio(studies: dict[str, Study]) -> float:
    """Processor time of a realisation on the coarse cells over that on the fine ones, taken in turns [-]."""
    prepared = [realisation.prepare(studies[name]) for name in ("fine", "coarse")]
    for one in prepared:
        realisation.compile_kernels(one)
    seconds = np.zeros(2)
    for index in range(TRIALS):
        for place, one in enumerate(prepared):
            started = time.process_time()
            realisation.run(one, index)
            seconds[place] += time.process_time() - started
    return float(seconds[1] / seconds[0])


def whitened(scores: np.ndarray) -> np.ndarray:
    """Shift and turn components so that their means and covariances, which estimators know, hold in the bank too."""
    scores = scores - scores.mean(axis=0)
    return np.linalg.solve(np.linalg.cholesky(scores.T @ scores / len(scores)), scores.T).T


def truth(values: np.ndarray, question: Question) -> float:
    """What a question's answer is in a population."""
    if question.kind == "mean":
        return float(values.mean())
    if question.kind == "exceedance":
        return float(np.mean(values > question.limit))
    return float(np.quantile(values, question.probability, method="inverted_cdf"))


def makers(question: Question, number: int) -> dict[str, tuple[str, Make]]:
    """Estimators with a fixed number of realisations: the bank they draw from, and how to make them.

    Args:
        question: what is asked.
        number: of realisations on the level in question.

    Returns:
        By name.
    """
    plain: Callable = lambda features: MonteCarlo(question, number)  # noqa: E731
    design: Callable = lambda features: Replicated(question, REPLICATE, number)  # noqa: E731
    return {
        "plain, cells 0.5 m": ("coarse", plain),
        "Latin hypercube": ("latin_hypercube", design),
        "Sobol": ("sobol", design),
        "components of the field": ("coarse", lambda features: ControlVariate(question, 0, features, number)),
        f"plain, cells {FINE:g} m": ("pair", plain),
        "multilevel": ("pair", lambda features: Multilevel(question, 1, number)),
        "coarse runs as control variate": ("pair", lambda features: ControlVariate(question, 1, None, number)),
        "coarse runs and components": ("pair", lambda features: ControlVariate(question, 1, features, number)),
        "two phases and components": ("pair", lambda features: TwoPhase(question, features, number)),
    }
