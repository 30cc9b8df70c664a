"""Answers from rows on several sizes of cells."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from synthetic import make_ensemble, make_study

from rfmpm.report import answer, sections, summary_lines, words
from rfmpm.report.answering import Answers
from rfmpm.report.members import usable
from rfmpm.report.numbers import analyse
from rfmpm.report.probability_figures import _settling

PAIRS = 40


@pytest.fixture(scope="module")
def study():
    until = {"quantity": "run_out", "at_most": PAIRS}
    levels = {"method": "multilevel", "coarser_cells_m": [0.5]}
    return make_study(**{"study.realisations": None, "study.until": until, "estimator": levels})


@pytest.fixture(scope="module")
def ensemble(study):
    """Realisations on the study's cells, and three times as many on coarser ones, which go 1 m or so less far."""
    fine = make_ensemble(study, n=PAIRS)
    coarse = make_ensemble(study, n=3 * PAIRS).assign_coords(level=("realisation", np.ones(3 * PAIRS, int)))
    coarse["run_out"] = coarse["run_out"] - 1.0 + 0.1 * np.resize([-1.0, 1.0], 3 * PAIRS)
    return xr.concat([fine, coarse], "realisation", data_vars="minimal", coords="minimal", combine_attrs="override")


def test_error_of_the_cells_from_pairs(study, ensemble):
    found = Answers(ensemble, study, 0.95).discretisation()
    assert (found.cells, found.n) == ((0.25, 0.5), PAIRS)
    # Identity: gaps alternate about 1, the ratio of the sides less 1 is 1; vanishing cells would go 1 m further.
    assert found.error == pytest.approx(-1.0, rel=1e-9)
    error = 0.1 / np.sqrt(PAIRS - 1.0)  # of gaps of +-0.1: standard deviation 0.1 sqrt(n / (n - 1)) over sqrt(n)
    assert found.standard_error == pytest.approx(error, rel=1e-9)


def test_error_of_the_cells_of_a_quantile_is_that_of_the_shift(study, ensemble):
    until = {"quantity": "run_out", "quantile": 0.5, "at_most": PAIRS}
    found = Answers(ensemble, study.with_changes({"study.until": until}), 0.95).discretisation()
    assert abs(found.error + 1.0) <= 0.1  # the coarser values are 1 m less far, 0.1 m more or less
    assert found.lower < found.error < found.upper


def test_the_page_shows_rows_on_the_study_s_own_cells_and_the_answer_uses_all(study, ensemble):
    numbers = analyse(ensemble, study)
    assert (numbers.held, numbers.used, numbers.completed) == (PAIRS, PAIRS, PAIRS)
    assert usable(ensemble, study)["level"].values.max() == 0
    assert numbers.answer.n == PAIRS
    own = usable(ensemble, study)["run_out"].values
    plain = np.std(own, ddof=1) / np.sqrt(PAIRS)
    assert numbers.answer.standard_error < plain  # the coarser ones vary alike and are three times as many
    assert numbers.budget.upper == pytest.approx(numbers.answer.upper - numbers.discretisation.lower, rel=1e-12)
    assert numbers.settling.value[-1] == numbers.answer.value
    assert numbers.cost["coarser"] == pytest.approx(ensemble["wall_time"].values[PAIRS:].sum(), rel=1e-12)  # identity


def test_a_part_of_a_study_is_answered_from_its_own_first_realisation():
    study = make_study()
    part = make_ensemble(study, n=20)
    part = part.assign_coords(realisation=part["realisation"] + 32).assign_attrs(first_realisation=32)
    assert analyse(part, study).answer.value == analyse(make_ensemble(study, n=20), study).answer.value


def test_the_bar_of_the_cells_has_the_sides_of_their_error(study, ensemble):
    numbers = analyse(ensemble, study)
    cells, bar = numbers.discretisation, sections.error_parts(numbers, study)[1]
    assert cells.upper < 0.0  # the coarser ones go less far for sure
    assert bar["size"] == f"+ {words.number(-cells.lower, 2)} m"


def test_few_pairs_are_not_called_one_size_of_cells(study, ensemble):
    few = ensemble.isel(realisation=[*range(9), *range(PAIRS, PAIRS + 27)])
    numbers = analyse(few, study)
    assert numbers.discretisation is None
    assert "too few were simulated on coarser cells" in answer.certainty(numbers, study)
    assert "Fewer than 10 realisations completed on two sizes" in sections.precision(numbers)[1]


def test_coarser_cells_are_named_in_a_caption_only_where_there_are_some(study, ensemble):
    numbers = analyse(ensemble, study)
    assert "on coarser cells" in _settling(numbers).caption
    assert "on coarser cells" not in _settling(replace(numbers, coarser=0)).caption


def test_a_campaign_with_a_question_ends_with_its_answer_alone(study, ensemble):
    answered, note, cells, cost = summary_lines(ensemble, study)
    found = analyse(ensemble, study).answer
    assert answered.startswith(f"mean run-out = {found.value:.4g} m, 95 % interval")
    assert answered.endswith(f"{PAIRS} realisations on the study's own cells)")
    assert note.startswith(f"with {3 * PAIRS} on coarser ones of 0.5 m")
    assert "the answer is 1.0 m too low" in cells
    assert cost.startswith("cost")
    assert cost.endswith(f"0 of {4 * PAIRS} failed)")


def test_of_two_phases_the_page_shows_the_first_realisations_and_the_answer_uses_all(study, ensemble):
    phases = study.with_changes({"study.until.at_most": 96, "estimator.method": "two_phase"})
    numbers = analyse(ensemble, phases)
    assert (numbers.held, numbers.used, sum(numbers.statuses.values())) == (PAIRS, PAIRS, 32)
    assert "most of all were chosen where the coarser ones leave the answer open" in answer.basis(numbers, phases)
    assert not any("missing index" in warning for warning in answer.warnings(numbers, phases))
    assert numbers.answer.n == PAIRS
    assert "double sampling" in numbers.answer.method
    assert numbers.discretisation.n == PAIRS  # chosen ones too, by their strata
    assert numbers.settling.value[-1] == numbers.answer.value
    assert numbers.mean_run_out.n == 32  # another question than the study's, but for which the rows were not chosen
