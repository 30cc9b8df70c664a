"""A campaign that follows a plan and is killed in the middle ends with the rows of one that was not."""

import json
import os
import signal

import pytest
from test_kill_and_resume import CAMPAIGN, LONGEST, start, wait_for_segment

from rfmpm import results

PLANS = json.loads(CAMPAIGN.with_name("plans.json").read_text())


@pytest.mark.parametrize("name", PLANS)
def test_killed_amid_a_round_it_is_completed_by_the_same_call(tmp_path, name):
    environment = {"PLAN": name}
    undisturbed = start(tmp_path / "undisturbed", 0.0, 1, realisations="", **environment)
    output, errors = undisturbed.communicate(timeout=LONGEST)
    assert undisturbed.returncode == 0, errors
    folder = tmp_path / "killed"
    process = start(folder, 0.02, 2, realisations="", **environment)
    wait_for_segment(folder, process)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    assert not (folder / "ensemble.nc").exists()
    resumed = start(folder, 0.0, 2, realisations="", **environment)
    found, errors = resumed.communicate(timeout=LONGEST)
    assert resumed.returncode == 0, errors
    assert found == output
    rows = results.open_ensemble(folder)
    events = [json.loads(line) for line in (folder / "journal.jsonl").read_text().splitlines()]
    computed = sum(len(event["realisations"]) for event in events if event["event"] == "segment")
    assert computed <= rows.sizes["realisation"]  # none twice; a segment may be older than its entry here
