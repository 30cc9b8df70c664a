"""Pictures of indices and of the influence of a field: what they say to those who cannot see them."""

import base64
from io import BytesIO

import numpy as np
import pytest

from rfmpm.estimators.influence import Influence
from rfmpm.estimators.sensitivity import GivenData, SobolIndices
from rfmpm.report.sensitivity_figures import (
    FIELDS,
    given_data_chart,
    group_labels,
    influence_map,
    label_of,
    sobol_chart,
)

OUTLINE = np.array([(0.0, 0.0), (8.0, 0.0), (4.0, 4.0), (0.0, 4.0)])


def pixels(picture):
    from PIL import Image

    data = base64.b64decode(picture.source.removeprefix("data:image/png;base64,"))
    return np.asarray(Image.open(BytesIO(data)).convert("RGB"))


@pytest.mark.parametrize(
    ("key", "label"),
    [
        ("material.0.cohesion_kpa", "cohesion"),
        ("material.0.unit_weight_kn_m3", "unit weight"),
        ("boundary.base.coefficient", "friction of the base"),
        ("random_field.friction_angle.coefficient_of_variation", "friction angle: coefficient of variation"),
        ("random_field.cohesion.scale_of_fluctuation_v_m", "cohesion: scale of fluctuation, vertical"),
        ("random_field.cohesion.layer.1.mean_kpa", "cohesion, layer 2: mean"),
        ("random_field.cohesion.trend_kpa_per_m", "cohesion: trend"),
        ("material.1.random_field.cohesion.trend_kpa_per_m", "cohesion of material 2: trend"),
        ("material.1.random_field.cohesion.layer.0.mean_kpa", "cohesion of material 2, layer 1: mean"),
    ],
)
def test_keys_read_as_words(key, label):
    assert label_of(key) == label


def test_chart_of_indices():
    labels = group_labels(["material.0.cohesion_kpa"], has_fields=True)
    assert labels == ["cohesion", FIELDS]
    first, total = np.array([0.2, 0.5]), np.array([0.25, 0.8])
    spread = np.array([[-0.1, 0.1], [-0.05, 0.05]])
    indices = SobolIndices(first, total, first[:, None] + spread, total[:, None] + spread, 300, 2)
    picture = sobol_chart(labels, indices, "run-out")
    assert "the largest total one is that of random fields" in picture.alt
    assert "300 base points" in picture.caption
    assert "2 base points with a failed simulation left out" in picture.caption
    assert len(np.unique(pixels(picture).reshape(-1, 3), axis=0)) > 10


def test_chart_of_indices_that_are_unknown():
    nothing, ends = np.full(2, np.nan), np.full((2, 2), np.nan)
    picture = sobol_chart(["a", "b"], SobolIndices(nothing, nothing, ends, ends, 0, 0), "run-out")
    assert "that of nothing" in picture.alt


def test_chart_of_given_data_names_what_is_above_chance():
    first, noise = np.array([0.3, 0.01]), np.array([0.03, 0.03])
    ends = first[:, None] + np.array([-0.02, 0.02])
    found = GivenData(first, ends, noise, 200, 0)
    picture = given_data_chart(["cohesion", "friction of the base"], found, "run-out")
    assert picture.alt.endswith("above what chance shows: cohesion.")


def test_map_greys_what_chance_may_show():
    x, y = np.meshgrid(np.arange(0.25, 4.0, 0.5), np.arange(0.25, 4.0, 0.5))
    points = np.column_stack([x.ravel(), y.ravel()])
    correlation = np.where(points[:, 1] < 1.0, -0.6, 0.05)
    picture = influence_map(points, Influence(correlation, 0.1, 0.2, 400), OUTLINE)
    assert "it is strongest, -0.60" in picture.alt
    assert "25% of the places" in picture.alt
    assert "below 0.20" in picture.caption
    grey = np.all(np.abs(pixels(picture).astype(int) - 0xD4) <= 3, axis=2)
    coloured = np.ptp(pixels(picture).astype(int), axis=2) > 60
    assert grey.mean() > 2.0 * coloured.mean() > 0.02
    none = influence_map(points, Influence(0.0 * correlation, 0.1, 0.2, 400), OUTLINE)
    assert "all grey" in none.alt
