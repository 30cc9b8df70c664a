"""The long slope of Vardon, Wang and Hicks (2017) and of Wang et al. (2016), on cells of 0.5 m.

The papers say in words what is seen; the words are compared, no number is. What ten cells over the layer do not
resolve, the shape of single blocks, is left to the pages in reports/papers.
"""

from functools import cache
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from rfmpm.benchmark.papers import long_slope_angles as angles
from rfmpm.benchmark.papers import long_slope_excavated as excavated
from rfmpm.benchmark.papers.case import study
from rfmpm.benchmark.papers.long_slopes import COARSE, STUDY, fifths_fail_at, geometry, goes_up, slide

CELL = {"discretisation.cell_m": COARSE}


@cache
def run(angle):
    return slide(geometry(angle, angles.DEPTH) | CELL)


def test_the_study_is_that_of_20_degrees():
    own, made = study(STUDY), study(STUDY, geometry(20.0, angles.DEPTH))
    for region in (0, 1):
        found, asked = (np.array(one.geometry.region[region].corners_m) for one in (own, made))
        np.testing.assert_allclose(found, asked, atol=1e-4)  # the file has four decimals
    assert own.geometry.toe_m == pytest.approx(made.geometry.toe_m, abs=1e-4)


@pytest.mark.parametrize(
    ("times", "expected"),
    [
        ([1.0, 2.0, 3.0, inf, inf], True),
        ([1.0, 2.0, 2.0, 3.0, inf], True),  # one slide takes two fifths
        ([1.0, 2.0, inf, inf, inf], False),
        ([1.0, 3.0, 2.0, 4.0, 5.0], False),
        ([1.0, 2.0, inf, 4.0, 5.0], False),
    ],
)
def test_going_up_is_in_order_and_in_three_slides(times, expected):
    assert goes_up(times) is expected


def test_5_degrees_spreads_from_the_toe_up_the_slope():
    times = fifths_fail_at(run(5.0), 5.0)
    assert goes_up(times)
    assert times[-1] - times[0] > 3.0
    assert run(5.0).kind_at(inf) == "spread"


@pytest.mark.parametrize("angle", [10.0, 15.0, 20.0])
def test_steeper_slopes_slide_as_a_whole(angle):
    far = run(angle).passes("slope", angles.FAR)
    assert run(angle).kind_at(far) == "translational"
    assert run(angle).failed_share_at(far) > 0.7


def test_the_steeper_the_sooner_the_slope_follows_its_toe():
    late = [run(angle).passes("slope") - run(angle).passes("toe") for angle in angles.ANGLES]
    assert all(gentle > steep for gentle, steep in pairwise(late))
    assert late[2] > angles.SAME_TIME >= abs(late[3])


def test_an_excavation_sets_off_a_slope_that_stands():
    whole, cut = excavated.changes()
    assert slide(whole | CELL | {"time.end_s": 2.0}).kind_at(inf) == "no_failure"
    found = slide(cut | CELL | {"time.end_s": 5.0})
    times = fifths_fail_at(found, excavated.ANGLE)
    assert goes_up(times)
    assert times[-1] == inf  # on its way
