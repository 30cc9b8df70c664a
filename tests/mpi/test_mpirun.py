"""Under mpirun every rank works, and any number of ranks gives the same bits as local processes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from rfmpm import results

CAMPAIGN = Path(__file__).parents[1] / "robustness" / "campaign.py"
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


@pytest.mark.parametrize("ranks", [1, 2, 4])
def test_same_bits_for_any_number_of_ranks(tmp_path, local_hash, ranks):
    # held up a little, so that no rank can finish the work before the others begin
    done = call(str(MPIRUN), "-n", str(ranks), sys.executable, str(CAMPAIGN), str(tmp_path), REALISATIONS, "", "0.02")
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [local_hash]  # printed by rank 0 alone
    workers = {path.name.split("-")[0] for path in (tmp_path / "segments").glob("*.rows")}
    assert len(workers) == ranks
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
