"""A campaign that is killed, or asked to stop, in the middle loses nothing that was written and ends the same."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from rfmpm import results
from rfmpm.variables import STATUS

CAMPAIGN = Path(__file__).with_name("campaign.py")
DEADLY = CAMPAIGN.with_name("deadly")
REALISATIONS = 60
LONGEST = 120.0  # seconds; a guard against hanging, not a measure


def start(
    directory: Path,
    hold_up: float,
    workers: int = 2,
    *more: str,
    realisations: str = str(REALISATIONS),
    **environment: str,
) -> subprocess.Popen:
    command = [sys.executable, str(CAMPAIGN), str(directory), realisations, str(workers), str(hold_up), *more]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, **pipes, start_new_session=True, env={**os.environ, **environment})


def complete(directory: Path, workers: int = 2, **environment: str) -> str:
    process = start(directory, 0.0, workers, **environment)
    output, errors = process.communicate(timeout=LONGEST)
    assert process.returncode == 0, errors
    return output.strip()


def wait_for_segment(directory: Path, process: subprocess.Popen) -> None:
    deadline = time.monotonic() + LONGEST
    while not list((directory / "segments").glob("*.rows")):
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)


def wait_for_end_of_group(group: int) -> None:
    deadline = time.monotonic() + LONGEST
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
    raise AssertionError("the process group lives on")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory) -> str:
    return complete(tmp_path_factory.mktemp("undisturbed"), workers=1)


def test_killed_campaign_is_completed_by_the_same_call(tmp_path, undisturbed):
    process = start(tmp_path, hold_up=0.02)
    wait_for_segment(tmp_path, process)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    assert not (tmp_path / "ensemble.nc").exists()
    survivors = {path.name: path.read_bytes() for path in (tmp_path / "segments").glob("*.rows")}
    assert survivors
    assert complete(tmp_path) == undisturbed
    for name, content in survivors.items():  # immutable: resuming adds to them
        assert (tmp_path / "segments" / name).read_bytes() == content
    assert not (tmp_path / "work").exists()


@pytest.mark.parametrize(
    "number",
    [
        signal.SIGTERM,
        pytest.param(signal.SIGINT, marks=pytest.mark.slow),
        pytest.param(signal.SIGUSR1, marks=pytest.mark.slow),
    ],
)
def test_signal_ends_it_cleanly_with_75_and_keeps_every_finished_row(tmp_path, undisturbed, number):
    process = start(tmp_path, hold_up=0.02)
    wait_for_segment(tmp_path, process)
    process.send_signal(number)  # to the parent alone, as a batch system may
    _, errors = process.communicate(timeout=LONGEST)
    assert process.returncode == 75, errors
    assert "run the same command again" in errors
    journal = (tmp_path / "journal.jsonl").read_text()
    assert '"complete": false' in journal
    assert complete(tmp_path) == undisturbed


def test_file_stop_ends_it_as_a_signal_does_and_the_next_start_removes_it(tmp_path, undisturbed):
    process = start(tmp_path, hold_up=0.02)
    wait_for_segment(tmp_path, process)
    (tmp_path / "STOP").touch()
    _, errors = process.communicate(timeout=LONGEST)
    assert process.returncode == 75, errors
    assert errors.splitlines()[1:] == ["  the file STOP asked for the end"]  # nothing went wrong besides
    assert list((tmp_path / "running").iterdir()) == []
    assert complete(tmp_path) == undisturbed
    assert not (tmp_path / "STOP").exists()


def test_wall_time_abandons_what_is_in_flight(tmp_path):
    process = start(tmp_path, 1000.0, 2, "8")  # each is held up for longer than any test may take
    _, errors = process.communicate(timeout=LONGEST)
    assert process.returncode == 75, errors
    assert "the limit of --wall-time was reached" in errors
    assert list((tmp_path / "running").iterdir()) == []


def test_realisation_that_kills_every_process_is_set_aside_in_one_go(tmp_path, undisturbed):
    complete(tmp_path, PYTHONPATH=os.pathsep.join([str(DEADLY), os.environ.get("PYTHONPATH", "")]), DEADLY="7")
    found = results.open_ensemble(tmp_path)
    np.testing.assert_array_equal(found["status"] == STATUS["crashed"], np.arange(REALISATIONS) == 7)
    reason = str(found["status_reason"].values[7])
    assert reason == "its process ended in each of 3 starts, the last one alone in a process: killed by SIGKILL"
    (tmp_path / "journal.jsonl").write_text("")  # it informs, and nothing depends on it
    assert complete(tmp_path) == results.content_hash(found)
    assert complete(tmp_path / "again") == undisturbed


def test_killed_job_blames_nobody(tmp_path, undisturbed):
    for _ in range(3):  # so that what was in flight may be started the third time, apart
        process = start(tmp_path, hold_up=0.2)
        wait_for_marker(tmp_path, process)
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        wait_for_end_of_group(process.pid)
    assert complete(tmp_path) == undisturbed


def wait_for_marker(directory: Path, process: subprocess.Popen) -> None:
    deadline = time.monotonic() + LONGEST
    pids = [process.pid]
    while not pids or process.pid in pids or not all(map(is_child_of(process.pid), pids)):
        pids = [json.loads(path.read_text())["pid"] for path in (directory / "running").glob("*.json")]
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)


def is_child_of(parent: int):
    return lambda pid: f"PPid:\t{parent}\n" in status_of(pid)


def status_of(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return ""


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become somebody who may not write")
def test_folder_that_may_not_be_written_is_refused_in_words_and_not_changed(tmp_path, undisturbed):
    complete(tmp_path / "results")
    before = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "results").iterdir()}
    for path in [tmp_path, *tmp_path.parents[:-2]]:
        path.chmod(0o755)
    # The libraries may lie where others may not read: a campaign elsewhere loads them all, and the study, before.
    code = (
        "import os, sys; sys.path[:0] = [sys.argv[1]]; import campaign\n"
        "study = campaign.load_study(campaign.COARSE); campaign.load_study = lambda path: study\n"
        "campaign.main(sys.argv[2] + '_before', '1', '1')\n"
        "os.setgroups([]); os.setuid(65534); sys.exit(campaign.main(*sys.argv[2:]))"
    )
    command = [sys.executable, "-c", code, str(CAMPAIGN.parent), str(tmp_path / "results"), str(REALISATIONS + 1), "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST, check=False)
    assert done.returncode == 2, done.stderr
    assert "results: cannot be written (Permission denied); choose another folder" in done.stderr
    assert {path.name: path.stat().st_mtime_ns for path in (tmp_path / "results").iterdir()} == before


def test_workers_end_by_themselves_when_their_parent_is_killed(tmp_path, undisturbed):
    process = start(tmp_path, hold_up=0.02)
    wait_for_segment(tmp_path, process)
    process.kill()
    process.communicate()
    wait_for_end_of_group(process.pid)
    assert complete(tmp_path) == undisturbed


def test_second_run_in_the_same_folder_is_refused_while_the_first_lives(tmp_path):
    first = start(tmp_path, hold_up=0.2)
    try:
        wait_for_start(tmp_path, first)
        second = start(tmp_path, hold_up=0.0)
        _, errors = second.communicate(timeout=LONGEST)
        assert second.returncode == 2
        assert "another run is using this folder" in errors
    finally:
        os.killpg(first.pid, signal.SIGKILL)
        first.communicate()


def wait_for_start(directory: Path, process: subprocess.Popen) -> None:
    deadline = time.monotonic() + LONGEST
    while not (directory / "journal.jsonl").exists():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)
