import numpy as np
import pytest
from scipy.special import gamma, kv

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.correlation.matern import Matern

LAG = np.linspace(0.0, 12.0, 241)


def along_h(name: str, **own):
    return CORRELATIONS[name](2.0, 0.5, **own).rho(LAG, 0.0 * LAG)


@pytest.mark.parametrize(("nu", "same"), [(0.5, "markov_ellipsoidal"), (1.5, "second_order_markov")])
def test_matern_of_half_integer_order_is_a_markov_correlation(nu, same):
    np.testing.assert_allclose(along_h("matern", nu=nu), along_h(same), rtol=1e-12)  # identity


@pytest.mark.parametrize("nu", [0.05, 0.3, 0.5, 1.0, 2.5, 7.3, 19.5, 20.0])
def test_matern_against_its_definition(nu):
    s = 2.0 * np.sqrt(np.pi) * gamma(nu + 0.5) / gamma(nu) * LAG[1:] / 2.0
    expected = 2.0 ** (1.0 - nu) / gamma(nu) * s**nu * kv(nu, s)
    np.testing.assert_allclose(along_h("matern", nu=nu)[1:], expected, rtol=1e-11)  # identity; 1e-12 of it from kv


@pytest.mark.parametrize("nu", [0.05, 0.51, 4.2, 19.9])
def test_matern_starts_at_one_and_falls(nu):
    rho = Matern(1.0, 1.0, nu=nu).rho(np.concatenate([[0.0], np.logspace(-320, 3, 2000)]), np.zeros(2001))
    assert rho[0] == 1.0
    assert np.all(np.diff(rho) <= 1e-12)  # identity: rounding of K_nu
    assert rho[-1] < 1e-100


def test_a_very_smooth_matern_is_nearly_gaussian():
    assert np.max(np.abs(along_h("matern", nu=20.0) - along_h("gaussian"))) < 0.01


@pytest.mark.parametrize("nu", [0.0, 0.04, 20.1, np.nan])
def test_a_smoothness_out_of_range_is_refused(nu):
    with pytest.raises(ValueError, match=r"nu = .*between 0\.05 and 20"):
        Matern(1.0, 1.0, nu=nu)


def test_spherical_ends_at_four_thirds_of_theta():
    spherical = CORRELATIONS["spherical"](3.0, 3.0)
    assert spherical.rho(2.0, 0.0) == pytest.approx(0.3125, rel=1e-12)
    assert spherical.rho(3.99, 0.0) > 0.0
    assert spherical.rho(4.0, 0.0) == spherical.rho(0.0, 50.0) == 0.0


def test_cosine_exponential_is_lowest_at_three_quarters_pi():
    rho = along_h("cosine_exponential")
    assert LAG[np.argmin(rho)] / 2.0 == pytest.approx(0.75 * np.pi, abs=0.025)  # half a step of LAG
    assert rho.min() == pytest.approx(-np.exp(-0.75 * np.pi) / np.sqrt(2.0), abs=1e-4)  # curvature over half a step


def test_what_a_correlation_depends_on_is_in_its_description():
    assert "nu=2.5" in repr(Matern(1.0, 2.0, nu=2.5))
