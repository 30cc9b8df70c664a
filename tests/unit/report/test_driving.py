"""What drives the quantity in question."""

import numpy as np
from synthetic import make_ensemble, make_study

from rfmpm.report import sections
from rfmpm.report.answering import Answers
from rfmpm.report.driving import drivers
from rfmpm.report.numbers import analyse

KEYS = ("material.0.residual_cohesion_kpa", "boundary.base.coefficient")


def uncertain_study():
    entries = [{"key": key, "distribution": "uniform", "low": 0.2, "high": 0.4} for key in KEYS]
    entries[0] |= {"low": 2.0, "high": 6.0}
    return make_study(uncertain=entries)


def test_first_order_indices_tell_the_number_that_matters():
    study = uncertain_study()
    ensemble = make_ensemble(make_study(), n=200)
    numbers = np.random.default_rng(7).uniform(size=(200, 2))
    ensemble["uncertain_value"] = (("realisation", "uncertain"), numbers)
    ensemble["run_out"][:] = 10.0 * numbers[:, 1] + 1.0
    found = drivers(ensemble, study, Answers(ensemble, study, 0.95), None)
    indices = found.numbers["first_order_indices"]["indices"]
    assert len(found.charts) == 1
    # 10 classes of 20 rows: within a class a tenth of the range varies, a hundredth of the variance.
    assert indices.first[1] > 0.95
    assert indices.first[0] < indices.noise[0]


def test_nothing_is_said_where_nothing_can_be():
    study = make_study()
    ensemble = make_ensemble(study, n=8)
    found = drivers(ensemble, study, Answers(ensemble, study, 0.95), None)
    assert found.charts + found.maps == []
    assert found.numbers == {}


def test_of_a_design_base_points_before_a_gap_count_and_their_first_blocks_alone_have_intervals():
    study = uncertain_study().with_changes({"estimator": {"sampling": "saltelli"}, "study.realisations": 200})
    ensemble = make_ensemble(make_study(), n=200)
    holed = ensemble.isel(realisation=[i for i in range(200) if i != 152])  # blocks of 5: base point 30 is not whole
    found = drivers(holed, study, Answers(holed, study, 0.95), None)
    assert found.numbers["sobol_indices"]["indices"].base_points == 30
    numbers = analyse(ensemble, study)
    assert sum(mode.count for mode in numbers.modes) == 40
    assert numbers.given_failure["median"].n == 40
    assert "first simulation of each base point" in sections.sample(numbers, study)
