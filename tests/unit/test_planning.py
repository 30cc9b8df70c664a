"""From a study to its question in words, to who answers it, and to the most that it can take."""

from pathlib import Path

import numpy as np
import pytest

from rfmpm import estimators, planning
from rfmpm.cost.campaign import most_realisations
from rfmpm.estimators import Rows
from rfmpm.estimators.subset_simulation import SubsetSimulation
from rfmpm.study import load_study

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"
CHANCE = {"quantity": "run_out", "exceeds_m": 5.0, "half_width": 0.05}
DESIGN = {"sampling": "latin_hypercube", "replicate_size": 16}


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


def asking(study, until, **estimator):
    changes = {"study.realisations": None, "study.until": until, "discretisation.cell_m": 0.5}
    return study.with_changes(changes | ({"estimator": estimator} if estimator else {}))


@pytest.mark.parametrize(
    ("until", "words"),
    [
        (CHANCE, "P(run-out > 5 m) to within 0.05"),
        (
            {"quantity": "failure_volume", "relative_half_width": 0.1, "at_most": 9},
            "mean failure volume to within 10 %",
        ),
        (
            {"quantity": "retrogression_distance", "quantile": 0.99, "half_width_m": 0.2},
            "99 % quantile of the retrogression distance to within 0.2 m",
        ),
        ({"quantity": "failure_volume", "exceeds_m3_per_m": 2.0, "at_most": 9}, "P(failure volume > 2 m3/m)"),
    ],
)
def test_a_question_is_said_in_words(study, until, words):
    assert planning.in_words(planning.question_of(asking(study, until))) == words


def test_without_a_question_it_is_that_of_the_run_out_limit(study):
    assert planning.in_words(planning.question_of(study)) == "P(run-out > 5 m)"


@pytest.mark.parametrize(
    ("estimator", "kind"),
    [
        ({}, estimators.MonteCarlo),
        (DESIGN, estimators.Replicated),
        ({"method": "multilevel", "coarser_cells_m": [1.0]}, estimators.Multilevel),
        ({"method": "control_variate", "principal_components": 3}, estimators.ControlVariate),
        ({"method": "two_phase", "coarser_cells_m": [1.0]}, estimators.TwoPhase),
        ({"method": "stratified"}, estimators.Stratified),
        ({"method": "subset_simulation"}, SubsetSimulation),
    ],
)
def test_each_method_has_its_estimator(study, estimator, kind):
    asked = asking(study, CHANCE, **estimator)
    assert type(planning.estimator_of(asked)) is kind
    assert planning.is_random(asked) == (kind not in (estimators.Replicated, estimators.Stratified, SubsetSimulation))
    assert not planning.is_divisible(asked)


def test_an_answer_says_what_was_missed_and_why(study):
    asked = asking(study, CHANCE | {"at_most": 10})
    ten = np.arange(10)
    rows = Rows(0 * ten, ten, np.where(ten < 3, 9.0, 1.0), ten < 0, 1.0 + ten)
    first, second = planning.answer_lines(asked, planning.answer(asked, rows))
    assert first.startswith("P(run-out > 5 m) = 0.3, 95 % interval 0.06674 to 0.6525 (")  # exact: Clopper-Pearson
    assert second == "not known to within 0.05, as was asked, but 0.293: study.until.at_most ended it"


def test_the_most_realisations_are_known_of_a_number_an_end_and_a_probability(study):
    assert most_realisations(study) == 8
    assert most_realisations(asking(study, CHANCE | {"at_most": 70})) == 70
    assert most_realisations(asking(study, {"quantity": "run_out", "half_width_m": 0.1})) is None
    worst = most_realisations(asking(study, CHANCE))
    half = np.ptp(estimators.intervals.clopper_pearson(worst // 2, worst)) / 2
    assert 0.9 * 0.05 < half <= 0.05  # enough for a probability of one half, and not much more
