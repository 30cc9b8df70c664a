"""Campaigns that follow a plan: the same rows for any number of processes, however often they are cut off."""

import json
import os
import signal

import numpy as np
import pytest

from rfmpm import ensemble, planning, realisation, results
from rfmpm.estimators import MonteCarlo, Multilevel, Rows
from rfmpm.variables import STATUS

WIDTH = 0.06  # [m]
MEAN = {"quantity": "run_out", "half_width_m": WIDTH, "at_most": 400}


def run(study, directory, workers=1, **options):
    return ensemble.run(study, directory, workers=workers, progress=False, **options)


def asking(study, **changes):
    return study.with_changes({"study.realisations": None, "study.until": MEAN} | changes)


@pytest.fixture(scope="module")
def stopping(study):
    return asking(study)


@pytest.fixture(scope="module")
def levelled(study):
    levels = {"method": "multilevel", "coarser_cells_m": [1.0]}
    return asking(study, **{"discretisation.cell_m": 0.5, "estimator": levels})


@pytest.fixture(autouse=True)
def small_steps(monkeypatch):
    """Begin with few realisations, so that some rounds take no time."""
    monkeypatch.setattr(planning.estimation, "MonteCarlo", lambda *asked: MonteCarlo(*asked, first_block=8))
    monkeypatch.setattr(planning.estimation, "Multilevel", lambda *asked: Multilevel(*asked, pilot=8))


@pytest.fixture(scope="module")
def references(tmp_path_factory):
    return {}


@pytest.fixture(params=["stopping", "levelled"])
def asked(request):
    return request.getfixturevalue(request.param)


@pytest.fixture
def reference(asked, references, tmp_path_factory, small_steps):
    if asked.physics_hash not in references:
        folder = tmp_path_factory.mktemp("reference")
        references[asked.physics_hash] = folder, run(asked, folder)
    return references[asked.physics_hash]


def kill_after(monkeypatch, count):
    """Let each process be killed after so many realisations."""
    real_run, done = realisation.run, []

    def deadly(prepared, index, **options):
        done.append(index)
        if len(done) > count:
            os.kill(os.getpid(), signal.SIGKILL)
        return real_run(prepared, index, **options)

    monkeypatch.setattr(realisation, "run", deadly)


def test_the_question_is_answered_and_rows_are_sorted_by_level_and_index(asked, reference):
    folder, rows = reference
    found = planning.answer(asked, planning.rows_of(asked, rows))
    assert found.upper - found.lower <= 2 * WIDTH
    place = rows["level"].values.astype(int) * 10_000 + rows["realisation"].values
    assert np.all(np.diff(place) > 0)
    for level in np.unique(rows["level"]):
        index = rows["realisation"].values[rows["level"] == level]
        np.testing.assert_array_equal(index, np.arange(len(index)))
    journal = [json.loads(line) for line in (folder / "journal.jsonl").read_text().splitlines()]
    assert len([event for event in journal if event["event"] == "plan"]) >= 1  # several rounds, or this tests little
    status = json.loads((folder / "status.json").read_text())
    assert status["estimate"]["upper"] == found.upper
    assert (status["done"], status["state"]) == (rows.sizes["realisation"], "complete")


def test_two_processes_find_the_same(asked, reference, tmp_path):
    assert results.content_hash(run(asked, tmp_path, 2)) == results.content_hash(reference[1])


def test_a_campaign_whose_workers_die_now_and_then_finds_the_same(asked, reference, tmp_path, monkeypatch):
    kill_after(monkeypatch, 5)  # a round of 16 is more than two workers come to
    monkeypatch.setattr(ensemble.segments, "ROWS", 2)
    found = run(asked, tmp_path, 2)
    assert "worker_lost" in (tmp_path / "journal.jsonl").read_text()
    assert results.content_hash(found) == results.content_hash(reference[1])


def test_a_narrower_aim_goes_on_from_what_is_there(asked, reference, tmp_path):
    wide = asked.with_changes({"study.until.half_width_m": 0.2})
    before = run(wide, tmp_path)
    rows = run(asked, tmp_path)
    assert before.sizes["realisation"] < rows.sizes["realisation"]
    assert results.content_hash(rows) == results.content_hash(reference[1])
    assert results.open_ensemble(tmp_path).identical(rows)
    back = run(wide, tmp_path, 1)  # and a wider one needs no more than it did
    assert results.content_hash(back) == results.content_hash(before)


def test_the_most_realisations_end_it_unanswered_and_more_continue_it(stopping, tmp_path):
    few = stopping.with_changes({"study.until.at_most": 10})
    rows = run(few, tmp_path)
    assert rows.sizes["realisation"] == 10
    lines = planning.answer_lines(few, planning.answer(few, planning.rows_of(few, rows)))
    assert "not known to within 0.06 m, as was asked, but 0." in lines[1]
    assert run(few.with_changes({"study.until.at_most": 12}), tmp_path).sizes["realisation"] == 12


def test_a_part_of_a_plan_cannot_be_asked_for(asked, tmp_path):
    with pytest.raises(ValueError, match="only a study with a fixed number of independent realisations can be run in"):
        run(asked, tmp_path, indices=(0, 5))


def test_a_number_of_realisations_contradicts_a_question(stopping, tmp_path):
    with pytest.raises(ValueError, match=r"study.realisations = 5: must be left out together with study.until"):
        run(stopping, tmp_path, realisations=5)


def test_failures_on_any_level_are_rows_and_are_repeated_where_asked(levelled, references, tmp_path, monkeypatch):
    real_run = realisation.run

    def fails(prepared, index, **options):
        if index == 3 and options.get("level"):
            raise MemoryError("no memory left")
        return real_run(prepared, index, **options)

    monkeypatch.setattr(realisation, "run", fails)
    rows = run(levelled, tmp_path, allow_failed=0.5)
    (at,) = np.flatnonzero(rows["status"] == STATUS["crashed"])
    assert (rows["level"].values[at], rows["realisation"].values[at]) == (1, 3)
    events = [json.loads(line) for line in (tmp_path / "journal.jsonl").read_text().splitlines()]
    assert [event["level"] for event in events if event["event"] == "failed"] == [1]
    seen = planning.rows_of(levelled, rows)
    assert np.all(seen.work > 0.0)
    monkeypatch.setattr(realisation, "run", real_run)
    mended = run(levelled, tmp_path, repeat_failed=True)
    (_, reference) = references[levelled.physics_hash]
    assert results.content_hash(mended) == results.content_hash(reference)


def test_the_same_realisation_has_the_same_field_on_every_level(levelled):
    fine, coarse = (planning.Replay(levelled, level=level) for level in (0, 1))
    xi = coarse.options(4)["xi"]
    np.testing.assert_array_equal(xi, realisation.draw_xi(fine.prepared, 4))
    assert fine.options(4) == {}


def test_own_cells_alone_are_one_row_for_each_realisation(levelled, references):
    (_, rows) = references[levelled.physics_hash]
    own = planning.on_own_cells(rows)
    np.testing.assert_array_equal(own["realisation"], np.arange(own.sizes["realisation"]))
    assert own.sizes["realisation"] < rows.sizes["realisation"]


def test_work_of_failed_simulations_is_the_mean_of_their_level():
    seen = planning.as_rows(
        [0, 1, 1, 1], [0, 2, 0, 1], [1.0, np.nan, 1.0, 1.0], [False] * 4, [9, -1, 3, 5], np.array([7, 2])
    )
    assert isinstance(seen, Rows)
    assert seen.index.tolist() == [0, 0, 1, 2]
    assert seen.work.tolist() == [63.0, 6.0, 10.0, 8.0]
