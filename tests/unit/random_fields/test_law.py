"""What the settings of a study make of a field: spaces, nugget and averages together."""

import numpy as np
import pytest

from rfmpm.random_fields.averaging import VolumeAveraged
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.correlation.nugget import WithNugget
from rfmpm.random_fields.field import prepare, realise, realise_standard_normal
from rfmpm.random_fields.gaussian_space import space_map
from rfmpm.random_fields.law import law_of
from rfmpm.random_fields.marginals import MARGINALS

OWN = {
    "lower_over_mean": 0.2,
    "upper_over_mean": 5.0,
    "sample": tuple(np.random.default_rng(3).gamma(4.0, 5.0, 60)),
    "matern_nu": 1.5,
}
BOX = (0.25, 0.25)
LAGS = np.random.default_rng(2).uniform(-3.0, 3.0, (2, 200))


@pytest.fixture
def settings(settings):
    for name, value in OWN.items():
        setattr(settings, name, value)
    return settings


def asked(settings):
    return CORRELATIONS[settings.correlation](settings.scale_of_fluctuation_h_m, settings.scale_of_fluctuation_v_m)


@pytest.mark.parametrize("correlation", CORRELATIONS)
@pytest.mark.parametrize("distribution", MARGINALS)
def test_correlation_and_distribution_are_as_asked_in_either_space(settings, correlation, distribution):
    settings.correlation, settings.distribution = correlation, distribution
    plain = law_of(settings)
    assert plain.correlation == asked(settings)
    settings.correlation_space = "physical"
    law = law_of(settings)
    assert law.marginal(20e3, 0.25) == plain.marginal(20e3, 0.25)
    physical = space_map(law.marginal(20e3, 0.25)).to_physical(law.correlation.rho(*LAGS))
    np.testing.assert_allclose(physical, asked(settings).rho(*LAGS), rtol=0, atol=1e-9)  # table of the map


@pytest.mark.parametrize("space", ["gaussian", "physical"])
@pytest.mark.parametrize("distribution", MARGINALS)
def test_averages_have_the_mean_variance_and_covariance_of_the_physical_variable(settings, space, distribution):
    settings.distribution, settings.averaging, settings.correlation_space = distribution, "volume", space
    settings.coefficient_of_variation = 0.5
    law = law_of(settings, BOX)
    marginal = law.marginal(20e3, 0.5)
    point = space_map(law.point_marginal(20e3, 0.5))

    class Physical(CORRELATIONS[settings.correlation]):
        def rho(self, lag_x, lag_y):
            rho = super().rho(lag_x, lag_y)
            return rho if space == "physical" else point.to_physical(rho)

    average = VolumeAveraged(Physical(6.0, 1.0), *BOX)
    assert law.variance_factor == pytest.approx(average.variance_factor, rel=1e-12)
    z, step = np.linspace(-12.0, 12.0, 24_001, retstep=True)
    weight = step * np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi)
    value = marginal.transform(z)
    mean = np.sum(weight * value)
    variance = np.sum(weight * (value - mean) ** 2)
    assert mean == pytest.approx(20e3, rel=1e-8)
    assert variance == pytest.approx((20e3 * 0.5) ** 2 * average.variance_factor, rel=1e-8)
    covariance = variance * space_map(marginal).to_physical(law.correlation.rho(*LAGS))
    expected = (20e3 * 0.5) ** 2 * average.covariance(*LAGS)
    np.testing.assert_allclose(covariance, expected, rtol=0, atol=1e-8 * (20e3 * 0.5) ** 2)


def test_averaging_lowers_the_spread_and_keeps_the_mean_of_realisations(settings):
    x, y = np.meshgrid(0.25 * np.arange(20), 0.25 * np.arange(8))
    points = np.column_stack([x.ravel(), y.ravel()])
    settings.averaging, settings.coefficient_of_variation = "volume", 0.5
    prepared = prepare(settings, 20e3, points, box=BOX)
    assert prepared.variance_factor == law_of(settings, BOX).variance_factor < 1.0
    assert prepared.correlation == law_of(settings, BOX).correlation


def test_a_nugget_is_uncorrelated_variance_of_the_standard_normal_field(settings, points):
    settings.nugget = 0.3
    prepared = prepare(settings, 20e3, points)
    assert prepared.n_variables == 2 * len(points)
    factor = np.array([realise_standard_normal(prepared, unit) for unit in np.eye(prepared.n_variables)]).T
    lag = points[:, None] - points
    expected = prepared.correlation.rho(lag[..., 0], lag[..., 1])
    assert prepared.correlation == WithNugget(asked(settings), 0.3)
    np.testing.assert_allclose(factor @ factor.T, expected, rtol=0, atol=1e-10)  # nugget of the factorisation
    off = ~np.eye(len(points), dtype=bool)
    np.testing.assert_allclose(expected[off], 0.7 * asked(settings).rho(*lag[off].T), rtol=1e-14)
    assert np.all(np.diag(expected) == 1.0)


@pytest.mark.parametrize("distribution", MARGINALS)
def test_a_nugget_in_physical_space_is_that_share_of_the_physical_variance(settings, distribution):
    settings.distribution, settings.nugget, settings.correlation_space = distribution, 0.3, "physical"
    settings.coefficient_of_variation = 0.5
    law = law_of(settings)
    physical = space_map(law.marginal(1.0, 0.5)).to_physical(law.correlation.rho(*LAGS))
    np.testing.assert_allclose(physical, 0.7 * asked(settings).rho(*LAGS), rtol=0, atol=1e-9)  # table of the map


def test_coincident_points_differ_by_their_nuggets_alone(settings):
    settings.nugget = 0.3
    prepared = prepare(settings, 20e3, np.array([[1.0, 1.0], [1.0, 1.0]]))
    xi = np.random.default_rng(1).standard_normal(4)
    first, second = realise_standard_normal(prepared, xi)
    assert first - second == pytest.approx(np.sqrt(0.3) * (xi[2] - xi[3]), abs=1e-6)  # the factor's own nugget


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"nugget": 1.0}, "nugget = 1.0: must be at least 0 and less than 1"),
        ({"nugget": 0.1, "averaging": "volume"}, 'nugget: must be 0 where averaging = "volume"'),
        ({"averaging": "cell"}, 'averaging = "cell": must be one of point, volume'),
        ({"correlation_space": "log"}, 'correlation_space = "log": must be one of gaussian, physical'),
        ({"distribution": "beta", "upper_over_mean": None}, 'upper_over_mean: missing; distribution = "beta" needs it'),
        ({"distribution": "empirical", "sample": None}, "sample: missing"),
        ({"correlation": "matern", "matern_nu": None}, 'matern_nu: missing; correlation = "matern" needs it'),
    ],
    ids=str,
)
def test_settings_at_odds_are_refused_with_the_key(settings, points, changes, said):
    for name, value in changes.items():
        setattr(settings, name, value)
    with pytest.raises(ValueError, match=said):
        prepare(settings, 20e3, points, box=BOX)


def test_a_smooth_correlation_that_no_lognormal_has_is_refused_with_what_to_change(settings):
    x, y = np.meshgrid(0.25 * np.arange(24), 0.25 * np.arange(12))
    settings.correlation, settings.correlation_space = "gaussian", "physical"
    with pytest.raises(ValueError, match=r'not positive definite.*take correlation_space = "gaussian"'):
        prepare(settings, 20e3, np.column_stack([x.ravel(), y.ravel()]))


def test_averages_need_to_know_their_box(settings, points):
    settings.averaging = "volume"
    with pytest.raises(ValueError, match="needs the size of the boxes of the points"):
        prepare(settings, 20e3, points)


@pytest.mark.parametrize("distribution", MARGINALS)
@pytest.mark.parametrize("coefficient_of_variation", [0.01, 0.9])
@pytest.mark.parametrize("scales", [(1000.0, 1.0), (0.02, 0.02), (1500.0, 500.0)])
@pytest.mark.parametrize(("averaging", "rotation_deg"), [("point", 20.0), ("volume", 0.0)])
def test_extreme_scales_and_spreads_make_finite_positive_fields(
    settings, distribution, coefficient_of_variation, scales, averaging, rotation_deg
):
    """Theta from a tenth of the distance of the points to 100 times the 15 m of a slope, and a ratio of 1000."""
    x, y = np.meshgrid(0.25 * np.arange(8), 0.25 * np.arange(4))
    points = np.column_stack([x.ravel(), y.ravel()])
    settings.distribution, settings.coefficient_of_variation = distribution, coefficient_of_variation
    settings.scale_of_fluctuation_h_m, settings.scale_of_fluctuation_v_m = scales
    settings.averaging, settings.rotation_deg, settings.correlation_space = averaging, rotation_deg, "physical"
    prepared = prepare(settings, 20e3, points, box=BOX)
    field = realise(prepared, np.random.default_rng(1).standard_normal(prepared.n_variables))
    assert np.all(np.isfinite(field) & (field > 0.0))
