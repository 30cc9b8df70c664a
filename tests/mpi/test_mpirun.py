"""Under mpirun every rank works, and any number of ranks gives the same bits as local processes."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from rfmpm import campaign_status, results
from rfmpm.variables import STATUS

CAMPAIGN = Path(__file__).parents[1] / "robustness" / "campaign.py"
DEADLY, TORN = CAMPAIGN.with_name("deadly"), CAMPAIGN.with_name("torn")
MPIRUN = Path(sys.executable).with_name("mpirun")
REALISATIONS = "40"
LONGEST = 120.0  # seconds; a guard against hanging, not a measure

pytestmark = [
    pytest.mark.mpi,
    pytest.mark.skipif(not MPIRUN.exists(), reason="no mpirun beside this Python: pip install 'rfmpm[mpi]'"),
]


def call(*command: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        command, capture_output=True, text=True, timeout=LONGEST, env={**os.environ, **environment}, check=False
    )


@pytest.fixture(scope="module")
def local_hash(tmp_path_factory) -> str:
    directory = tmp_path_factory.mktemp("local")
    done = call(sys.executable, str(CAMPAIGN), str(directory), REALISATIONS, "1")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 8])
def test_same_bits_for_any_number_of_ranks(tmp_path, local_hash, ranks):
    # held up a little, so that rank 0 cannot finish the work before another one begins
    done = call(str(MPIRUN), "-n", str(ranks), sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS, "", "0.1")
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [local_hash]  # printed by rank 0 alone
    workers = {path.name.split("-")[0] for path in (tmp_path / "segments").glob("*.rows")}
    assert (len(workers) > 1) == (ranks > 1)
    assert results.content_hash(results.open_ensemble(tmp_path)) == local_hash


def test_refused_folder_ends_all_ranks(tmp_path):
    (tmp_path / "thesis.txt").write_text("not ours")
    done = call(str(MPIRUN), "-n", "2", sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS)
    assert done.returncode != 0
    assert "choose another folder" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]


def test_launcher_of_another_mpi_is_an_error_that_says_how_to_mend_it(tmp_path):
    # what a launcher does that the MPI library does not know: it says "4 ranks", the library finds one
    done = call(sys.executable, str(CAMPAIGN), str(tmp_path / "results"), REALISATIONS, OMPI_COMM_WORLD_SIZE="4")
    assert done.returncode == 2
    assert "rfmpm[mpi]" in done.stderr
    assert not (tmp_path / "results").exists()


def test_copies_that_srun_started_without_mpi_are_an_error_that_says_how_to_mend_it(tmp_path):
    slurm = {"SLURM_STEP_ID": "0", "SLURM_STEP_NUM_TASKS": "4", "SLURM_PROCID": "0"}
    done = call(sys.executable, str(CAMPAIGN), str(tmp_path / "results"), REALISATIONS, **slurm)
    assert done.returncode == 2
    assert "srun --mpi=" in done.stderr
    assert not (tmp_path / "results").exists()


def test_rank_that_dies_costs_a_start_and_the_third_is_made_apart(tmp_path, local_hash):
    command = [str(MPIRUN), "-n", "3", sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS, "", "0.02"]
    deadly = {"DEADLY": "7", "PYTHONPATH": os.pathsep.join([str(DEADLY), os.environ.get("PYTHONPATH", "")])}
    assert call(*command, **deadly).returncode not in (0, 75)
    assert call(*command, **deadly).returncode not in (0, 75)
    done = call(*command, **deadly)
    assert done.returncode == 0, done.stderr
    found = results.open_ensemble(tmp_path)
    np.testing.assert_array_equal(found["status"] == STATUS["crashed"], np.arange(int(REALISATIONS)) == 7)
    assert str(found["status_reason"].values[7]).endswith("killed by SIGKILL")
    # what ran beside it when the job died was not to blame and has the rows of an undisturbed run
    events = [json.loads(line) for line in (tmp_path / "journal.jsonl").read_text().splitlines()]
    starts = [event["realisation"] for event in events if event["event"] == "unfinished_start"]
    assert starts.count(7) == 2
    undisturbed = call(*command[:5], str(tmp_path / "undisturbed"), REALISATIONS)
    assert undisturbed.stdout.strip() == local_hash
    others = np.arange(int(REALISATIONS)) != 7
    expected = results.open_ensemble(tmp_path / "undisturbed")
    np.testing.assert_array_equal(found["run_out"].values[others], expected["run_out"].values[others])


def test_rows_of_a_damaged_segment_run_again_before_the_campaign_ends(tmp_path, local_hash):
    command = [str(MPIRUN), "-n", "3", sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS, "", "0.02"]
    done = call(*command, TORN="0", PYTHONPATH=os.pathsep.join([str(TORN), os.environ.get("PYTHONPATH", "")]))
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == local_hash
    assert len(list((tmp_path / "quarantine").iterdir())) == 1


def start(directory: Path, *more: str) -> subprocess.Popen:
    """Start three ranks that have some to do, and wait until they work."""
    command = [str(MPIRUN), "-n", "3", sys.executable, str(CAMPAIGN), str(directory), REALISATIONS, "", "0.4", *more]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + LONGEST
    while len(list((directory / "running").glob("*.json"))) < 3:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)
    return process


def ranks_of(directory: Path) -> list[int]:
    return [json.loads(path.read_text())["pid"] for path in sorted((directory / "running").glob("*.json"))]


@pytest.mark.parametrize(
    "way",
    ["launcher", "STOP", pytest.param("one rank", marks=pytest.mark.slow), pytest.param("all", marks=pytest.mark.slow)],
)
def test_clean_stop_of_ranks_is_75_and_resumable(tmp_path, local_hash, way):
    process = start(tmp_path)
    if way == "launcher":
        process.send_signal(signal.SIGUSR1)
    elif way == "one rank":
        os.kill(ranks_of(tmp_path)[1], signal.SIGTERM)
    elif way == "all":
        for pid in ranks_of(tmp_path):
            os.kill(pid, signal.SIGTERM)
    else:
        (tmp_path / "STOP").touch()
    _, errors = process.communicate(timeout=LONGEST)
    assert process.returncode == 75, errors
    assert ("STOP" if way == "STOP" else "SIG") in errors
    assert list((tmp_path / "running").iterdir()) == []
    assert campaign_status.read(tmp_path)["state"] == "stopped"
    done = call(str(MPIRUN), "-n", "2", sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [local_hash]


def test_wall_time_ends_all_ranks(tmp_path):
    # realisations are held up for longer than any test may take; however far the ranks get, they end by then
    done = call(str(MPIRUN), "-n", "3", sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS, "", "1000", "10")
    assert done.returncode == 75, done.stderr
    assert "--wall-time" in done.stderr
    assert list((tmp_path / "running").iterdir()) == []
    assert campaign_status.read(tmp_path)["state"] == "stopped"
