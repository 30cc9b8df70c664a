import pytest

from rfmpm.quantities.retrogression import retrogression_censored, retrogression_distance

TOP = [(x, 1.75) for x in (0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.25, 3.75)]


def slid(before, is_moved):
    return [(x + 3.0, y - 1.0) if is_moved(x) else (x, y) for x, y in before]


@pytest.mark.parametrize("last", [0.75, 1.75, 3.75])
def test_reaches_back_to_the_last_failed_point_of_the_top_row(state, last):
    toy = state(TOP, slid(TOP, lambda x: x >= last))
    assert retrogression_distance(toy) == 4.0 - last
    assert retrogression_censored(toy) == 0


def test_a_gap_does_not_end_it(state):
    assert retrogression_distance(state(TOP, slid(TOP, lambda x: x in (1.25, 3.75)))) == 4.0 - 1.25


def test_deeper_rows_and_the_face_do_not_count(state):
    before = [(0.25, 1.25), (4.2, 1.6)]
    toy = state(before, slid(before, lambda x: True))
    assert toy.failed.all()
    assert (retrogression_distance(toy), retrogression_censored(toy)) == (0.0, 0)


def test_is_censored_where_the_point_at_the_boundary_fails(state):
    toy = state(TOP, slid(TOP, lambda x: True))
    assert (retrogression_distance(toy), retrogression_censored(toy)) == (3.75, 1)


def test_where_the_points_are_now_has_no_say(state):
    toy = state([(3.25, 1.75)], [(0.25, 0.25)])
    assert (retrogression_distance(toy), retrogression_censored(toy)) == (0.75, 0)


def test_nothing_failed(body):
    assert (retrogression_distance(body()), retrogression_censored(body())) == (0.0, 0)


def test_everything_failed(body):
    toy = body(lambda x, y: (x + 3.0, y))
    assert (retrogression_distance(toy), retrogression_censored(toy)) == (3.75, 1)
