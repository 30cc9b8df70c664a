"""What a campaign will cost: the parts that can be known beforehand, and one estimate of a small study."""

from pathlib import Path

import numpy as np
import pytest

from rfmpm import cost
from rfmpm.benchmark.scheduling.replay import replay
from rfmpm.cost import trial
from rfmpm.cost.campaign import LEAST_ERROR, makespan, relative_error
from rfmpm.cost.results import Files, Size, disk, segment_count
from rfmpm.ensemble import segments
from rfmpm.study import load_study

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


@pytest.mark.parametrize(
    ("mean", "longest", "count", "workers", "expected"),
    [
        (2.0, 3.0, 4, 8, 3.0),  # fewer realisations than workers: the longest
        (2.0, 3.0, 10, 1, 20.0),  # one worker: their sum
        (1.0, 100.0, 10, 5, 100.0),  # never less than the longest
        (2.0, 2.0, 400, 4, 200.75),  # an even share, and half a realisation of three workers in four
    ],
)
def test_makespan(mean, longest, count, workers, expected):
    assert makespan(mean, longest, count, workers) == pytest.approx(expected, rel=1e-12)  # identity


def test_makespan_is_that_of_schedules():
    # Half a realisation at the end is the mean over schedules, of which each has between nothing and a whole one.
    rng = np.random.default_rng(3)
    for workers in (4, 16):
        seconds = rng.uniform(0.5, 2.0, 40 * workers)
        expected = makespan(seconds.mean(), seconds.max(), len(seconds), workers)
        assert abs(replay(seconds, workers).makespan - expected) < 0.5 * seconds.max()


def test_error_falls_with_trials_and_never_below_what_speed_varies():
    few, many = np.array([1.0, 2.0]), np.tile([1.0, 2.0], 200)
    assert LEAST_ERROR < relative_error(many, 10_000) < relative_error(few, 10_000) < 1.0
    assert relative_error(np.ones(9), 100) == LEAST_ERROR
    assert relative_error(np.ones(1), 100) == 0.5


def test_segments_hold_as_many_rows_or_seconds_as_a_worker_collects():
    assert segment_count(1e-6, 10 * segments.ROWS, 1) == 10
    assert segment_count(1.01 * segments.SECONDS, 30, 4) == 30
    assert segment_count(0.4 * segments.SECONDS, 30, 1) == 10  # the third ends after the time
    assert segment_count(1e-6, 4, 4) == 4  # each worker writes its own


def test_disk_adds_segments_dataset_and_report():
    files = Files(Size(1000.0, 10.0), Size(5000.0, 20.0), 300.0, 0.0)
    assert disk(files, 100, 7) == 7 * 1000 + 100 * 10 + 5000 + 100 * 20 + 300


def test_trial_takes_the_finest_cells_that_time_allows(study, tmp_path):
    own = trial.lengths(study, tmp_path, at_most=0.01)
    assert own.cell == 1.0
    assert len(own.rows) == study.study.realisations
    assert np.array_equal(own.steps, [row["step_count"] for row in own.rows])
    assert trial.lengths(study, tmp_path, at_most=1e9) is None


def test_trial_on_coarser_cells_expects_more_steps_on_the_study_s_own(study, tmp_path):
    fine = study.with_changes({"discretisation.cell_m": 0.5})
    # cells of 1 m are the coarsest of which this slope has four; at 16 s only they are affordable
    found = trial.lengths(fine, tmp_path, at_most=16.0)
    assert found.cell == 1.0
    assert np.array_equal(found.steps, [2 * row["step_count"] for row in found.rows])


@pytest.mark.slow
def test_estimate_of_a_small_study(study):
    found = cost.estimate(study, ranks=3)
    assert found["points"] == 100
    assert found["workers"] == 3
    assert found["trial_realisations"] == study.study.realisations
    assert found["realisation_shortest_s"] <= found["realisation_s"] <= found["realisation_longest_s"]
    assert 0 < found["steps"] <= 1.5 * found["steps_at_most"]  # a fast slope takes shorter steps
    assert found["campaign_low_s"] < found["campaign_s"] < found["campaign_high_s"]
    assert found["memory_bytes"] == 3 * found["memory_per_worker_bytes"]
    assert 0 < found["disk_bytes"] <= found["disk_at_most_bytes"]


def test_estimate_refuses_no_ranks(study):
    with pytest.raises(ValueError, match="at least 1"):
        cost.estimate(study, ranks=0)
