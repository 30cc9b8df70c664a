import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.field import prepare, realise, realise_standard_normal


def test_settings_reach_the_correlation(settings, points):
    settings.rotation_deg = 30.0
    prepared = prepare(settings, 20e3, points)
    assert prepared.correlation == CORRELATIONS["markov_ellipsoidal"](6.0, 1.0, np.radians(30.0))
    assert prepared.n_variables == len(points)


def test_a_lognormal_field_at_xi_zero_is_the_median(settings, points):
    prepared = prepare(settings, 20e3, points)
    field = realise(prepared, np.zeros(prepared.n_variables))
    # Median of a lognormal: mean / sqrt(1 + V^2).
    np.testing.assert_allclose(field, 20e3 / np.sqrt(1.0 + 0.25**2), rtol=1e-12)


def test_the_field_is_the_marginal_of_the_standard_normal_field(settings, points):
    prepared = prepare(settings, 20e3, points)
    xi = np.random.default_rng(5).standard_normal(prepared.n_variables)
    s = np.sqrt(np.log(1.0 + 0.25**2))
    expected = np.exp(np.log(20e3) - 0.5 * s**2 + s * realise_standard_normal(prepared, xi))
    np.testing.assert_allclose(realise(prepared, xi), expected, rtol=1e-12)


@pytest.mark.parametrize("shape", [(149,), (151,), (150, 1), (1, 150), ()])
def test_xi_of_another_shape_is_refused(settings, points, shape):
    with pytest.raises(ValueError, match=r"must be \(150,\)"):
        realise(prepare(settings, 20e3, points), np.zeros(shape))


@pytest.mark.parametrize("key", ["correlation", "distribution", "method"])
def test_an_unknown_name_is_refused_with_the_choices(settings, points, key):
    known = getattr(settings, key)
    setattr(settings, key, "cubic")
    with pytest.raises(ValueError, match=f'{key} = "cubic": must be one of .*{known}'):
        prepare(settings, 20e3, points)


@pytest.mark.parametrize("bad", [np.zeros((0, 2)), np.zeros((4, 3)), np.zeros(4), np.array([[0.0, np.nan]])])
def test_points_that_are_not_positions_are_refused(settings, bad):
    with pytest.raises(ValueError, match="points"):
        prepare(settings, 20e3, bad)
