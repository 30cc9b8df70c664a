from dataclasses import replace

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.field import prepare
from rfmpm.random_fields.statistics import point_pairs, statistics


def lattice(spacing: float = 0.25) -> np.ndarray:
    x, y = np.meshgrid(np.arange(40) * spacing, np.arange(20) * spacing)
    return np.column_stack([x.ravel(), y.ravel()])


def test_pairs_on_a_lattice_are_exactly_one_lag_apart():
    points, correlation = lattice(), CORRELATIONS["markov_separable"](4.0, 1.0)
    pairs = list(point_pairs(correlation, points))
    assert [pair.lag for pair in pairs] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, *np.arange(0.25, 2.1, 0.25)]
    for pair in pairs:
        lag = points[pair.second] - points[pair.first]
        expected = [pair.lag, 0.0] if pair.name == "correlation_h" else [0.0, pair.lag]
        np.testing.assert_allclose(lag, np.broadcast_to(expected, lag.shape), atol=1e-12)
        assert pair.asked == pytest.approx(correlation.rho(*expected), rel=1e-12)


def test_pairs_follow_the_rotation():
    points, correlation = lattice(), CORRELATIONS["markov_separable"](4.0, 1.0, np.pi / 2)
    for pair in point_pairs(correlation, points):
        across, along = np.median(points[pair.second] - points[pair.first], axis=0)
        expected = (0.0, pair.lag) if pair.name == "correlation_h" else (-pair.lag, 0.0)
        assert (across, along) == pytest.approx(expected, abs=1e-12)


def test_lags_without_pairs_are_left_out():
    pairs = list(point_pairs(CORRELATIONS["gaussian"](100.0, 0.1), lattice()))
    assert all(pair.lag <= 10.0 for pair in pairs if pair.name == "correlation_h")
    # theta / 4 along the v axis is a tenth of the spacing: a point is its own nearest, which is no pair.
    assert all(pair.lag > 0.125 for pair in pairs if pair.name == "correlation_v")


def test_statistics_see_a_field_with_twice_the_scale(settings):
    points = lattice()[::3]
    prepared = prepare(settings, 20e3, points)
    asked = replace(prepared, correlation=CORRELATIONS["markov_ellipsoidal"](3.0, 0.5))
    xis = np.random.default_rng(1).standard_normal((300, prepared.n_variables))
    right = {(s.name, s.lag): s for s in statistics(prepared, settings, 20e3, points, xis)}
    wrong = statistics(asked, settings, 20e3, points, xis)
    assert all(abs(s.found - s.asked) < 4.0 * s.standard_error for s in right.values())
    assert max((s.found - s.asked) / s.standard_error for s in wrong) > 10.0


def test_one_realisation_is_refused(settings, points):
    prepared = prepare(settings, 20e3, points)
    with pytest.raises(ValueError, match="two or more"):
        statistics(prepared, settings, 20e3, points, [np.zeros(prepared.n_variables)])
