"""What drives the quantity in question."""

import numpy as np
from synthetic import make_ensemble, make_study

from rfmpm.report.answering import Answers
from rfmpm.report.driving import drivers

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
