"""The share of the variance that a Karhunen-Loeve expansion keeps, as a key of a study."""

import numpy as np
import pytest

from rfmpm.random_fields.field import prepare
from rfmpm.random_fields.methods import METHODS, covariance_error
from rfmpm.random_fields.methods.karhunen_loeve import DEFAULT_SHARE

SHARES = (0.5, 0.8, 0.95, 0.99, 0.9999)
POINTS = np.array([(0.25 + 0.5 * i, 0.25 + 0.5 * j) for j in range(8) for i in range(16)])


@pytest.fixture
def expansion(settings):
    settings.method = "karhunen_loeve"
    return settings


@pytest.mark.parametrize("correlation", ["markov_ellipsoidal", "markov_separable"])
def test_a_larger_share_takes_more_variables_and_errs_less(expansion, correlation):
    expansion.correlation = correlation
    counts, errors = [], []
    for share in SHARES:
        expansion.karhunen_loeve_variance_share = share
        prepared = prepare(expansion, 20e3, POINTS)
        counts.append(prepared.n_variables)
        errors.append(covariance_error("karhunen_loeve", prepared.record))
        assert prepared.record.lost <= 1.0 - share + 1e-12  # rounding of the sum
    assert np.all(np.diff(counts) > 0)
    assert np.all(np.diff(errors) < 0.0)
    assert errors[-1] < 2e-3  # at most the lost variance of the point that keeps least, ten or so times the mean share


def test_a_share_that_is_not_given_is_the_default(expansion):
    left_out = prepare(expansion, 20e3, POINTS)
    expansion.karhunen_loeve_variance_share = DEFAULT_SHARE
    given = prepare(expansion, 20e3, POINTS)
    assert left_out.options == {}
    for one, other in zip(left_out.record, given.record, strict=True):
        np.testing.assert_array_equal(one, other)


def test_other_methods_are_given_nothing(settings):
    settings.karhunen_loeve_variance_share = 0.5
    assert prepare(settings, 20e3, POINTS).options == {}


def test_each_share_has_its_own_record_in_a_store_and_among_fields(expansion, tmp_path, monkeypatch):
    first = prepare(expansion, 20e3, POINTS, tmp_path)
    expansion.karhunen_loeve_variance_share = 0.5
    second = prepare(expansion, 20e3, POINTS, tmp_path, shared=[first])
    assert second.n_variables < first.n_variables
    assert len(list(tmp_path.glob("*.amplitudes.npy"))) == 2
    assert prepare(expansion, 20e3, POINTS, shared=[first, second]).record is second.record

    def again(correlation, points, **options):
        raise AssertionError("prepared again")

    monkeypatch.setattr(METHODS["karhunen_loeve"], "prepare", staticmethod(again))
    assert prepare(expansion, 20e3, POINTS, tmp_path).n_variables == second.n_variables
