"""Questions and the functions that answer them."""

import numpy as np
import pytest

from rfmpm.estimators import Estimate, Exceedances, Question, Rows

ROWS = Rows(
    np.zeros(4, int), np.arange(4), np.array([1.0, 6.0, np.nan, 2.0]), np.array([False, False, True, True]), np.ones(4)
)


def test_exceedances_of_failed_and_censored_rows():
    np.testing.assert_array_equal(Exceedances(np.array([0.5, 5.0]))(ROWS), [[1, 0], [1, 1], [np.nan] * 2, [1, 1]])


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"kind": "median"}, "mean, exceedance, quantile"),
        ({"kind": "exceedance"}, "limit"),
        ({"kind": "quantile", "probability": 1.0}, "between 0 and 1"),
        ({"half_width": 0.0}, "half_width = 0.0"),
        ({"relative_half_width": -1.0}, "relative_half_width"),
        ({"confidence": 95.0}, "confidence = 95.0"),
        ({"at_most": 0}, "at_most"),
    ],
)
def test_questions_that_cannot_be_asked(parts, message):
    with pytest.raises(ValueError, match=message):
        Question("run_out", **parts)


def test_excess_of_the_width():
    estimate = Estimate(10.0, 8.0, 12.0, 0.95, 50, "")
    assert Question("run_out").excess(estimate) == 0.0
    assert Question("run_out", half_width=1.0).excess(estimate) == 2.0
    assert Question("run_out", relative_half_width=0.1).excess(estimate) == 2.0
    assert Question("run_out", half_width=1.0, relative_half_width=0.05).excess(estimate) == 4.0
    unknown = Estimate(float("nan"), 0.0, 1.0, 0.95, 50, "")
    assert Question("run_out", relative_half_width=0.1).excess(unknown) == np.inf
    assert Question("run_out", relative_half_width=0.1).excess(Estimate(0.0, 0.0, 0.1, 0.95, 50, "")) == np.inf
