"""Following a plan along what is finished: complete plans alone count, whatever else is there."""

import numpy as np
import pytest
from test_finished import write

from rfmpm.ensemble import codes, course, segments
from rfmpm.estimators.monte_carlo import Estimate
from rfmpm.estimators.protocol import Runs

LEVEL = codes.LEVEL


class TwoPlans:
    """Four on the study's cells and six coarser ones; then as many more as the run-outs of the first four say."""

    def __init__(self):
        self.seen = []

    def plan(self, rows):
        self.seen.append(rows)
        if not len(rows.index):
            return [Runs(0, range(4)), Runs(1, range(6))]
        more = int(rows.on_level(0).value[:4].sum())
        return [Runs(0, range(more))] if len(rows.on_level(0).index) < more else []

    def estimate(self, rows):
        return Estimate(0.5, 0.25, 0.75, 0.95, len(rows.index), "test")


@pytest.fixture
def asked(study):
    until = {"quantity": "run_out", "exceeds_m": 1.0, "half_width": 0.1, "at_most": 100}
    levels = {"discretisation.cell_m": 0.5, "estimator": {"method": "multilevel", "coarser_cells_m": [1.0]}}
    return study.with_changes({"study.realisations": None, "study.until": until} | levels)


def follow(asked, folder, again=()):
    plans = course.OpenCourse(asked, TwoPlans())
    found = segments.finished(folder, asked, None)
    return plans, plans.follow(found, np.array(again, np.int64))


def test_codes_of_the_study_s_own_cells_are_the_indices():
    assert codes.codes_of(0, range(3, 5)) == range(3, 5)
    assert [codes.split(code) for code in codes.codes_of(2, range(3, 5))] == [(2, 3), (2, 4)]
    assert codes.in_words(7) == "realisation 7"
    assert codes.in_words(LEVEL + 7) == "realisation 7 on level 1"
    assert all(codes.of_entry(codes.as_entry(code)) == code for code in (7, LEVEL + 7))


def test_a_campaign_begins_with_its_first_plan(asked, tmp_path):
    plans, at = follow(asked, tmp_path)
    assert at.present == at.missing == (range(4), range(LEVEL, LEVEL + 6))
    assert (at.total, len(at.done)) == (10, 0)
    assert plans.outlook(at).estimate is None


def test_a_plan_that_lacks_something_counts_for_nothing(asked, tmp_path):
    write(asked, tmp_path, [0, 1, 3, 7], "00000-1-00000")
    write(asked, tmp_path, [5, 0], "00001-1-00000", level=1)
    plans, at = follow(asked, tmp_path)
    assert at.missing == (range(2, 3), range(LEVEL + 1, LEVEL + 5))
    assert [len(rows.index) for rows in plans.estimator.seen] == [0]


def test_the_next_plan_sees_complete_plans_alone_and_is_filled_up(asked, tmp_path):
    write(asked, tmp_path, [0, 1, 3, 2, 7, 4], "00000-1-00000", run_out=2.0)
    write(asked, tmp_path, range(9), "00001-1-00000", level=1)
    plans, at = follow(asked, tmp_path)
    (_, rows) = plans.estimator.seen
    assert rows.level.tolist() == [0] * 4 + [1] * 6
    assert rows.index.tolist() == [*range(4), *range(6)]
    assert at.present == (range(4, 8),)
    assert at.missing == (range(5, 7),)
    assert (at.total, len(at.done)) == (14, 10)
    assert (7 in at, LEVEL + 5 in at, LEVEL + 6 in at) == (True, True, False)
    assert plans.outlook(at).expected == 63  # 10 times (0.25 / 0.1) squared


def test_the_end_is_reached_where_every_plan_is_finished(asked, tmp_path):
    write(asked, tmp_path, range(9), "00000-1-00000", run_out=2.0)
    write(asked, tmp_path, range(6), "00001-1-00000", level=1)
    plans, at = follow(asked, tmp_path)
    assert at.missing == at.present == ()
    assert at.planned().tolist() == [*range(8), *range(LEVEL, LEVEL + 6)]
    assert plans.outlook(at).as_entry()["question"] == "P(run-out > 1 m) to within 0.1"
    _, again = follow(asked, tmp_path, again=[2, LEVEL + 5])  # a realisation that is to run once more is missing
    assert again.missing == (range(2, 3), range(LEVEL + 5, LEVEL + 6))


def test_work_is_steps_times_points_and_the_mean_where_steps_are_unknown(asked, tmp_path):
    write(asked, tmp_path, range(3), "00000-1-00000", run_out=2.0, step_count=30.0)
    write(asked, tmp_path, [3], "00002-1-00000", run_out=2.0)
    write(asked, tmp_path, range(6), "00001-1-00000", level=1, step_count=10.0)
    plans, at = follow(asked, tmp_path)
    fine, coarse = plans.points
    assert at.rows.work.tolist() == [30.0 * fine] * 4 + [10.0 * coarse] * 6


def test_gaps_of_a_range():
    assert list(course.gaps(range(2, 9), np.array([0, 3, 4, 8, 12]))) == [range(2, 3), range(5, 8)]
    assert list(course.gaps(range(2, 4), np.array([2, 3]))) == []
