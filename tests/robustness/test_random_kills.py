"""Thirty random kills in one campaign: no finished row is lost or counted twice, little is repeated, one result."""

import os
import random
import re
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import psutil
import pytest

CAMPAIGN = Path(__file__).with_name("campaign.py")
REALISATIONS, KILLS, WORKERS = 200, 30, 3
HELD_UP = 0.2  # seconds each realisation takes longer
LONGEST = 300.0  # seconds; a guard against hanging, not a measure
LAUNCHERS = {
    "processes": ([], str(WORKERS)),
    "mpirun": ([str(Path(sys.executable).with_name("mpirun")), "-n", str(WORKERS)], ""),
}


def start(launcher: str, directory: Path, tally: Path) -> subprocess.Popen:
    front, workers = LAUNCHERS[launcher]
    command = [*front, sys.executable, str(CAMPAIGN), str(directory), str(REALISATIONS), workers, str(HELD_UP)]
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
        env={**os.environ, "TALLY": str(tally), "SEGMENT_SECONDS": "0.5"},
    )


def segments(directory: Path) -> dict[str, bytes]:
    return {
        path.name: path.read_bytes()
        for path in (directory / "segments").glob("*.rows")
        if not path.name.startswith(".")
    }


def kill(process: subprocess.Popen, victim: str, chance: random.Random) -> None:
    """SIGKILL the launcher, one of its ranks or workers, or everything."""
    if victim == "all":
        os.killpg(process.pid, signal.SIGKILL)
        return
    children = psutil.Process(process.pid).children(recursive=True)
    members = [child for child in children if is_of_campaign(child)]
    target = process.pid if victim == "launcher" or not members else chance.choice(members).pid
    os.kill(target, signal.SIGKILL)


def is_of_campaign(child: psutil.Process) -> bool:
    try:
        return "campaign.py" in " ".join(child.cmdline())
    except psutil.Error:  # it has ended
        return False


def wait_for_end_of_group(process: subprocess.Popen) -> None:
    """Survivors end by themselves; an MPI launcher that is killed leaves its ranks to end or to be ended."""
    deadline = time.monotonic() + LONGEST
    process.communicate()
    while time.monotonic() < deadline:
        try:
            os.killpg(process.pid, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
    raise AssertionError("the process group lives on")


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("launcher", LAUNCHERS)
def test_thirty_random_kills_lose_nothing(tmp_path, launcher):
    chance, tally = random.Random(f"30 kills, {launcher}"), tmp_path / "tally"
    tally.touch()
    directory, kept, kills = tmp_path / "campaign", {}, Counter()
    while kills.total() < KILLS:
        process = start(launcher, directory, tally)
        before = tally.stat().st_size
        while tally.stat().st_size == before and process.poll() is None:
            time.sleep(0.02)  # until it works
        time.sleep(chance.uniform(0.0, 1.0))
        assert process.poll() is None, "ended before the kill"
        victim = chance.choice(["launcher", "one", "all"])
        kill(process, victim, chance)
        kills[victim] += 1
        if launcher == "processes" and victim == "one":
            time.sleep(0.5)
            os.killpg(process.pid, signal.SIGKILL)  # the others go on: end them too, in the middle of their work
        wait_for_end_of_group(process)
        found = segments(directory)
        for name, content in kept.items():
            assert found.get(name) == content, f"{name} was lost or altered by the kill of {victim}"
        kept = found
    assert min(kills[victim] for victim in ("launcher", "one", "all")) > 0
    process = start(launcher, directory, tally)
    output, _ = process.communicate(timeout=LONGEST)
    assert process.returncode == 0
    undisturbed = subprocess.run(
        [sys.executable, str(CAMPAIGN), str(tmp_path / "undisturbed"), str(REALISATIONS), "1", "0"],
        capture_output=True, text=True, check=True, timeout=LONGEST,
    )  # fmt: skip
    assert output.strip() == undisturbed.stdout.strip()
    runs = Counter(re.findall(r"\d+", tally.read_text()))
    assert set(runs) <= {str(index) for index in range(REALISATIONS)}
    # A segment is written after half a second, and a realisation takes 0.2 at least: two and a half, rounded up, and
    # the one at hand, on each of three workers; the second signal of a killed worker counts as a kill of its own.
    repeated = runs.total() - REALISATIONS
    most = (KILLS + kills["one"]) * WORKERS * 4
    assert repeated <= most
    print(f"{launcher}: {dict(kills)}, {repeated} realisations repeated, at most {most} allowed")
