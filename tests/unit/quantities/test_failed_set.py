"""Which points count as failed, as top row, and as connected."""

import numpy as np
import pytest

from rfmpm.quantities.state import label_cells


@pytest.mark.parametrize(
    ("moved", "is_failed"),
    [((0.0, 0.0), False), ((0.5, 0.0), False), ((0.5625, 0.0), True), ((0.0, -0.5625), True), ((0.375, -0.375), True),
     ((-0.5625, 0.0), True)],
)  # fmt: skip
def test_failed_is_a_displacement_beyond_the_threshold_in_any_direction(state, moved, is_failed):
    assert state([(2.0, 1.0)], [(2.0 + moved[0], 1.0 + moved[1])]).failed.tolist() == [is_failed]


def test_threshold_is_the_setting(state):
    assert state([(2.0, 1.0)], [(2.75, 1.0)], displacement_threshold=1.0).failed.tolist() == [False]


def test_top_row_lies_within_a_spacing_of_the_crest_and_behind_its_edge(state):
    places = [(0.25, 1.75), (3.75, 1.75), (3.75, 1.25), (4.2, 1.6), (0.25, 1.5)]
    assert state(places, places).top_row.tolist() == [True, True, False, False, False]


def test_top_row_is_where_the_points_were_and_not_where_they_are(state):
    assert state([(2.25, 1.75), (2.25, 0.25)], [(9.0, 0.25), (2.25, 1.75)]).top_row.tolist() == [True, False]


def test_no_points_have_no_groups():
    assert len(label_cells(np.zeros(0), np.zeros(0), 1.0, diagonal=True)) == 0


def groups(places, diagonal, cell=1.0):
    """Groups as a set of sets of the points' numbers: their own numbering is free."""
    labels = label_cells(*np.array(places, dtype=float).T, cell, diagonal)
    return {frozenset(np.flatnonzero(labels == label).tolist()) for label in labels}


@pytest.mark.parametrize("diagonal", [True, False])
@pytest.mark.parametrize(
    ("places", "expected"),
    [
        ([(0.1, 0.1), (0.9, 0.9)], {(0, 1)}),  # one cell, corner to corner
        ([(0.1, 0.1), (1.9, 0.1)], {(0, 1)}),  # neighbours, 1.8 m apart
        ([(0.9, 0.1), (2.0, 0.1)], {(0,), (1,)}),  # an empty cell between them, 1.1 m apart
        ([(5.5, 7.5), (5.5, 9.5), (5.5, 8.5)], {(0, 1, 2)}),  # linked by the last one, far from the origin
        ([(0.5, 0.5), (3.5, 0.5), (0.5, 1.5), (3.5, 1.5)], {(0, 2), (1, 3)}),
    ],
)
def test_points_are_connected_where_their_cells_touch(places, expected, diagonal):
    assert groups(places, diagonal) == {frozenset(group) for group in expected}


def test_cells_that_share_a_corner_touch_only_if_asked():
    places = [(0.5, 0.5), (1.5, 1.5), (2.5, 0.5)]
    assert groups(places, diagonal=True) == {frozenset({0, 1, 2})}
    assert groups(places, diagonal=False) == {frozenset({0}), frozenset({1}), frozenset({2})}


def test_cells_have_the_size_given():
    places = [(0.1, 0.1), (0.6, 0.1)]
    assert len(groups(places, diagonal=True, cell=0.25)) == 2
    assert len(groups(places, diagonal=True, cell=0.5)) == 1


def test_groups_are_numbered_from_zero():
    labels = label_cells(np.array([7.5, 3.5, 7.5]), np.array([0.5, 0.5, 0.6]), 1.0, diagonal=True)
    assert sorted(set(labels.tolist())) == [0, 1]
