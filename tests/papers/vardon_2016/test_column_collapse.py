"""The column of 2268 points of Vardon (2016), lecture, TU Delft: stages at 0.25, 0.375 and 0.50 s.

No numbers are published, and the size is chosen, so that what is seen in any collapse of a tall column is asked for.
"""

from functools import cache

import numpy as np
import pytest

from rfmpm.benchmark.papers.column_collapse import HALF_WIDTH, HEIGHT, TIMES, Course, stage

GRAVITY = 9.81


@cache
def at(time):
    return stage(time)


@pytest.mark.parametrize("time", TIMES)
def test_column_has_its_points_and_is_still_moving(time):
    assert len(at(time).points["x"]) == 2268
    assert at(time).status == "not_at_rest"


def test_front_advances_and_top_sinks_from_stage_to_stage_no_faster_than_free_fall():
    fronts = [at(time).points["x"].max() for time in TIMES]
    tops = [at(time).points["y"].max() for time in TIMES]
    assert HALF_WIDTH < fronts[0] < fronts[1] < fronts[2]
    assert HEIGHT > tops[0] > tops[1] > tops[2]
    assert tops[0] > HEIGHT - 0.5 * GRAVITY * 0.25**2 - 0.01  # a cell
    assert tops[2] < 0.5 * HEIGHT  # it takes about twice the time of free fall (Lube et al. 2005)


def test_course_says_when_the_front_comes_to_a_place():
    course = Course(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 3.0]), np.array([3.0, 2.0, 2.0]))
    assert course.at(1.5) == (2.0, 2.0)
    assert course.reaches(2.0) == 1.5
    assert course.reaches(3.1) == np.inf
