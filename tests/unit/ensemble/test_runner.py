"""A campaign on this machine: the same bits for any number of workers, failures as rows, deaths survived."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rfmpm import ensemble, realisation, results
from rfmpm.ensemble.markers import Task
from rfmpm.ensemble.worker import Worker
from rfmpm.variables import STATUS, active_variables, failed_row

REALISATIONS = 12
COARSE = Path(__file__).parents[2] / "robustness" / "coarse.toml"


def run(study, directory, realisations=REALISATIONS, workers=1, **options):
    return ensemble.run(study, directory, realisations, workers, progress=False, **options)


def events(directory, name):
    lines = (directory / "journal.jsonl").read_text().splitlines()
    return [event for event in map(json.loads, lines) if event["event"] == name]


@pytest.fixture(scope="module")
def reference(study, tmp_path_factory):
    return run(study, tmp_path_factory.mktemp("reference"))


@pytest.mark.parametrize("workers", [2, 3, 4, 8])
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
        ".lock", "ensemble.nc", "journal.jsonl", "rfmpm.log", "segments", "status.json", "study.toml",
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

    def sometimes(prepared, index, **options):
        if index == 2:
            raise ZeroDivisionError("a\nreason")
        return real_run(prepared, index, **options)

    monkeypatch.setattr(realisation, "run", sometimes)
    found = run(study, tmp_path, 4, workers=2, allow_failed=0.25)
    np.testing.assert_array_equal(found["status"].values == STATUS["crashed"], [False, False, True, False])
    assert str(found["status_reason"].values[2]) == "ZeroDivisionError: a reason"
    assert np.isnan(found["run_out"].values[2])
    assert np.all(np.isnan(found["final_surface"].values[2]))
    np.testing.assert_array_equal(found["run_out"].values[[0, 1, 3]], reference["run_out"].values[[0, 1, 3]])


def kill_in(monkeypatch, index, times):
    """Let the workers that run a realisation be killed, `times` times; a file counts, since they are processes."""
    real_run = realisation.run

    def deadly(prepared, i, **options):
        if i == index and len(list(times[0].glob("death-*"))) < times[1]:
            (times[0] / f"death-{os.getpid()}").touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return real_run(prepared, i, **options)

    monkeypatch.setattr(realisation, "run", deadly)


def test_worker_that_dies_is_replaced_and_the_campaign_ends_complete(study, reference, tmp_path, monkeypatch):
    (tmp_path / "deaths").mkdir()
    kill_in(monkeypatch, 1, (tmp_path / "deaths", 1))
    found = run(study, tmp_path / "results", workers=1)
    assert results.content_hash(found) == results.content_hash(reference)
    (start,) = events(tmp_path / "results", "unfinished_start")
    assert start["realisation"] == 1
    assert [event["realisation"] for event in events(tmp_path / "results", "worker_lost")] == [1]
    assert len(list((tmp_path / "deaths").iterdir())) == 1


def test_third_start_is_made_in_a_process_of_its_own(study, reference, tmp_path, monkeypatch):
    (tmp_path / "deaths").mkdir()
    kill_in(monkeypatch, 1, (tmp_path / "deaths", 9))  # the child, a new program, is not told to die
    found = run(study, tmp_path / "results", workers=2)
    assert results.content_hash(found) == results.content_hash(reference)
    assert len(list((tmp_path / "deaths").iterdir())) == 2
    (log,) = (tmp_path / "results" / "logs").iterdir()
    assert "realisation 1: start 3, in a process of its own" in log.read_text()


def test_workers_that_cannot_even_begin_end_the_campaign(study, tmp_path, monkeypatch):
    monkeypatch.setattr(Worker, "work", lambda *_: os._exit(3))
    with pytest.raises(ensemble.Interrupted, match="worker 0 died: exit code 3") as early:
        run(study, tmp_path, 2, workers=1)
    assert "workers die and nothing gets done" in str(early.value)


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


# --- the failure policy of the study


def policy(study, **keys):
    return study.with_changes({f"failures.{key}": value for key, value in keys.items()})


def fail_first(monkeypatch, indices, times):
    """Let realisations raise the first `times` times in a process."""
    real_run, tries = realisation.run, dict.fromkeys(indices, 0)

    def failing(prepared, index, **options):
        if index in tries:
            tries[index] += 1
            if tries[index] <= times:
                raise MemoryError("no memory left")
        return real_run(prepared, index, **options)

    monkeypatch.setattr(realisation, "run", failing)


def test_retry_repeats_what_crashed_and_gets_the_same_row(study, reference, tmp_path, monkeypatch):
    fail_first(monkeypatch, [1, 3], 2)
    found = run(policy(study, action="retry", retries=2), tmp_path)
    assert results.content_hash(found) == results.content_hash(reference)
    assert "realisation 3, try 2 of 3: MemoryError: no memory left" in (tmp_path / "logs/rank-00000.log").read_text()


def test_retry_gives_up_in_the_end_and_says_how_often_it_tried(study, tmp_path, monkeypatch):
    fail_first(monkeypatch, [1], 9)
    found = run(policy(study, action="retry", retries=3), tmp_path, 4, allow_failed=1.0)
    assert str(found["status_reason"].values[1]) == "MemoryError: no memory left; tried 4 times"


def test_retry_does_not_repeat_what_would_end_the_same(study, tmp_path, monkeypatch):
    calls = []

    def diverges(prepared, index, **options):
        calls.append(index)
        return failed_row(study, index, "diverged", "energy came from nothing")

    worker = Worker(policy(study, action="retry"), tmp_path)
    worker.prepared[0] = None
    monkeypatch.setattr(realisation, "run", diverges)
    assert worker.run_here(Task(5))["status"] == STATUS["diverged"]
    assert calls == [5]


def test_abort_keeps_the_row_says_so_again_and_goes_on_under_another_policy(study, reference, tmp_path, monkeypatch):
    fail_first(monkeypatch, [1], 1)
    for _ in range(2):
        with pytest.raises(ensemble.CampaignFailed, match="realisation 1 ended with status crashed: MemoryError"):
            run(policy(study, action="abort"), tmp_path)
        status = json.loads((tmp_path / "status.json").read_text())
        assert (status["state"], status["failed"]) == ("failed", {"crashed": 1})
        assert status["done"] < REALISATIONS
    assert len(events(tmp_path, "segment")) == 1  # the second time nothing was run
    found = run(study, tmp_path, allow_failed=0.2)
    assert int((found["status"] == STATUS["crashed"]).sum()) == 1


def test_too_many_failures_end_it_and_more_may_be_allowed(study, tmp_path, monkeypatch):
    fail_first(monkeypatch, range(REALISATIONS), 1)
    with pytest.raises(ensemble.CampaignFailed, match=r"10 of 12 realisations have failed.* \(10 crashed\)"):
        run(policy(study, max_failed_fraction=2 / REALISATIONS), tmp_path)
    assert not (tmp_path / "ensemble.nc").exists()
    found = run(study, tmp_path, allow_failed=1.0)
    assert int((found["status"] == STATUS["crashed"]).sum()) == REALISATIONS


def test_time_limit_is_a_row_and_not_the_end(study, tmp_path):
    found = run(policy(study, realisation_time_limit_s=1e-9), tmp_path, 3, allow_failed=1.0)
    np.testing.assert_array_equal(found["status"], STATUS["timeout"])


def test_what_a_time_limit_ended_is_run_once_more_where_asked(study, reference, tmp_path):
    run(policy(study, realisation_time_limit_s=1e-9), tmp_path, allow_failed=1.0)
    kept = run(study, tmp_path, allow_failed=1.0)
    np.testing.assert_array_equal(kept["status"], STATUS["timeout"])
    found = run(study, tmp_path, repeat_failed=True)
    assert results.content_hash(found) == results.content_hash(reference)
    assert len(events(tmp_path, "start")) == 3
    assert events(tmp_path, "start")[2]["todo"] == REALISATIONS


def test_what_would_diverge_again_is_not_run_once_more(study, tmp_path, monkeypatch):
    def diverged(prepared, index, watch=None):
        return failed_row(prepared.study, index, "diverged", "energy came from nothing")

    monkeypatch.setattr(realisation, "run", diverged)
    run(study, tmp_path, 3, allow_failed=1.0)
    run(study, tmp_path, 3, allow_failed=1.0, repeat_failed=True)
    assert [event["todo"] for event in events(tmp_path, "start")] == [3, 0]


def test_abort_goes_on_where_what_was_mended_is_run_once_more(study, reference, tmp_path):
    short = policy(study, action="abort", realisation_time_limit_s=1e-9)
    with pytest.raises(ensemble.CampaignFailed, match="--repeat-failed"):
        run(short, tmp_path)
    mended = policy(study, action="abort")
    with pytest.raises(ensemble.CampaignFailed):
        run(mended, tmp_path)
    assert results.content_hash(run(mended, tmp_path, repeat_failed=True)) == results.content_hash(reference)


def test_rows_beyond_what_was_asked_for_are_said_to_stay(study, tmp_path, capsys):
    run(study, tmp_path, 4)
    ensemble.run(study, tmp_path, 3, 1)
    assert "1 more realisations in the folder than were asked for stay there" in capsys.readouterr().err


# --- the end of the wall time, the file STOP


def test_wall_time_that_is_spent_ends_it_to_be_continued(study, reference, tmp_path):
    with pytest.raises(ensemble.TooShort, match="give a longer --wall-time"):
        run(study, tmp_path, wall_time=1e-3)
    assert json.loads((tmp_path / "status.json").read_text())["state"] == "stopped"
    assert results.content_hash(run(study, tmp_path, wall_time=3600.0)) == results.content_hash(reference)


def test_old_stop_file_is_removed_and_that_is_said(study, tmp_path, capsys):
    run(study, tmp_path, 1)
    (tmp_path / "STOP").touch()
    ensemble.run(study, tmp_path, 2, 1)
    assert not (tmp_path / "STOP").exists()
    assert "removed the file STOP" in capsys.readouterr().err


def test_who_works_is_said_and_too_many_workers_too(study, tmp_path, capsys):
    ensemble.run(study, tmp_path, 1, 500)
    assert "1 of 1 realisations to run, 500 local processes on" in (said := capsys.readouterr().err)
    assert "leave out --workers" in said
    assert "one thread each" in said


# --- what a worker loads and says


def test_log_of_a_worker_has_a_line_for_each_realisation_if_asked(study, tmp_path):
    run(study, tmp_path, 3, log_level="info")
    lines = (tmp_path / "logs" / "rank-00000.log").read_text().splitlines()
    assert len(lines) == 3
    assert "INFO realisation 2: " in lines[2]


def test_worker_loads_only_what_it_needs(tmp_path):
    code = (
        "import sys\nfrom rfmpm.ensemble.markers import Task\nfrom rfmpm.ensemble.worker import Worker\n"
        "from rfmpm.ensemble.segments import SegmentWriter\n"
        "from rfmpm.study import load_study\nfrom pathlib import Path\n"
        f"worker = Worker(load_study({str(COARSE)!r}), Path({str(tmp_path)!r}))\nworker.prepare([0])\n"
        "(worker.directory / 'segments').mkdir()\nwriter = SegmentWriter(worker.directory, worker.study, 0)\n"
        "writer.add(worker.run_here(Task(0)))\nassert writer.flush()\n"
        "unneeded = {'matplotlib', 'pandas', 'xarray', 'netCDF4', 'mpi4py', 'rich', 'typer', 'jinja2', 'psutil'}\n"
        "print('loaded:', sorted(unneeded & sys.modules.keys()))"
    )
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=240, check=True)
    assert process.stdout.splitlines()[-1] == "loaded: []"
