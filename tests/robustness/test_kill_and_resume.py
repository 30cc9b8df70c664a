"""A campaign that is killed, or asked to stop, in the middle loses nothing that was written and ends the same."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

CAMPAIGN = Path(__file__).with_name("campaign.py")
REALISATIONS = 60
LONGEST = 120.0  # seconds; a guard against hanging, not a measure


def start(directory: Path, hold_up: float, workers: int = 2) -> subprocess.Popen:
    command = [sys.executable, str(CAMPAIGN), str(directory), str(REALISATIONS), str(workers), str(hold_up)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)


def complete(directory: Path, workers: int = 2) -> str:
    process = start(directory, 0.0, workers)
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
