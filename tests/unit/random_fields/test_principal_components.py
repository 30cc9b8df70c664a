"""Principal components: those of the map from xi to the fields, whatever makes them, the same in every process."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm.random_fields import principal_components as components
from rfmpm.random_fields import properties
from rfmpm.random_fields.methods import METHODS
from rfmpm.random_fields.principal_components import linear_map, principal_components
from rfmpm.random_fields.site import Site

CONFIGS = Path(__file__).parents[3] / "configs"
ROUNDING = 1e-10  # identity: shares and products are of order one
DATA = [{"x_m": 1.25, "y_m": 1.25, "value": 25.0}, {"x_m": 3.75, "y_m": 0.75, "value": 15.0}]
LAYER = [{"top_m": 1.5, "scale_of_fluctuation_h_m": 2.0, "mean_kpa": 10.0}]


@pytest.fixture(scope="module")
def site():
    square = np.random.default_rng(3).choice(120, 60, replace=False)
    return Site(0.5 * (np.column_stack(np.divmod(square, 10)) + 0.5), 1.0, 0.5, 5.0, (10.0, 5.0))


def prepared(site, changes, config="short_slope_random"):
    study = rfmpm.load_study(CONFIGS / f"{config}.toml").with_changes(changes)
    return properties.prepare(study, site)


def check(fields, count=7):
    found = principal_components(fields, count)
    directions, shares = found
    assert directions.shape == (count, fields.n_variables)
    np.testing.assert_allclose(directions @ directions.T, np.eye(count), rtol=0, atol=ROUNDING)
    assert np.all(np.diff(shares) <= ROUNDING)
    # The largest eigenvalues of the covariance of all fields together, over its trace.
    matrix = linear_map(fields)
    values = np.linalg.eigvalsh(matrix.T @ matrix)
    np.testing.assert_allclose(shares, values[::-1][:count] / values.sum(), rtol=0, atol=ROUNDING)
    # Each direction carries its share, and the fields rise with the first.
    carried = np.sum((directions @ matrix) ** 2, axis=1) / np.sum(matrix**2)
    np.testing.assert_allclose(carried, shares, rtol=0, atol=ROUNDING)
    assert np.sum(directions[0] @ matrix) > 0.0


@pytest.mark.parametrize("method", METHODS)
def test_components_are_those_of_the_covariance(site, method):
    check(prepared(site, {"random_field.cohesion.method": method}))


@pytest.mark.parametrize(
    ("config", "changes"),
    [
        ("drained_cross_correlated", {}),
        ("short_slope_random", {"random_field.cohesion.layer": LAYER}),
        ("short_slope_random", {"random_field.cohesion.data": DATA, "random_field.cohesion.measurement_error": 0.1}),
        ("short_slope_random", {"random_field.cohesion.nugget": 0.3}),
    ],
    ids=["mixed", "layered", "conditioned", "nugget"],
)
def test_components_of_mixed_layered_and_conditioned_fields(site, config, changes):
    check(prepared(site, changes, config))


def test_a_few_of_many_are_found_like_all_of_them(site, monkeypatch):
    fields = prepared(site, {})
    all_at_once = principal_components(fields, 7)
    monkeypatch.setattr(components, "FEWEST_FOR_LANCZOS", 10)
    few = principal_components(fields, 7)
    np.testing.assert_allclose(few.shares, all_at_once.shares, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(few.directions, all_at_once.directions, rtol=0, atol=1e-8)  # rounding over the gaps
    assert few.directions.tobytes() == principal_components(fields, 7).directions.tobytes()


def test_more_than_there_are_gives_all(site):
    fields = prepared(site, {"random_field.cohesion.method": "cholesky"})
    assert principal_components(fields, 1000).shares.sum() == pytest.approx(1.0, abs=ROUNDING)


def test_the_store_gives_the_same_bits_and_heals(site, tmp_path, monkeypatch):
    fields = prepared(site, {})
    fresh = principal_components(fields, 5)
    made = principal_components(fields, 5, tmp_path / "new")
    with monkeypatch.context() as patch:
        patch.setattr(components, "_components", None)  # making them again would raise
        found = principal_components(fields, 5, tmp_path / "new")
    assert fresh.directions.tobytes() == made.directions.tobytes() == found.directions.tobytes()
    unlike = prepared(site, {"random_field.cohesion.scale_of_fluctuation_h_m": 3.0})
    other = principal_components(unlike, 5, tmp_path / "new")
    assert other.directions.tobytes() != fresh.directions.tobytes()
    for path in (tmp_path / "new").glob("*.directions.npy"):
        path.write_bytes(path.read_bytes()[:-80])
    assert principal_components(fields, 5, tmp_path / "new").directions.tobytes() == fresh.directions.tobytes()


def test_too_large_a_map_is_refused_with_what_to_change(site, monkeypatch):
    monkeypatch.setattr(components, "MOST_ENTRIES", 1000)
    with pytest.raises(ValueError, match=r"variables x 60 points: .* take a coarser random_field\.\*\.reference_cell"):
        principal_components(prepared(site, {}), 5)
