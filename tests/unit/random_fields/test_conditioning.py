"""Conditioning: mean and covariance of its linear map are the conditional ones, and data are honoured."""

import numpy as np
import pytest

from rfmpm.random_fields.conditioning import condition, conditional_covariance, update
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.field import prepare, realise
from rfmpm.random_fields.measurements import StandardNormalData
from rfmpm.random_fields.methods import METHODS

every_correlation = pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
ROUNDING = 1e-9  # of a covariance between near places, factored with nuggets of at most 1e-10


def covariance(correlation, first, second):
    lag = first[:, None] - second[None, :]
    return correlation.rho(lag[..., 0], lag[..., 1])


def lattice(nx: int = 24, ny: int = 12, spacing: float = 0.5) -> np.ndarray:
    x, y = np.meshgrid(spacing * (np.arange(nx) + 0.5), spacing * (np.arange(ny) + 0.5))
    return np.column_stack([x.ravel(), y.ravel()])


def data_among(points: np.ndarray) -> StandardNormalData:
    """On points, between them, outside the domain and far away; exact and with errors."""
    places = np.vstack([points[[3, 100, 101, 250]], [[3.1, 2.2], [7.77, 4.01], [8.0, 3.9], [-1.0, 1.0], [5e3, 5e3]]])
    values = np.array([0.5, -1.2, -0.9, 1.4, 0.3, 2.0, 1.1, -0.4, 0.7])
    return StandardNormalData(places, values, np.array([0.0, 0.0, 0.04, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0]))


def linear_map(method, record, conditioning, n_method: int):
    """The conditional field is b + A xi: b, A; not with a random window, and with millions of columns for a series."""
    n = n_method + conditioning.n_variables

    def field(xi):
        return update(conditioning, method.transform(record, xi[:n_method]), xi[n_method:])

    constant = field(np.zeros(n))
    return constant, np.array([field(unit) - constant for unit in np.eye(n)]).T


@every_correlation
@pytest.mark.parametrize("name", sorted(set(METHODS) - {"local_kriging", "local_average_subdivision"}))
def test_mean_and_covariance_are_the_conditional_ones(kernel, name):
    rotation = 0.0 if name in ("ar1", "kronecker") else 0.2  # those two go along x and y only
    points, correlation, method = lattice(), kernel(3.0, 1.0, rotation), METHODS[name]
    data = data_among(points)
    try:
        record = method.prepare(correlation, points)
    except ValueError as refusal:
        pytest.skip(str(refusal))
    conditioning = condition(correlation, points, data)
    constant, linear = linear_map(method, record, conditioning, method.n_variables(record))
    gain = np.linalg.solve(
        covariance(correlation, data.places, data.places) + np.diag(data.error_variances),
        covariance(correlation, data.places, points),
    )
    asked = covariance(correlation, points, points) - gain.T @ covariance(correlation, data.places, points)
    unconditional = np.array([method.transform(record, unit) for unit in np.eye(method.n_variables(record))]).T
    of_method = np.abs(unconditional @ unconditional.T - covariance(correlation, points, points)).max()
    np.testing.assert_allclose(constant, gain.T @ data.values, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(conditioning.mean, constant, rtol=0, atol=1e-12)
    # An error of the method enters three times: directly and on both sides of the update, by weights of a sum below 2.
    tolerance = ROUNDING + 9.0 * of_method + conditioning.covariance_error
    np.testing.assert_allclose(linear @ linear.T, asked, rtol=0, atol=tolerance)
    np.testing.assert_allclose(conditioning.deviation**2, np.diag(asked), rtol=0, atol=ROUNDING)
    first, second = np.arange(0, 200), np.arange(30, 230)
    found = conditional_covariance(correlation, conditioning, points, first, second)
    np.testing.assert_allclose(found, asked[first, second], rtol=0, atol=ROUNDING)


@every_correlation
def test_with_all_points_as_neighbours_nothing_is_left(kernel):
    conditioning = condition(kernel(3.0, 1.0), points := lattice(), data_among(points))
    assert conditioning.covariance_error < 1e-4
    if kernel is CORRELATIONS["markov_separable"]:  # screened by the four points around a datum
        assert conditioning.covariance_error < ROUNDING


@every_correlation
@pytest.mark.parametrize(
    ("distribution", "spread"), [("lognormal", 0.25), ("lognormal", 2.0), ("normal_truncated", 0.9)]
)
def test_exact_data_on_points_are_honoured(settings, measured, kernel, distribution, spread):
    settings.correlation = next(name for name, entry in CORRELATIONS.items() if entry is kernel)
    settings.distribution, settings.coefficient_of_variation, settings.matern_nu = distribution, spread, 1.5
    points = lattice()
    on = np.arange(0, 288, 17)
    values = 20e3 * (1.0 + 0.3 * np.sin(points[on, 0]) * np.cos(points[on, 1]))
    prepared = prepare(settings, 20e3, points, data=measured(points[on], values))
    assert prepared.n_variables == len(points)  # no variable for data that are exact and on points
    for xi in np.random.default_rng(2).standard_normal((5, prepared.n_variables)):
        np.testing.assert_allclose(realise(prepared, xi)[on], values, rtol=1e-9)


def test_data_too_close_for_a_smooth_correlation_are_honoured_too():
    # Their covariance is singular to rounding, so that the weights are those of data with a nugget.
    correlation, points = CORRELATIONS["gaussian"](6.0, 6.0), lattice(10, 8, 0.1)
    record = METHODS["cholesky"].prepare(correlation, points)
    rng = np.random.default_rng(6)
    on = np.arange(0, 80, 2)
    values = METHODS["cholesky"].transform(record, rng.standard_normal(80))[on]
    conditioning = condition(correlation, points, StandardNormalData(points[on], values, np.zeros(len(on))))
    z = METHODS["cholesky"].transform(record, rng.standard_normal(80))
    np.testing.assert_allclose(update(conditioning, z, np.zeros(0))[on], values, rtol=0, atol=1e-12)


def test_an_exact_datum_between_points_is_approached_by_near_points():
    correlation = CORRELATIONS["gaussian"](6.0, 6.0)
    points = np.vstack([lattice(), [[3.1 + 1e-4, 2.2]]])
    conditioning = condition(correlation, points, StandardNormalData(np.array([[3.1, 2.2]]), np.ones(1), np.zeros(1)))
    # sqrt(2 (1 - rho)) over 0.1 mm: pi / 36 * 1e-8 under the root
    assert conditioning.deviation[-1] < 2.0 * np.sqrt(2.0 * np.pi / 36.0) * 1e-4
    assert conditioning.mean[-1] == pytest.approx(1.0, abs=1e-8)


def test_data_far_away_change_nothing():
    correlation, points = CORRELATIONS["markov_ellipsoidal"](6.0, 1.0), lattice()
    conditioning = condition(correlation, points, StandardNormalData(np.array([[1e6, 0.0]]), np.ones(1), np.zeros(1)))
    z = np.random.default_rng(1).standard_normal(len(points))
    np.testing.assert_array_equal(update(conditioning, z, np.zeros(1)), z)


def test_coincident_data_with_errors_count_as_their_average():
    correlation, points = CORRELATIONS["markov_separable"](6.0, 1.0), lattice()
    place = np.array([[4.2, 3.3]])
    two = StandardNormalData(np.vstack([place, place]), np.array([1.0, 0.0]), np.array([0.1, 0.3]))
    one = StandardNormalData(place, np.array([0.75]), np.array([0.075]))  # weights 1/0.1 and 1/0.3
    first, second = (condition(correlation, points, data) for data in (two, one))
    np.testing.assert_allclose(first.mean, second.mean, rtol=0, atol=1e-12)
    np.testing.assert_allclose(first.deviation, second.deviation, rtol=0, atol=1e-12)


def test_a_smooth_correlation_cannot_jump_between_close_exact_data():
    correlation = CORRELATIONS["gaussian"](6.0, 6.0)
    data = StandardNormalData(np.array([[3.0, 2.0], [3.01, 2.0]]), np.array([1.0, -1.0]), np.zeros(2))
    with pytest.raises(ValueError, match="measurement_error"):
        condition(correlation, lattice(), data)
    condition(correlation, lattice(), data._replace(error_variances=np.array([0.5, 0.5])))


def test_five_hundred_data(settings, measured):
    points = lattice(60, 40, 0.25)
    rng = np.random.default_rng(4)
    places = np.vstack([points[rng.choice(len(points), 250, replace=False)], rng.uniform(0, 10, (250, 2))])
    data = measured(places, 20e3 * np.exp(0.2 * rng.standard_normal(500)), np.where(np.arange(500) < 100, 0.0, 0.1))
    settings.correlation = "markov_separable"
    prepared = prepare(settings, 20e3, points, data=data)
    field = realise(prepared, rng.standard_normal(prepared.n_variables))
    on = [int(np.flatnonzero(np.all(points == place, axis=1))[0]) for place in places[:100]]
    np.testing.assert_allclose(field[on], data.values[:100], rtol=1e-9)
