"""Fields of finished rows, made again, against a quantity; no simulation is needed."""

from pathlib import Path

import numpy as np
import pytest

from rfmpm import seeds
from rfmpm.estimators.influence import influence
from rfmpm.field_influence import field_influence
from rfmpm.random_fields.properties import standard_normal
from rfmpm.realisation import draw_xi, prepare
from rfmpm.study import load_study

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"
ROWS = np.arange(130)  # more than one block of fields


@pytest.fixture(scope="module")
def prepared():
    return prepare(load_study(COARSE))


@pytest.fixture(scope="module")
def fields(prepared):
    return np.array([standard_normal(prepared.properties, draw_xi(prepared, i))["cohesion"] for i in ROWS])


def test_influence_is_that_of_the_fields_of_the_rows(prepared, fields):
    quantity = -fields[:, 10] + np.random.default_rng(0).standard_normal(len(ROWS))
    quantity[[3, 50]] = np.nan  # failed
    found = field_influence(prepared, ROWS, quantity)["cohesion"]
    kept = np.isfinite(quantity)
    np.testing.assert_allclose(found.correlation, influence([fields[kept]], quantity[kept]).correlation, rtol=1e-12)
    assert found.rows == 128
    assert np.argmin(found.correlation) == 10
    some = field_influence(prepared, ROWS, quantity, most=40)["cohesion"]
    first = np.flatnonzero(kept)[:40]
    np.testing.assert_allclose(some.correlation, influence([fields[first]], quantity[first]).correlation, rtol=1e-12)
    assert some.rows == 40


def test_vectors_may_come_from_a_sampler(prepared, fields):
    quantity = fields[:, 4]
    vectors = {index: draw_xi(prepared, index) for index in ROWS}
    swapped = {index: vectors[len(ROWS) - 1 - index] for index in ROWS}
    found = field_influence(prepared, ROWS, quantity[::-1], swapped.__getitem__)["cohesion"]
    assert found.correlation[4] == pytest.approx(1.0, rel=1e-12)


def test_fields_on_a_lattice_and_uncertain_numbers():
    scale = "random_field.cohesion.scale_of_fluctuation_v_m"
    asked = {
        "random_field.cohesion.reference_cell_m": 0.5,
        "uncertain": [{"key": scale, "distribution": "uniform", "low": 0.5, "high": 3.0}],
    }
    study = load_study(COARSE).with_changes(asked)
    prepared = prepare(study)
    quantity = seeds.standard_normal(1, 0, 0, 30)
    found = field_influence(prepared, np.arange(30), quantity)["cohesion"]
    assert found.correlation.shape == prepared.scene.points.mass.shape
    assert np.all(np.abs(found.correlation) < 1.0)
