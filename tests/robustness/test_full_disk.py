"""A campaign that can no longer write says so, damages nothing, and is completed by the same call."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

resource = pytest.importorskip("resource")  # no limits on the size of files on this system

CAMPAIGN = Path(__file__).with_name("campaign.py")
REALISATIONS = 40
LONGEST = 300.0  # seconds; a guard against hanging, not a measure


def run(directory, largest_file=None):
    """Run the campaign; files larger than so many bytes cannot be written, which stands in for a full disk."""

    def limit():
        if largest_file is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))

    command = [sys.executable, str(CAMPAIGN), str(directory), str(REALISATIONS), "1"]
    return subprocess.run(command, capture_output=True, text=True, timeout=LONGEST, preexec_fn=limit, check=False)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    return run(tmp_path_factory.mktemp("undisturbed")).stdout


@pytest.mark.parametrize(
    ("largest_file", "message"),
    [
        pytest.param(2_900, "worker 0 could not go on: OSError: [Errno 27] File too large", id="a segment"),
        pytest.param(30_000, "ensemble.nc: cannot be written, is the disk full?", id="the dataset"),
    ],
)
def test_what_cannot_be_written_stops_the_campaign_and_leaves_no_trace(tmp_path, undisturbed, largest_file, message):
    stopped = run(tmp_path, largest_file)
    assert stopped.returncode == 75, stopped.stderr
    assert message in stopped.stderr
    assert "run the same command again" in stopped.stderr
    left = {path.name for path in tmp_path.iterdir()} - {"work", "segments", "running"}
    assert left == {".lock", "journal.jsonl", "rfmpm.log", "status.json", "study.toml"}
    kept = {path: path.read_bytes() for path in (tmp_path / "segments").iterdir()}
    assert not any(path.name.startswith(".") for path in kept)
    completed = run(tmp_path)
    assert completed.stdout == undisturbed
    assert all(path.read_bytes() == content for path, content in kept.items())


def test_a_dataset_that_is_there_outlives_one_that_cannot_be_written(tmp_path, undisturbed):
    run(tmp_path)
    before = (tmp_path / "ensemble.nc").read_bytes()
    assert run(tmp_path, 30_000).returncode == 75
    assert (tmp_path / "ensemble.nc").read_bytes() == before
    assert run(tmp_path).stdout == undisturbed


@pytest.mark.skipif(getattr(os, "geteuid", lambda: 0)() == 0, reason="the superuser may write everywhere")
def test_a_folder_that_may_not_be_written_is_refused_and_left_alone(tmp_path):
    run(tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    tmp_path.chmod(0o555)
    (tmp_path / "segments").chmod(0o555)
    (tmp_path / ".lock").chmod(0o444)
    try:
        refused = run(tmp_path)
    finally:
        for path in (tmp_path, tmp_path / "segments", tmp_path / ".lock"):
            path.chmod(0o755)
    assert refused.returncode == 2
    assert f"{tmp_path}: cannot be written" in refused.stderr
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before
