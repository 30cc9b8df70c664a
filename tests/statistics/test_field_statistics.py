"""Mean, standard deviation and correlation of the field over 2000 realisations on a small slope."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.field import prepare, realise
from rfmpm.random_fields.statistics import statistics

REALISATIONS = 2000
EXACT = ("cholesky", "circulant", "auto")
MEAN = 20e3


def slope_points() -> np.ndarray:
    # A crest of 4 m and a face at 45 degrees, 3 m high, points every 0.25 m.
    x, y = np.meshgrid(np.arange(0.125, 7.0, 0.25), np.arange(0.125, 3.0, 0.25))
    inside = x + y < 7.0
    return np.column_stack([x[inside], y[inside]])


def settings(correlation: str, distribution: str, method: str) -> SimpleNamespace:
    return SimpleNamespace(
        distribution=distribution,
        coefficient_of_variation=0.25,
        correlation=correlation,
        scale_of_fluctuation_h_m=3.0,
        scale_of_fluctuation_v_m=1.0,
        rotation_deg=0.0,
        method=method,
        averaging="point",
        lower_over_mean=0.2,
        upper_over_mean=3.0,
        sample=tuple(np.random.default_rng(3).gamma(4.0, 5.0, 60)),
        matern_nu=1.5,
    )


# Correlation and method make the standard-normal field, the distribution turns each of its values: every correlation is
# put together with every distribution in the larger ensembles.
CASES = [*product(CORRELATIONS, ["lognormal"], EXACT), ("markov_ellipsoidal", "gamma", "cholesky")]


@pytest.mark.parametrize(("correlation", "distribution", "method"), CASES)
def test_found_is_asked_within_four_standard_errors(correlation, distribution, method):
    points, asked = slope_points(), settings(correlation, distribution, method)
    prepared = prepare(asked, MEAN, points)
    xis = np.random.default_rng(2016).standard_normal((REALISATIONS, prepared.n_variables))
    found = statistics(prepared, asked, MEAN, points, xis)
    for axis in ("correlation_h", "correlation_v"):
        assert len([statistic for statistic in found if statistic.name == axis]) == 8
    for statistic in found:
        assert abs(statistic.found - statistic.asked) < 4.0 * statistic.standard_error, statistic


@pytest.mark.parametrize("correlation", CORRELATIONS)
def test_increments_are_jointly_normal(correlation):
    """The kurtosis of increments is 3: a sum of few random modes has the right covariance and fails here."""
    points = slope_points()
    prepared = prepare(settings(correlation, "lognormal", "cholesky"), MEAN, points)
    xis = np.random.default_rng(78).standard_normal((REALISATIONS, prepared.n_variables))
    z = np.log([realise(prepared, xi) for xi in xis])
    increment = z[:, 1:] - z[:, :-1]
    second, fourth = (increment**2).mean(axis=1), (increment**4).mean(axis=1)
    # Delta method on the ratio of two averages over independent realisations, for increments of unequal variance.
    scale = (increment**2).mean(axis=0)
    expected = 3.0 * (scale**2).mean() / scale.mean() ** 2
    ratio = fourth.mean() / second.mean() ** 2
    influence = fourth / second.mean() ** 2 - 2.0 * ratio * second / second.mean()
    assert abs(ratio - expected) < 4.0 * influence.std(ddof=1) / np.sqrt(REALISATIONS)
