"""Every quantity: where the scene lies along x has no say, nor in which order its points are listed."""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rfmpm.quantities import QUANTITIES, FinalState

# What knows the left side of the domain, x = 0: the boundary behind the crest, and where the bins start.
ABSOLUTE = {"retrogression_censored", "final_surface"}
ALONG_X = ("x", "x_initial", "toe", "crest_edge", "length")
PER_POINT = tuple(field.name for field in fields(FinalState) if field.type is np.ndarray)

few = settings(deadline=None, max_examples=40)

# Eighths, so that shifting them by whole cells rounds nothing and the tests can ask for equality.
eighths = st.integers(1, 63).map(lambda eighth: eighth / 8.0)
place = st.tuples(eighths, eighths.map(lambda x: 0.25 * x))


@st.composite
def toys(draw):
    count = draw(st.integers(1, 30))
    x_initial, y_initial = np.array(draw(st.lists(place, min_size=count, max_size=count))).T
    moved = np.array(draw(st.lists(place, min_size=count, max_size=count)))
    moved = moved * np.array(draw(st.lists(st.booleans(), min_size=count, max_size=count)))[:, None]
    strain = draw(st.lists(st.sampled_from([0.0, 0.5]), min_size=count, max_size=count))
    volume = np.array(draw(st.lists(st.sampled_from([0.125, 0.25]), min_size=count, max_size=count)))
    return FinalState(
        x_initial + moved[:, 0], 0.25 * y_initial + moved[:, 1], x_initial, y_initial, volume, volume, np.array(strain),
        cell=0.5, spacing=0.25, toe=6.0, crest_edge=4.0, crest_height=2.0, length=16.0, displacement_threshold=0.5,
        front_quantile=0.9, block_plastic_strain=0.2, block_minimum_area=0.25, surface_bin=1.0,
    )  # fmt: skip


@pytest.mark.parametrize("name", [name for name in QUANTITIES if name not in ABSOLUTE])
@few
@given(toy=toys(), cells=st.integers(0, 1000))
def test_shifting_everything_by_whole_cells_changes_nothing(name, toy, cells):
    shift = cells * toy.cell
    shifted = replace(toy, **{field: getattr(toy, field) + shift for field in ALONG_X})
    assert QUANTITIES[name](shifted) == QUANTITIES[name](toy)


@few
@given(toy=toys(), bins=st.integers(0, 100))
def test_surface_shifts_with_the_scene(toy, bins):
    shifted = replace(toy, **{field: getattr(toy, field) + bins * toy.surface_bin for field in ALONG_X})
    expected = [0.0] * bins + QUANTITIES["final_surface"](toy).tolist()
    assert QUANTITIES["final_surface"](shifted).tolist() == expected


@pytest.mark.parametrize("name", QUANTITIES)
@few
@given(toy=toys(), seed=st.integers(0, 99))
def test_order_of_the_points_has_no_say(name, toy, seed):
    order = np.random.default_rng(seed).permutation(len(toy.x))
    shuffled = replace(toy, **{field: getattr(toy, field)[order] for field in PER_POINT})
    np.testing.assert_array_equal(QUANTITIES[name](shuffled), QUANTITIES[name](toy))
