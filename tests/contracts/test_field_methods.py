"""Every field method: the asked covariance to the stated error, exactly repeatable, and right or refused with a reason.

The covariance is deterministic: fields of unit vectors are the columns of the linear map A, and A A^T is compared.
"""

from functools import cache
from itertools import product

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.random_fields import properties
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.methods import METHODS, choose, covariance_error
from rfmpm.random_fields.methods.circulant import Circulant

every_method = pytest.mark.parametrize("method", METHODS)
ROUNDING = 1e-10  # identity up to rounding and the largest nugget that a method may add
DEFAULT = 5e-4  # what the circulant embedding asks of itself
STATED = {
    "karhunen_loeve": 0.5,
    "local_average_subdivision": 0.1,
    "local_kriging": 0.02,
}  # theirs, on these points, at most
MOST_VARIABLES = 3000  # of which the linear map is formed, for time's sake
LINEAR = [name for name in METHODS if name != "local_average_subdivision"]  # its window is a step in two variables


def points_of(kind: str) -> np.ndarray:
    x, y = np.meshgrid(0.1 + 0.25 * np.arange(12), 0.25 * np.arange(6))
    lattice = np.column_stack([x.ravel(), y.ravel()])
    some = np.random.default_rng(7).permutation(len(lattice))[:40]
    return {
        "lattice": lattice,
        "part": lattice[some],
        "row": lattice[:12],
        "column": lattice[::12],
        "single": lattice[:1],
        "coincident": np.concatenate([lattice[some], lattice[some[:5]]]),
        "scattered": np.random.default_rng(7).uniform([0.0, 0.0], [3.0, 1.5], (40, 2)),
    }[kind]


POINTS = ("lattice", "part", "row", "column", "single", "coincident", "scattered")
SCALES = ((1.0, 0.5, 0.0), (1.0, 0.5, 0.4))
ODD_SCALES = (
    (0.025, 0.025, 0.0),  # a tenth of a spacing
    (300.0, 150.0, 0.0),  # a hundred domains
    (300.0, 150.0, 0.3),
    (50.0, 0.05, 0.0),  # a ratio of a thousand
    (50.0, 0.05, 0.3),
    (1.0, 0.5, np.pi / 2),
)


def asked_covariance(correlation, points: np.ndarray) -> np.ndarray:
    lag = points[:, None] - points[None, :]
    return correlation.rho(lag[..., 0], lag[..., 1])


@cache
def prepared(method: str, kernel: str, kind: str, scales: tuple):
    """The record, or the reason of a refusal."""
    try:
        return METHODS[method].prepare(CORRELATIONS[kernel](*scales), points_of(kind))
    except ValueError as refusal:
        return str(refusal)


def is_offered(method: str, kernel: str, kind: str, scales: tuple) -> bool:
    """What a method must do for moderate scales; it may refuse the rest."""
    on_lattice, aligned = kind != "scattered", scales[2] == 0.0
    separable = CORRELATIONS[kernel].separable
    return {
        "kronecker": on_lattice and aligned and separable,
        "ar1": on_lattice and aligned and kernel == "markov_separable",
        "circulant": on_lattice,
        "local_average_subdivision": on_lattice,
    }.get(method, True)


def linear_map(method: str, record) -> np.ndarray:
    unit, columns = np.zeros(METHODS[method].n_variables(record)), []
    for k in range(len(unit)):
        unit[k] = 1.0
        columns.append(METHODS[method].transform(record, unit))
        unit[k] = 0.0
    return np.array(columns).T


def draw(count: int, n_variables: int) -> np.ndarray:
    return np.random.default_rng(11).standard_normal((count, n_variables))


def allowed(method: str, record) -> float:
    """Covariance error that the method states, with rounding."""
    return 1.1 * covariance_error(method, record) + ROUNDING


def check_covariance(method: str, kernel: str, kind: str, scales: tuple) -> None:
    record = prepared(method, kernel, kind, scales)
    factor = linear_map(method, record)
    error = np.max(np.abs(factor @ factor.T - asked_covariance(CORRELATIONS[kernel](*scales), points_of(kind))))
    assert error <= allowed(method, record)


@pytest.mark.parametrize("scales", SCALES)
@pytest.mark.parametrize("kind", POINTS)
@pytest.mark.parametrize(("method", "kernel"), list(product(LINEAR, CORRELATIONS)))
def test_the_transform_of_unit_vectors_gives_the_asked_covariance(method, kernel, kind, scales):
    record = prepared(method, kernel, kind, scales)
    if isinstance(record, str):
        assert not is_offered(method, kernel, kind, scales)
        assert record.startswith(f"{method}: ")
        assert "take " in record
        return
    assert covariance_error(method, record) <= STATED.get(method, DEFAULT if method == "circulant" else ROUNDING)
    if METHODS[method].n_variables(record) <= MOST_VARIABLES:
        check_covariance(method, kernel, kind, scales)


@pytest.mark.parametrize("scales", ODD_SCALES)
@pytest.mark.parametrize("kind", ["part", "scattered"])
@pytest.mark.parametrize(("method", "kernel"), list(product(LINEAR, CORRELATIONS)))
def test_odd_scales_are_right_or_refused_with_a_reason(method, kernel, kind, scales):
    record = prepared(method, kernel, kind, scales)
    if isinstance(record, str):
        assert method != "cholesky"  # it takes every positive definite correlation
        assert record.startswith(f"{method}: ")
        assert "take " in record
    elif METHODS[method].n_variables(record) <= MOST_VARIABLES:
        check_covariance(method, kernel, kind, scales)


@pytest.mark.parametrize("scales", [*SCALES, *ODD_SCALES])
@pytest.mark.parametrize("kind", POINTS)
@pytest.mark.parametrize("kernel", CORRELATIONS)
def test_the_chosen_method_is_one_that_is_accurate(kernel, kind, scales):
    correlation, points = CORRELATIONS[kernel](*scales), points_of(kind)
    method = choose(correlation, points)
    record = METHODS[method].prepare(correlation, points)
    assert covariance_error(method, record) <= ROUNDING  # so few points have an exact method always


@pytest.mark.parametrize("kernel", CORRELATIONS)
def test_the_circulant_embedding_is_exact_where_it_is_asked_to_be(kernel):
    correlation, points = CORRELATIONS[kernel](1.0, 0.5), points_of("part")
    record = Circulant.prepare(correlation, points, accuracy=1e-10)
    factor = linear_map("circulant", record)
    np.testing.assert_allclose(factor @ factor.T, asked_covariance(correlation, points), rtol=0, atol=1e-10)


@every_method
def test_what_is_not_a_correlation_is_refused(method):
    class Wave:
        """Positive definite nowhere: minus a half at every lag beyond a tenth."""

        theta_h = theta_v = 1.0
        rotation = 0.0
        separable = False

        def rho(self, lag_x, lag_y):
            return np.where(np.hypot(lag_x, lag_y) < 0.1, 1.0, -0.5)

    if method == "karhunen_loeve":
        # It keeps what is positive of it, and states the error.
        record = METHODS[method].prepare(Wave(), points_of("part"))
        assert covariance_error(method, record) > 0.1
        return
    with pytest.raises(ValueError, match=f"^{method}: .*take "):
        METHODS[method].prepare(Wave(), points_of("part"))


@every_method
def test_mean_variance_and_repeatability(method):
    points = points_of("part")
    kernel = "markov_separable"
    chosen, record = METHODS[method], prepared(method, kernel, "part", SCALES[0])
    count = 1500
    xis = draw(count, chosen.n_variables(record))
    z = np.array([chosen.transform(record, xi) for xi in xis])
    assert z.shape == (count, len(points))
    # One average over the points per realisation, so that the errors are independent.
    for samples, expected in ((z.mean(axis=1), 0.0), ((z**2).mean(axis=1), 1.0)):
        bias = covariance_error(method, record) if expected else 0.0
        assert abs(samples.mean() - expected) < 4.0 * samples.std(ddof=1) / np.sqrt(count) + bias
    prepared.cache_clear()
    again = prepared(method, kernel, "part", SCALES[0])
    assert chosen.transform(again, xis[0].copy()).tobytes() == z[0].tobytes()


@pytest.mark.parametrize("method", LINEAR)
def test_the_transform_is_linear(method):
    record = prepared(method, "markov_separable", "part", SCALES[0])
    a, b = draw(2, METHODS[method].n_variables(record))
    transform = METHODS[method].transform
    apart = 2.0 * transform(record, a) - 3.0 * transform(record, b)
    np.testing.assert_allclose(transform(record, 2.0 * a - 3.0 * b), apart, rtol=0, atol=1e-12)


@every_method
def test_a_fresh_record_is_intact_and_one_for_other_points_is_not(method):
    record = prepared(method, "markov_separable", "part", SCALES[0])
    assert METHODS[method].is_intact(record, points_of("part"))
    assert not METHODS[method].is_intact(record, points_of("part")[:-1])
    broken = record._replace(**{record._fields[0]: np.zeros((3, 3, 3))})
    assert not METHODS[method].is_intact(broken, points_of("part"))


@every_method
def test_two_soils_have_independent_fields_and_the_first_is_as_if_it_were_alone(method):
    own = {f"material.{k}.random_field.cohesion.{key}": value for k in (0, 1) for key, value in settings_of(method)}
    coarse = {"discretisation.cell_m": 1.0, "discretisation.points_per_cell": 1, "material.0.softening_length_m": None}
    study = rfmpm.load_study("configs/layered_slope.toml").with_changes(coarse | own)
    both = realisation.prepare(study)
    alone = realisation.prepare(study.with_changes({"material.1.random_field": None}))
    xi, count = realisation.draw_xi(both, 3), both.scene.soils.counts[0]
    fields = properties.realise(both.properties, xi)["cohesion"]
    first = properties.realise(alone.properties, xi[: alone.n_variables])["cohesion"]
    np.testing.assert_array_equal(fields[:count], first[:count])
    assert len(set(fields[count:])) > 0.9 * len(fields[count:])
    other = np.concatenate([xi[: alone.n_variables], -xi[alone.n_variables :]])  # the second soil's part, mirrored
    moved = properties.realise(both.properties, other)["cohesion"]
    np.testing.assert_array_equal(moved[:count], first[:count])
    assert np.all(moved[count:] != fields[count:])


def settings_of(method: str):
    return ("method", method), ("correlation", "markov_separable")  # which all methods take
