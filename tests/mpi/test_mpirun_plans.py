"""Campaigns that follow a plan in rounds: ranks find the rows that one local process finds."""

import json
import sys

import pytest
from test_mpirun import CAMPAIGN, MPIRUN, call, pytestmark  # noqa: F401  (skipped where there is no mpirun)

PLANS = json.loads(CAMPAIGN.with_name("plans.json").read_text())


@pytest.mark.parametrize("name", PLANS)
def test_three_ranks_find_what_one_process_finds(tmp_path, name):
    environment = {"PLAN": name}
    local = call(sys.executable, str(CAMPAIGN), str(tmp_path / "local"), "", "1", **environment)
    assert local.returncode == 0, local.stderr
    ranks = [str(MPIRUN), "-n", "3", sys.executable, str(CAMPAIGN), str(tmp_path / "ranks"), "", "", "0.02"]
    done = call(*ranks, **environment)
    assert done.returncode == 0, done.stderr
    assert done.stdout == local.stdout
    workers = {path.name.split("-")[0] for path in (tmp_path / "ranks" / "segments").glob("*.rows")}
    assert len(workers) > 1
