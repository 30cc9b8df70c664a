"""A campaign on this machine: the same bits for any number of workers, failures as rows, deaths survived."""

import json
import os
import signal

import numpy as np
import pytest

from rfmpm import ensemble, realisation, results
from rfmpm.variables import STATUS, active_variables

REALISATIONS = 12


def run(study, directory, realisations=REALISATIONS, workers=1, **options):
    return ensemble.run(study, directory, realisations, workers, progress=False, **options)


def events(directory, name):
    lines = (directory / "journal.jsonl").read_text().splitlines()
    return [event for event in map(json.loads, lines) if event["event"] == name]


@pytest.fixture(scope="module")
def reference(study, tmp_path_factory):
    return run(study, tmp_path_factory.mktemp("reference"))


@pytest.mark.parametrize("workers", [2, 4])
def test_same_bits_for_any_number_of_workers(study, reference, tmp_path, workers):
    found = run(study, tmp_path, workers=workers)
    assert results.content_hash(found) == results.content_hash(reference)
    for name in found.variables:
        if name != "wall_time":
            np.testing.assert_array_equal(found[name].values, reference[name].values)
    assert np.unique(found["run_out"]).size > 1  # or equality would mean nothing


def test_every_row_is_there_in_order_with_every_variable(study, reference):
    np.testing.assert_array_equal(reference["realisation"], np.arange(REALISATIONS))
    assert {variable.name for variable in active_variables(study)} <= set(reference.variables)
    assert np.all(reference["wall_time"] > 0.0)


def test_what_the_folder_holds_afterwards(study, tmp_path):
    found = run(study, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {
        ".lock", "ensemble.nc", "journal.jsonl", "rfmpm.log", "segments", "study.toml",
    }  # fmt: skip
    assert f"realisations = {REALISATIONS}" in (tmp_path / "study.toml").read_text()
    assert found.identical(results.open_ensemble(tmp_path))
    (stop,) = events(tmp_path, "stop")
    assert stop["complete"]
    assert stop["content_hash"] == results.content_hash(found)


def test_more_realisations_run_only_the_missing_ones(study, reference, tmp_path, monkeypatch):
    run(study, tmp_path, 5)
    assert results.content_hash(run(study, tmp_path)) == results.content_hash(reference)
    assert [event["todo"] for event in events(tmp_path, "start")] == [5, REALISATIONS - 5]


def test_fewer_realisations_give_the_first_ones_and_run_nothing(study, reference, tmp_path, monkeypatch):
    run(study, tmp_path)
    monkeypatch.delattr(realisation, "run")
    found = run(study, tmp_path, 3)
    np.testing.assert_array_equal(found["run_out"], reference["run_out"][:3])


def test_fresh_runs_everything_again(study, reference, tmp_path):
    run(study, tmp_path, 5)
    run(study, tmp_path, 5, fresh=True)
    assert [event["todo"] for event in events(tmp_path, "start")] == [5, 5]


def test_exception_becomes_a_crashed_row(study, reference, tmp_path, monkeypatch):
    real_run = realisation.run

    def sometimes(prepared, index):
        if index == 2:
            raise ZeroDivisionError("a\nreason")
        return real_run(prepared, index)

    monkeypatch.setattr(realisation, "run", sometimes)
    found = run(study, tmp_path, 4, workers=2)
    np.testing.assert_array_equal(found["status"].values == STATUS["crashed"], [False, False, True, False])
    assert str(found["status_reason"].values[2]) == "ZeroDivisionError: a reason"
    assert np.isnan(found["run_out"].values[2])
    assert np.all(np.isnan(found["final_surface"].values[2]))
    np.testing.assert_array_equal(found["run_out"].values[[0, 1, 3]], reference["run_out"].values[[0, 1, 3]])


def test_realisation_that_kills_its_workers_is_given_up_after_three_starts(study, reference, tmp_path, monkeypatch):
    real_run = realisation.run

    def deadly(prepared, index):
        if index == 1:
            os.kill(os.getpid(), signal.SIGKILL)
        return real_run(prepared, index)

    monkeypatch.setattr(realisation, "run", deadly)
    for _ in range(3):
        with pytest.raises(ensemble.Interrupted, match=r"realisation 1: killed by SIGKILL") as early:
            run(study, tmp_path, 4, workers=2)
        assert "run the same command again" in str(early.value)
    found = run(study, tmp_path, 4, workers=2)
    np.testing.assert_array_equal(found["status"].values == STATUS["lost"], [False, True, False, False])
    np.testing.assert_array_equal(found["run_out"].values[[0, 2, 3]], reference["run_out"].values[[0, 2, 3]])


def test_worker_that_cannot_write_stops_the_campaign_with_its_reason(study, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(results, "write_rows", full)
    with pytest.raises(ensemble.Interrupted, match="No space left on device"):
        run(study, tmp_path, 4)


def write_changed_copy(directory, name, change):
    """A second segment like the one of two rows, one value of realisation 1 changed."""
    (path,) = (directory / "segments").glob("*.rows")
    stored = results.read_rows(path)
    changed = {**stored.columns, name: stored.columns[name] + [0.0, change]}
    results.write_rows(path.parent, "zzz", changed, stored.attributes)


def test_rows_that_differ_are_an_error(study, tmp_path):
    run(study, tmp_path, 2)
    write_changed_copy(tmp_path, "run_out", 1e-12)
    with pytest.raises(ensemble.RowsDiffer, match="realisation 1 has two different rows: run_out is"):
        run(study, tmp_path, 2)


def test_equal_rows_that_differ_in_wall_time_are_one_row(study, tmp_path):
    first = run(study, tmp_path, 2)
    write_changed_copy(tmp_path, "wall_time", 1.0)
    again = run(study, tmp_path, 2)
    assert results.content_hash(again) == results.content_hash(first)
    np.testing.assert_array_equal(again["wall_time"], first["wall_time"])  # the first one is kept


@pytest.mark.parametrize("workers", [0, -1])
def test_less_than_one_worker_is_an_error(study, tmp_path, workers):
    with pytest.raises(ValueError, match=f"workers = {workers}"):
        run(study, tmp_path / "results", workers=workers)
    assert not (tmp_path / "results").exists()


def test_workers_under_several_ranks_are_an_error(study, tmp_path, monkeypatch):
    monkeypatch.setenv("PMI_SIZE", "4")
    with pytest.raises(ValueError, match="4 ranks are the workers"):
        run(study, tmp_path / "results", workers=2)


def test_signal_handlers_are_given_back(study, tmp_path):
    before = signal.getsignal(signal.SIGTERM)
    run(study, tmp_path, 1)
    assert signal.getsignal(signal.SIGTERM) is before
