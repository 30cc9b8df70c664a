"""Ensembles of 20 000 against the asked statistics, for every correlation with every marginal distribution.

A test makes several hundred comparisons. Its bound is the number of standard errors that all of them together exceed
as rarely as a single comparison exceeds three: 0.27 % of fresh seeds (Bonferroni). Seeds are fixed.
"""

from functools import cache
from statistics import NormalDist

import ensemble
import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.field import prepare, realise_standard_normal
from rfmpm.random_fields.gaussian_space import space_map
from rfmpm.random_fields.marginals import MARGINALS

REALISATIONS, AT_ONCE = 20_000, 4_000
FALSE_ALARM = 2.0 * NormalDist().cdf(-3.0)
BOX = (ensemble.SPACING, ensemble.SPACING)


def linear_map(prepared) -> np.ndarray:
    """The matrix that turns `xi` into the standard-normal field, shape (points, variables)."""
    return np.array([realise_standard_normal(prepared, unit) for unit in np.eye(prepared.n_variables)]).T


def draw(factor: np.ndarray, count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal((count, factor.shape[1])) @ factor.T


@cache
def standard_normal(correlation: str) -> np.ndarray:
    prepared = prepare(ensemble.settings(correlation, "lognormal"), ensemble.MEAN, ensemble.lattice())
    return draw(linear_map(prepared), REALISATIONS, seed=2016)


def asked_correlation(correlation) -> np.ndarray:
    points = ensemble.lattice()
    return correlation.rho(*np.moveaxis(points[:, None] - points, 2, 0))


def assert_within_bound(differences: dict[str, np.ndarray]) -> None:
    count = sum(found.size for found in differences.values())
    bound = -NormalDist().inv_cdf(0.5 * FALSE_ALARM / count)
    for name, found in differences.items():
        assert np.max(np.abs(found)) < bound, f"{name}: {np.max(np.abs(found)):.2f} of {bound:.2f} standard errors"


@pytest.mark.parametrize("space", ["gaussian", "physical"])
@pytest.mark.parametrize("distribution", MARGINALS)
@pytest.mark.parametrize("correlation", ["markov_separable", "markov_ellipsoidal", "spherical", "cosine_exponential"])
def test_the_linear_map_gives_the_asked_covariance(correlation, distribution, space):
    """Without any sampling: the covariance of the standard-normal field, and the physical one that follows from it."""
    settings = ensemble.settings(correlation, distribution, correlation_space=space)
    prepared = prepare(settings, ensemble.MEAN, ensemble.lattice())
    factor = linear_map(prepared)
    covariance = factor @ factor.T
    np.testing.assert_allclose(covariance, asked_correlation(prepared.correlation), rtol=0, atol=1e-10)  # of the factor
    if space == "physical":
        asked = asked_correlation(CORRELATIONS[correlation](2.0, 1.0))
        physical = space_map(prepared.marginal).to_physical(np.clip(covariance, -1.0, 1.0))
        # The same through the slope of the map, at most about 1 / share of the first polynomial; the sample's is rough.
        np.testing.assert_allclose(physical, asked, rtol=0, atol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("distribution", MARGINALS)
@pytest.mark.parametrize("correlation", CORRELATIONS)
def test_mean_variance_covariance_and_averages_of_the_physical_field(correlation, distribution):
    settings = ensemble.settings(correlation, distribution)
    kernel = CORRELATIONS[correlation](2.0, 1.0)
    own = {name: getattr(settings, name) for name in MARGINALS[distribution].needs}
    marginal = MARGINALS[distribution].from_moments(ensemble.MEAN, ensemble.SPREAD, **own)
    variance = (ensemble.MEAN * ensemble.SPREAD) ** 2
    covariance = variance * space_map(marginal).to_physical(asked_correlation(kernel))
    values = marginal.transform(standard_normal(correlation))
    assert_within_bound(ensemble.physical_differences(values, covariance))


@pytest.mark.slow
@pytest.mark.parametrize("correlation", CORRELATIONS)
def test_the_standard_normal_field_is_jointly_normal(correlation):
    asked = asked_correlation(CORRELATIONS[correlation](2.0, 1.0))
    assert_within_bound(ensemble.normal_differences(standard_normal(correlation), asked))


@pytest.mark.slow
@pytest.mark.parametrize("distribution", ["lognormal", "gamma", "empirical"])
@pytest.mark.parametrize("changes", [{"averaging": "volume"}, {"nugget": 0.3}], ids=str)
def test_correlation_in_physical_space_with_averages_and_with_a_nugget(distribution, changes):
    settings = ensemble.settings("markov_ellipsoidal", distribution, correlation_space="physical", **changes)
    prepared = prepare(settings, ensemble.MEAN, ensemble.lattice(), box=BOX)
    z = draw(linear_map(prepared), REALISATIONS, seed=7)
    variance = (ensemble.MEAN * ensemble.SPREAD) ** 2 * prepared.variance_factor
    physical = space_map(prepared.marginal).to_physical(asked_correlation(prepared.correlation))
    if "nugget" in changes:
        stated = asked_correlation(CORRELATIONS["markov_ellipsoidal"](2.0, 1.0)) * 0.7 + 0.3 * np.eye(len(physical))
        np.testing.assert_allclose(physical, stated, rtol=0, atol=1e-8)  # table of the map
    differences = ensemble.physical_differences(prepared.marginal.transform(z), variance * physical)
    assert_within_bound(differences | ensemble.normal_differences(z, asked_correlation(prepared.correlation)))


# --- the comparisons themselves, with a tenth of the realisations and errors that they must see

FEWER = 2_000


def small_ensemble(wrong=None):
    settings = ensemble.settings("markov_ellipsoidal", "lognormal")
    prepared = prepare(settings, ensemble.MEAN, ensemble.lattice())
    z = draw(linear_map(prepared), FEWER, seed=11)
    correlation = asked_correlation(prepared.correlation)
    physical = space_map(prepared.marginal).to_physical(correlation)
    covariance = (ensemble.MEAN * ensemble.SPREAD) ** 2 * physical
    if wrong == "one point varies more":
        z[:, 77] *= 1.15
    elif wrong in ("longer scale", "much longer scale"):
        theta = 2.3 if wrong == "longer scale" else 4.0
        other = ensemble.settings("markov_ellipsoidal", "lognormal", scale_of_fluctuation_h_m=theta)
        z = draw(linear_map(prepare(other, ensemble.MEAN, ensemble.lattice())), FEWER, seed=11)
    elif wrong == "few modes":
        z = few_modes(FEWER)
    values = prepared.marginal.transform(z) * (1.02 if wrong == "higher mean" else 1.0)
    return ensemble.physical_differences(values, covariance) | ensemble.normal_differences(z, correlation)


def few_modes(count: int) -> np.ndarray:
    """Sums of eight cosines of random phase: their covariance is about right, the field is not normal."""
    rng, points = np.random.default_rng(5), ensemble.lattice()
    # Frequencies of exp(-2 r / theta) in the plane: a Cauchy distribution in two dimensions.
    normal = rng.standard_normal((count, 8, 3))
    frequency = normal[..., :2] / np.abs(normal[..., 2:]) * (2.0 / np.array([2.0, 1.0]))
    phase = rng.uniform(0.0, 2.0 * np.pi, (count, 8, 1))
    return 0.5 * np.cos(frequency @ points.T + phase).sum(axis=1)


def test_comparisons_pass_a_right_ensemble():
    assert_within_bound(small_ensemble())


@pytest.mark.parametrize(
    ("wrong", "seen"),
    [
        ("higher mean", "mean"),
        ("one point varies more", "variance"),
        ("longer scale", "covariance over lags"),
        ("few modes", "kurtosis of increments"),
        ("few modes", "variation of variograms"),
    ],
)
def test_comparisons_see_a_wrong_ensemble(wrong, seen):
    with pytest.raises(AssertionError, match="standard errors"):
        assert_within_bound({seen: small_ensemble(wrong)[seen]})


def test_averages_over_boxes_see_a_longer_scale():
    found = small_ensemble("much longer scale")["variance of box averages"]
    assert np.all(found[2:] > 4.0)
