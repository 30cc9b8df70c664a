"""What status.json says, what may be doubted of it, and the estimate from what is finished without a gap."""

import os
import platform
import subprocess
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from rfmpm import campaign_status, results
from rfmpm.estimators import exceedance
from rfmpm.study import load_study
from rfmpm.variables import STATUS, active_variables, failed_row

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"


def news(**changes):
    return {"state": "running", "host": platform.node(), "pid": os.getpid(), "updated": campaign_status.now()} | changes


def dead_process() -> int:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_living_process_is_not_doubted(tmp_path):
    campaign_status.write(tmp_path, news())
    assert campaign_status.read(tmp_path)["doubt"] == ""


def test_process_that_is_gone_is_told_at_once_on_its_own_host_only(tmp_path):
    pid = dead_process()
    campaign_status.write(tmp_path, news(pid=pid))
    assert f"process {pid} is gone; no sign of life since" in campaign_status.read(tmp_path)["doubt"]
    campaign_status.write(tmp_path, news(pid=pid, host="another"))
    assert campaign_status.read(tmp_path)["doubt"] == ""


@pytest.mark.parametrize(("minutes", "is_doubted"), [(-2, True), (0, False), (90, False)])
def test_old_news_are_doubted_and_news_from_the_future_are_not(tmp_path, minutes, is_doubted):
    then = (datetime.now(UTC) + timedelta(minutes=minutes)).isoformat()
    campaign_status.write(tmp_path, news(updated=then, host="another"))
    assert bool(campaign_status.read(tmp_path)["doubt"]) == is_doubted


def test_what_has_ended_is_not_doubted(tmp_path):
    campaign_status.write(tmp_path, news(state="complete", pid=dead_process()))
    assert campaign_status.read(tmp_path)["doubt"] == ""


def test_writing_leaves_nothing_else(tmp_path):
    campaign_status.write(tmp_path, news())
    campaign_status.write(tmp_path, news())
    assert [path.name for path in tmp_path.iterdir()] == ["status.json"]


# --- the estimate


@pytest.fixture
def study():
    return load_study(COARSE)


def row(study, index, run_out, censored=0.0):
    if run_out is None:
        return failed_row(study, index, "diverged", "energy came from nothing")
    values = dict.fromkeys((variable.name for variable in active_variables(study)), 0.0)
    more = {"run_out": run_out, "run_out_censored": censored, "status": STATUS["ok"], "status_reason": ""}
    return values | more | {"realisation": index}


def segment(directory, study, name, *rows):
    (directory / "segments").mkdir(exist_ok=True)
    (directory / "study.toml").write_text(study.to_toml())
    columns = results.columns(rows, study)
    return results.write_rows(directory / "segments", name, columns, results.row_attributes(study))


def test_estimate_rests_on_the_indices_without_a_gap_and_counts_failed_ones_both_ways(tmp_path, study):
    study = study.with_changes({"quantities.run_out_limit_m": 3.0})
    segment(tmp_path, study, "b", row(study, 2, 4.0), row(study, 0, 1.0), row(study, 6, 9.0))
    segment(tmp_path, study, "a", row(study, 3, None), row(study, 1, 2.0, censored=1.0), row(study, 7, 9.0))
    segment(tmp_path, study, "c", row(study, 1, 2.0, censored=1.0), row(study, 8, 9.0))  # 1 twice
    expected = exceedance([1.0, 2.0, 4.0, float("nan")], 3.0, [0, 1, 0, 0])
    found = campaign_status.estimate_so_far(tmp_path)
    assert (found["limit_m"], found["n"]) == (3.0, 4)
    assert [found[name] for name in ("value", "lower", "upper")] == [expected.value, expected.lower, expected.upper]


def test_nothing_is_estimated_where_the_first_one_is_missing(tmp_path, study):
    assert campaign_status.estimate_so_far(tmp_path) is None
    segment(tmp_path, study, "a", row(study, 1, 4.0))
    assert campaign_status.estimate_so_far(tmp_path) is None


def test_torn_segment_is_passed_over(tmp_path, study):
    segment(tmp_path, study, "a", row(study, 0, 4.0))
    path = segment(tmp_path, study, "b", row(study, 1, 4.0))
    path.write_bytes(path.read_bytes()[:1000])
    assert campaign_status.estimate_so_far(tmp_path)["n"] == 1


def test_part_of_a_study_has_its_estimate_too(tmp_path, study):
    segment(tmp_path, study, "a", row(study, 1, 9.0), row(study, 4, 9.0), row(study, 5, 1.0), row(study, 7, 9.0))
    found = campaign_status.estimate_so_far(tmp_path, first=4)
    assert (found["n"], found["value"]) == (2, 0.5)


def test_rows_beyond_what_is_asked_for_do_not_count(tmp_path, study):
    segment(tmp_path, study, "a", *(row(study, index, 9.0) for index in range(6)))
    assert campaign_status.estimate_so_far(tmp_path, first=1, total=2)["n"] == 2


def test_where_every_one_failed_the_value_is_none_which_json_can_say(tmp_path, study):
    segment(tmp_path, study, "a", row(study, 0, None))
    found = campaign_status.estimate_so_far(tmp_path)
    assert (found["value"], found["lower"], found["upper"]) == (None, 0.0, 1.0)
