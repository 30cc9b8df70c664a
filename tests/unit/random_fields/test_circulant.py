"""Circulant embedding: padding, negative eigenvalues, and the error that is stored."""

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.lattice import find_lattice
from rfmpm.random_fields.methods import embedding
from rfmpm.random_fields.methods.circulant import Circulant
from rfmpm.random_fields.methods.embedding import embed


def block(columns: int, rows: int, spacing: float = 0.125) -> np.ndarray:
    x, y = np.meshgrid(spacing * np.arange(columns), spacing * np.arange(rows))
    return np.column_stack([x.ravel(), y.ravel()])


def test_the_minimal_torus_of_a_long_scale_is_not_positive_and_padding_cures_it(monkeypatch):
    correlation, lattice = CORRELATIONS["markov_ellipsoidal"](15.0, 5.0), find_lattice(block(120, 40))
    assert embed(correlation, lattice, 1e-10).error < 1e-10
    monkeypatch.setattr(embedding, "FOLDS", (2.0,))
    monkeypatch.setattr(embedding, "WIDENINGS", ())
    minimal = embed(correlation, lattice, 1e-10)
    assert minimal.clipped > 1e-3
    assert minimal.error > 1e-3


def test_the_stored_error_is_that_of_the_field():
    correlation, points = CORRELATIONS["gaussian"](1.0, 0.5, 0.3), block(10, 6)
    record = Circulant.prepare(correlation, points)
    count = Circulant.n_variables(record)
    factor = np.array([Circulant.transform(record, unit) for unit in np.eye(count)]).T
    lag = points[:, None] - points[None, :]
    error = np.max(np.abs(factor @ factor.T - correlation.rho(lag[..., 0], lag[..., 1])))
    assert 1e-8 < error <= 5e-4
    assert record.error == pytest.approx(error, rel=1e-6, abs=1e-13)  # the same lags, in another order of sums


def test_an_embedding_that_is_not_accurate_is_refused():
    with pytest.raises(ValueError, match=r"circulant: .* covariance error of .*: take method cholesky"):
        Circulant.prepare(CORRELATIONS["markov_ellipsoidal"](100.0, 0.1, 0.3), block(12, 7))
