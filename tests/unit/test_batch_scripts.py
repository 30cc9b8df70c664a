"""The scripts for batch systems: Bash understands them, and a person edits them in two places only."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPTS = sorted((Path(__file__).parents[2] / "workflows").glob("*.sh"))
BLOCK = re.compile(r"^# ==== EDIT (\d): [^\n]*====\n(.*?)^# ==== end of EDIT \1 ====\n", re.MULTILINE | re.DOTALL)
RESOURCES = re.compile(r"^#(SBATCH --(job-name|ntasks|array|cpus|mem|time)|PBS -(N|l|J))", re.MULTILINE)
SETTINGS = re.compile(r"^(STUDY|DIR|REALISATIONS|export PATH)=", re.MULTILINE)


def test_there_are_four():
    assert [path.name for path in SCRIPTS] == ["pbs_array.sh", "pbs_mpi.sh", "slurm_array.sh", "slurm_mpi.sh"]


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.name)
def test_bash_understands_it(path):
    bash = shutil.which("bash")
    assert subprocess.run([bash, "-n", path], capture_output=True, check=False).stderr == b""


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.name)
def test_what_a_person_edits_is_in_two_marked_places(path):
    text = path.read_text(encoding="utf-8")
    blocks = dict(BLOCK.findall(text))
    assert list(blocks) == ["1", "2"]
    assert text.count("EDIT") == 4
    assert RESOURCES.search(blocks["1"])
    assert {"STUDY", "DIR", "export PATH"} <= set(SETTINGS.findall(blocks["2"]))
    rest = BLOCK.sub("", text)
    assert not RESOURCES.search(rest)
    assert not SETTINGS.search(rest)


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.name)
def test_it_goes_on_at_exit_code_75(path):
    text = path.read_text(encoding="utf-8")
    assert '"$code" -eq 75' in text or "\n75) " in text
    assert "--signal=B:USR1@120" in text or "--wall-time" in text
