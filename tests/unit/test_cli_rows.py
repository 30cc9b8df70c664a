"""merge and rerun, on a campaign of the coarse slope: what they print, write and end with."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from rfmpm import ensemble, realisation, results
from rfmpm.cli import app
from rfmpm.study import load_study
from rfmpm.variables import failed_row

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


@pytest.fixture(scope="module")
def incomplete(study, tmp_path_factory):
    """A folder of realisations 0 to 2 that is no complete campaign: ensemble.nc is gone."""
    folder = tmp_path_factory.mktemp("campaign") / "results"
    ensemble.run(study, folder, workers=1, progress=False, indices=(0, 3))
    (folder / "ensemble.nc").unlink()
    return folder


@pytest.fixture
def folder(incomplete, tmp_path):
    return shutil.copytree(incomplete, tmp_path / "results")


def change(folder, **columns):
    """Alter what is on record of every row."""
    (path,) = (folder / "segments").iterdir()
    stored = results.read_rows(path)
    altered = {name: np.full_like(stored.columns[name], value) for name, value in columns.items()}
    results.write_rows(path.parent, "altered", {**stored.columns, **altered}, {**stored.attributes, "host": "far"})
    path.unlink()


def test_rerun_finds_the_same_bits_and_writes_snapshots(folder):
    result = call("rerun", folder, "--index", 2, "--frames", 3)
    assert result.exit_code == 0, result.stderr
    assert "realisation 2 is the one on record, bit for bit" in result.stdout
    assert "run-out distance" in result.stdout
    assert "then and now" not in result.stdout
    written = folder / "rerun_2"
    assert (written / "simulation.png").stat().st_size > 0
    with xr.open_dataset(written / "simulation.nc") as simulation:
        assert simulation.sizes["time"] == 3


def test_rerun_says_what_differs(folder, tmp_path):
    change(folder, run_out=1.5, status_reason="another", final_surface=0.0, wall_time=1.0)
    result = call("rerun", folder, "--index", 0, "--out", tmp_path / "again")
    assert result.exit_code == 3
    first, *others = result.stderr.splitlines()
    assert first == "rfmpm: realisation 0 is not the one on record; it differs in"
    assert [line.split(":")[0].strip() for line in others] == ["final_surface", "run_out", "status_reason"]
    assert "run_out: 1.5 -> " in others[1]
    assert "then and now: host: far -> " in result.stdout
    assert (tmp_path / "again" / "simulation.nc").exists()
    assert not (folder / "rerun_0").exists()


def test_rerun_of_a_realisation_that_raises_compares_the_failed_row(study, folder, monkeypatch):
    def fail(*_, **__):
        raise ZeroDivisionError("a\nreason")

    monkeypatch.setattr(realisation, "simulate", fail)
    result = call("rerun", folder, "--index", 1)
    assert result.exit_code == 3
    assert "crashed: ZeroDivisionError: a reason" in result.stdout
    assert "status_reason" in result.stderr
    (path,) = (folder / "segments").iterdir()
    row = failed_row(study, 1, "crashed", "ZeroDivisionError: a reason")
    results.write_rows(path.parent, "crashed", results.columns([row], study), results.row_attributes(study))
    path.unlink()
    result = call("rerun", folder, "--index", 1)
    assert result.exit_code == 0
    assert "realisation 1 is the one on record" in result.stdout


def test_rerun_of_a_row_that_a_time_limit_ended_says_so_and_one_beside_it_counts(study, folder):
    (path,) = (folder / "segments").iterdir()
    row = failed_row(study, 1, "timeout", "took longer than 1 s")
    late = results.write_rows(path.parent, "0", results.columns([row], study), results.row_attributes(study))
    assert "is the one on record" in call("rerun", folder, "--index", 1).stdout  # the row that ended by itself
    path.unlink()
    result = call("rerun", folder, "--index", 1)
    assert result.exit_code == 3
    assert "is on record as timeout (took longer than 1 s), which did not come again" in result.stderr
    assert late.exists()


def test_rerun_of_a_row_that_is_not_there_is_an_error(folder):
    result = call("rerun", folder, "--index", 3)
    assert result.exit_code == 2
    assert "realisation 3 has no row here" in result.stderr


def test_merge_lists_what_is_missing(folder, tmp_path):
    result = call("merge", folder, folder, "--out", tmp_path / "out")
    assert result.exit_code == 75
    assert f"3 of 8 realisations in {tmp_path / 'out'}" in result.stdout
    assert "missing are the realisations 3 to 7" in result.stderr


def test_merge_ends_with_the_dataset(study, folder, tmp_path):
    (folder / "study.toml").write_text(study.with_changes({"study.realisations": 3}).to_toml())
    result = call("merge", folder, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    assert f"dataset: {tmp_path / 'out' / 'ensemble.nc'}" in result.stdout
    assert results.open_ensemble(tmp_path / "out").sizes["realisation"] == 3


def test_merge_judges_the_share_of_failed_rows(study, folder, tmp_path):
    rows = [failed_row(study, index, "diverged", "energy") for index in range(3, study.study.realisations)]
    origin = results.row_attributes(study)
    results.write_rows(folder / "segments", "failed", results.columns(rows, study), origin)
    result = call("merge", folder, "--out", tmp_path / "whole")
    assert result.exit_code == 3
    assert "5 of 8 realisations failed, more than the allowed 0.05 of them" in result.stderr
    assert (tmp_path / "whole" / "ensemble.nc").exists()


def test_merge_of_rows_that_contradict_each_other_is_an_error(folder, incomplete, tmp_path):
    change(folder, run_out=1.5)
    result = call("merge", folder, incomplete, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "realisation 0 has two different rows: run_out is 1.5 in" in result.stderr
