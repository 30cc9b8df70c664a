"""The first screen: the answer in one sentence, what weakens it, what to do next."""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from synthetic import make_ensemble, make_study

from rfmpm.estimators import Estimate
from rfmpm.estimators.discretisation import Discretisation
from rfmpm.planning import question_of
from rfmpm.report import answer, sections
from rfmpm.report.asked import Asked
from rfmpm.report.budget import Standing, budget, next_steps
from rfmpm.report.costs import WATTS_PER_CORE
from rfmpm.report.numbers import analyse


def asking(until):
    return make_study(**{"study.realisations": None, "study.until": until})


QUESTIONS = [
    (
        {"quantity": "run_out", "exceeds_m": 5.0, "half_width": 0.1, "at_most": 64},
        "How likely is the soil to travel more than 5 m beyond the toe?",
        "The probability that the run-out exceeds 5 m is 0.7",
    ),
    (
        {"quantity": "retrogression_distance", "at_most": 64},
        "How far back from its edge does the crest fail on average?",
        "The mean retrogression distance is ",
    ),
    (
        {"quantity": "failure_volume", "quantile": 0.9, "at_most": 64},
        "How much soil fails in all but the worst 10 % of cases?",
        "The failure volume that is exceeded in 10 % of cases is ",
    ),
]


@pytest.mark.parametrize(("until", "question", "start"), QUESTIONS)
def test_every_kind_of_question_is_asked_and_answered(until, question, start):
    study = asking(until)
    numbers = analyse(make_ensemble(study), study)
    assert numbers.asked.sentence == question
    assert answer.headline(numbers).startswith(start)
    assert "with 95 % confidence" in answer.headline(numbers)
    assert numbers.curve.value[0] == pytest.approx(1.0)  # identity: every made-up slope fails


@pytest.mark.parametrize(("options", "sentence"), [({"still": range(64)}, "is below 0.056"), ({}, "is above 0.944")])
def test_a_probability_of_0_or_1_is_a_bound(options, sentence):
    study = make_study(**{"quantities.run_out_limit_m": 0.0})
    numbers = analyse(make_ensemble(study, **options), study)
    assert sentence in answer.headline(numbers)


def test_few_beyond_the_limit_and_the_back_of_the_model_are_warned_of():
    study = make_study(**{"quantities.run_out_limit_m": 17.0})
    ensemble = make_ensemble(study)
    ensemble["run_out"][:] = np.where(np.arange(64) < 3, 18.0, 4.0)
    ensemble["retrogression_censored"][:] = (np.arange(64) < 10).astype(float)
    numbers = analyse(ensemble, study)
    few, back = answer.warnings(numbers, study)
    assert few.startswith("The answer rests on 3 simulations beyond the limit")
    assert back.startswith("In 10 realisations of 64 the failure reached the back of the model, 10 m behind")
    assert "geometry.crest_m, now 10 m" in numbers.next_steps[0]
    assert 'method = "stratified"' in numbers.next_steps[1]


def test_the_budget_adds_the_cells_and_says_which_error_is_larger():
    study = make_study()
    numbers = analyse(make_ensemble(study, failed=(5, 40)), study)
    assert not numbers.budget.is_whole
    assert any("coarser_cells_m = [0.5]" in step for step in numbers.next_steps)
    found = Estimate(0.5, 0.45, 0.57, 0.95, 100, "plain")
    cells = Discretisation(0.06, 0.02, 0.02, 0.1, 1.0, False, (0.25, 0.5), 40, "order 1 assumed")
    whole = budget(found, Estimate(0.5, 0.46, 0.54, 0.95, 98, "plain"), cells, Asked("run_out", limit=5.0))
    assert (whole.sampling, whole.failed) == (pytest.approx(0.04), pytest.approx(0.02))  # identity
    assert (whole.lower, whole.upper) == (pytest.approx(0.35), 0.57)  # identity: the cells make it too high for sure
    standing = {"asked": Asked("run_out", limit=5.0), "answer": found, "is_random": True, "used": 100}
    standing |= {"completed": 100, "beyond": 50, "at_back": 0, "at_front": 0, "wanted": np.inf}
    for size, key in ((0.1, "discretisation.cell_m, now 0.25 m"), (0.01, "four times as many halve it")):
        parts = replace(whole, discretisation=size, failed=0.0)
        (step,) = next_steps(Standing(budget=parts, **standing), study)
        assert key in step
    steps = next_steps(
        Standing(budget=replace(whole, discretisation=0.01, failed=0.0), **standing | {"wanted": 0.02}), study
    )
    assert "about 400 simulations in all" in steps[0]  # twice the half width that is wanted


def hint_of(study):
    """What the page says of the cells before their error is known."""
    numbers = analyse(make_ensemble(study, n=16), study)
    return next(step for step in numbers.next_steps if "the size of the cells adds" in step)


@pytest.mark.parametrize(
    "until", [None, {"quantity": "run_out", "at_most": 80}, {"quantity": "run_out", "quantile": 0.9}]
)
def test_a_study_that_follows_the_hint_is_right(until):
    study = make_study() if until is None else asking(until | {"at_most": 80})
    found = dict(re.findall(r"(coarser_cells_m|method|until) = (\[.*?\]|\".*?\"|\{.*?\})", hint_of(study)))
    tables = tomllib.loads("\n".join(f"{key} = {value}" for key, value in found.items()))
    assert tables["method"] == ("two_phase" if until is None or "quantile" not in until else "multilevel")
    asked = tables.pop("until", None)
    assert (asked is None) == (until is not None)
    changes = {"study.until": asked, "study.realisations": None} if asked else {}
    followed = study.with_changes(changes | {"estimator": tables})
    assert question_of(followed).kind == question_of(study).kind


def test_a_study_with_two_sizes_of_cells_is_told_to_run_on():
    levels = {"method": "two_phase", "coarser_cells_m": [0.5]}
    study = asking({"quantity": "run_out", "at_most": 80}).with_changes({"estimator": levels})
    assert hint_of(study) == "Run on: what the size of the cells adds is known from 10 simulations on both sizes."


def test_electricity_is_computing_time_times_the_assumed_power():
    study = make_study()
    ensemble = make_ensemble(study)
    numbers = analyse(ensemble, study)
    joules = WATTS_PER_CORE * ensemble["wall_time"].values.sum()
    assert numbers.cost["electricity_j"] == pytest.approx(joules, rel=1e-12)  # identity
    label, amount = sections.costs(numbers)[-1]
    assert "assuming" in label
    assert amount == f"{joules / 3600.0:.1f} Wh"


def test_factors_of_safety_stand_beside_failures():
    study = make_study()
    ensemble = make_ensemble(study, n=20, still=range(8), failed=(19,))
    factor = np.where(np.arange(20) < 6, 1.3, 0.9)
    ensemble["factor_of_safety"] = ("realisation", factor)
    found = analyse(ensemble, study).safety
    assert (found.both, found.simulation_alone, found.factor_alone, found.neither) == (11, 0, 2, 6)
    assert found.below_one.value == 14 / 20
    assert found.failing.value == 11 / 19
    assert sections.safety(analyse(ensemble, study))["rows"][0] == ("factor of safety below 1", 11, 2)


def test_none_did_is_said_only_where_it_is_so():
    study = make_study(**{"quantities.run_out_limit_m": 0.0})
    none = analyse(make_ensemble(study, still=range(64)), study)
    assert answer.headline(none).endswith("none of 64 simulations did.")
    assert answer.headline(replace(none, beyond=3)).endswith("with 95 % confidence.")  # coarser cells moved it to 0


def test_failed_simulations_are_no_part_of_the_sampling_error_of_a_mean_or_quantile():
    for aim in ({"half_width_m": 5.0}, {"quantile": 0.5, "half_width_m": 5.0}):
        study = asking({"quantity": "run_out", "at_most": 64} | aim)
        whole = analyse(make_ensemble(study, failed=(5, 40)), study)
        rest = make_ensemble(study, failed=(5, 40)).isel(realisation=[i for i in range(64) if i not in (5, 40)])
        alone = analyse(rest.assign_coords(realisation=np.arange(62)), study)
        assert whole.budget.sampling == pytest.approx(alone.budget.sampling, rel=1e-12)  # identity
        assert not any("Run" in step for step in whole.next_steps)


def test_no_more_runs_where_the_answer_is_as_narrow_as_wanted():
    study = asking({"quantity": "run_out", "exceeds_m": 1e3, "half_width": 0.1, "at_most": 64})
    assert not any("Run" in step for step in analyse(make_ensemble(study), study).next_steps)
