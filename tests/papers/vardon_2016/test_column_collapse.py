"""The column of 2268 points of Vardon (2016), lecture, TU Delft: stages at 0.25, 0.375 and 0.50 s.

No numbers are published, and the size is chosen, so that what is seen in any collapse of a tall column is asked for.
"""

from functools import cache

import pytest

from rfmpm.benchmark.frictional import columns

HEIGHT, HALF_WIDTH, GRAVITY = 0.63, 0.09, 9.81


@cache
def stage(time):
    return columns.stage(time)


@pytest.mark.parametrize("time", columns.TIMES)
def test_column_has_its_points_and_is_still_moving(time):
    assert len(stage(time).points["x"]) == 2268
    assert stage(time).status == "not_at_rest"


def test_front_advances_and_top_sinks_from_stage_to_stage_no_faster_than_free_fall():
    fronts = [stage(time).points["x"].max() for time in columns.TIMES]
    tops = [stage(time).points["y"].max() for time in columns.TIMES]
    assert HALF_WIDTH < fronts[0] < fronts[1] < fronts[2]
    assert HEIGHT > tops[0] > tops[1] > tops[2]
    assert tops[0] > HEIGHT - 0.5 * GRAVITY * 0.25**2 - 0.01  # a cell
    assert tops[2] < 0.5 * HEIGHT  # it takes about twice the time of free fall (Lube et al. 2005)
