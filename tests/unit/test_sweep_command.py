"""`rfmpm sweep`: what may be written after --vary, and what is in the folder afterwards; killed, it goes on."""

import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rfmpm import results
from rfmpm.cli import app
from rfmpm.cli.sweep import read_axis

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"
VARIATION = "random_field.cohesion.coefficient_of_variation"
PROGRAM = "import sys; from rfmpm.cli import main; main()"
SECONDS = 240.0  # a guard against hanging, not a measure


def call(*arguments) -> object:
    return CliRunner().invoke(app, ["sweep", str(COARSE), *map(str, arguments)])


def test_axis_is_called_by_the_last_part_of_its_key_or_as_asked():
    axis = read_axis(f"{VARIATION}=0.1,0.3")
    assert (axis.name, axis.keys, axis.values) == ("coefficient_of_variation", (VARIATION,), ((0.1,), (0.3,)))
    axis = read_axis("theta:a.v_m,a.h_m=1:6,2:12")
    assert (axis.name, axis.keys, axis.values) == ("theta", ("a.v_m", "a.h_m"), ((1, 6), (2, 12)))
    assert read_axis("law:material.0.law=von_mises").values == (("von_mises",),)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["a.b"], "write --vary KEY=V1,V2"),
        (["a.b=1,,2"], "write --vary KEY=V1,V2"),
        (["a.b,a.c=1:2,3"], "2 keys need as many values"),
        (["a.b=1,1"], "given twice"),
        (["a.b=1", "c.b=2"], "two dimensions are called b"),
        (["realisation:a.b=1"], "cannot name a dimension"),
    ],
)
def test_what_cannot_be_read_is_said(given, said):
    result = call(*(part for text in given for part in ("--vary", text)))
    assert result.exit_code == 2
    assert said in result.stderr


def test_a_wrong_cell_is_said_before_anything_runs(tmp_path):
    result = call("--vary", f"{VARIATION}=0.1,-3", "--out", tmp_path / "sweep")
    assert result.exit_code == 2
    assert "coefficient_of_variation = -3" in result.stderr
    assert not (tmp_path / "sweep").exists()


def test_picture_before_the_table_and_a_dataset(tmp_path):
    result = call("--vary", f"{VARIATION}=0.1,0.3", "--realisations", 2, "--workers", 1, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    text = (tmp_path / "sweep.md").read_text(encoding="utf-8")
    assert text.index("](sweep.png)") < text.index("| 0.1 |") < text.index("same random numbers")
    assert (tmp_path / "sweep.png").stat().st_size > 0
    dataset = results.open_ensemble(tmp_path / "sweep.nc")
    assert dataset.sizes["coefficient_of_variation"] == dataset.sizes["realisation"] == 2


def test_a_cell_in_which_too_many_failed_is_exit_code_3_and_the_rest_is_written(tmp_path):
    limits = ["--vary", "failures.realisation_time_limit_s=1e-9,1e9"]
    result = call(*limits, "--realisations", 2, "--workers", 1, "--out", tmp_path)
    assert result.exit_code == 3, result.output
    assert "cell realisation_time_limit_s=1e-09: 2 of 2 realisations failed" in result.stderr
    assert results.open_ensemble(tmp_path / "sweep.nc")["failed_count"].values.tolist() == [2, 0]


@pytest.mark.slow
def test_killed_it_goes_on_and_loses_nothing(tmp_path):
    def command(folder: Path) -> list[str]:
        options = ["--vary", f"{VARIATION}=0.1,0.2,0.3", "--realisations", "60", "--workers", "1", "--out", str(folder)]
        return [sys.executable, "-c", PROGRAM, "sweep", str(COARSE), *options]

    killed, whole = tmp_path / "killed", tmp_path / "whole"
    program = subprocess.Popen(command(killed), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + SECONDS
    while len(list(killed.glob("*"))) < 2 and time.monotonic() < end:
        time.sleep(0.01)
    program.kill()
    program.wait()
    assert not (killed / "sweep.nc").exists()
    for folder in (killed, whole):
        subprocess.run(command(folder), check=True, capture_output=True, timeout=SECONDS)
    first, second = (results.open_ensemble(folder / "sweep.nc") for folder in (killed, whole))
    assert results.content_hash(first) == results.content_hash(second)
