"""Layers: which points lie where, and what a layer takes from the field above it."""

import numpy as np
import pytest

import rfmpm
from rfmpm.random_fields.layers import settings_of_soils, soil_of_points
from rfmpm.study.field_models import FieldLayer


def test_a_point_lies_in_the_last_layer_whose_border_is_above_it():
    layers = [FieldLayer(top_m=4.0), FieldLayer(top_m=2.0, dip_deg=45.0)]
    points = np.array([[0.0, 4.5], [0.0, 3.0], [0.0, 1.5], [1.5, 3.0], [3.0, 4.5], [3.0, 5.1]])
    np.testing.assert_array_equal(soil_of_points(layers, points), [0, 1, 2, 2, 2, 0])


@pytest.mark.parametrize("dip", [0.0, 20.0, -35.0])
def test_a_point_on_a_border_belongs_to_the_soil_above(dip):
    x = np.linspace(0.0, 12.0, 97)
    on_border = np.column_stack([x, 3.0 + x * np.tan(np.radians(dip))])
    layers = [FieldLayer(top_m=3.0, dip_deg=dip)]
    assert not soil_of_points(layers, on_border).any()
    assert soil_of_points(layers, on_border - [0.0, 1e-6]).all()


def test_without_layers_there_is_one_soil():
    assert not soil_of_points((), np.array([[0.0, -1.0], [2.0, 3.0]])).any()


def test_a_layer_takes_what_it_leaves_out_and_follows_its_dip():
    study = rfmpm.load_study("configs/short_slope_random.toml").with_changes(
        {
            "random_field.cohesion.rotation_deg": 5.0,
            "random_field.cohesion.layer": [
                {"top_m": 3.0, "dip_deg": -10.0, "coefficient_of_variation": 0.1},
                {"top_m": 1.0, "rotation_deg": 3.0, "scale_of_fluctuation_v_m": 0.4},
            ],
        }
    )
    found = [
        (s.coefficient_of_variation, s.scale_of_fluctuation_h_m, s.scale_of_fluctuation_v_m, s.rotation_deg)
        for s in settings_of_soils(study.random_field["cohesion"])
    ]
    assert found == [(0.25, 6.0, 1.0, 5.0), (0.1, 6.0, 1.0, -10.0), (0.25, 6.0, 0.4, 3.0)]
