import numpy as np
import pytest

from rfmpm.quantities.surface import bin_centres, final_surface


@pytest.mark.parametrize(
    ("length", "width", "count"),
    [(10.0, 0.25, 40), (10.0, 1.0, 10), (10.5, 1.0, 11), (0.3, 0.1, 3), (2.1, 0.7, 3), (0.2, 1.0, 1)],
)
def test_bins_cover_the_domain_from_its_left_side(length, width, count):
    centres = bin_centres(length, width)
    assert len(centres) == count
    # rounding
    np.testing.assert_allclose(centres, width * (np.arange(count) + 0.5), rtol=1e-12)


def test_surface_is_the_top_of_the_highest_point_of_a_bin(state):
    places = [(2.3, 1.0), (2.9, 1.5), (2.1, 0.5), (4.5, 0.5)]
    surface = final_surface(state(places, places))
    expected = np.zeros(20)
    expected[[2, 4]] = 1.5 + 0.25, 0.5 + 0.25  # a point of 0.25 m2 reaches 0.25 m above its centre
    assert surface.tolist() == expected.tolist()


def test_surface_is_of_the_points_where_and_as_large_as_they_are(state):
    surface = final_surface(state([(2.5, 1.0)], [(9.5, 0.5)], volume=1.0, volume_initial=0.25))
    assert surface[9] == 1.0
    assert np.count_nonzero(surface) == 1


@pytest.mark.parametrize(("x", "column"), [(0.0, 0), (1.0, 1), (19.99, 19), (20.0, 19)])
def test_walls_and_bin_edges_belong_to_a_bin(state, x, column):
    assert np.flatnonzero(final_surface(state([(x, 0.5)], [(x, 0.5)]))).tolist() == [column]


def test_last_bin_may_reach_beyond_the_domain(state):
    surface = final_surface(state([(20.0, 0.5)], [(20.0, 0.5)], surface_bin=3.0))
    assert np.flatnonzero(surface).tolist() == [6]
    assert len(surface) == 7


def test_nothing_failed(body):
    # Whole squares of 0.5 m below a crest of 2 m, the last bins being cut by the face.
    assert final_surface(body()).tolist() == [2.0] * 4 + [1.5, 0.5] + [0.0] * 14


def test_everything_failed(body):
    assert final_surface(body(lambda x, y: (x + 3.0, y))).tolist() == [0.0] * 3 + [2.0] * 4 + [1.5, 0.5] + [0.0] * 11
