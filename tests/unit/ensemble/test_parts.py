"""One study run in parts: put together, with what is missing and what contradicts."""

import json
import shutil

import numpy as np
import pytest

from rfmpm import campaign_status, ensemble, results
from rfmpm.ensemble.parts import merge_parts, ranges
from rfmpm.study import load_study

TOTAL = 8  # realisations of the coarse study


def run(study, directory, indices=None, **options):
    return ensemble.run(study, directory, workers=1, progress=False, indices=indices, **options)


@pytest.fixture(scope="module")
def whole(study, tmp_path_factory):
    return run(study, tmp_path_factory.mktemp("whole"))


@pytest.fixture(scope="module")
def made(study, tmp_path_factory):
    """Realisations 0 to 2, 2 to 5 and 6 to 7."""
    folder = tmp_path_factory.mktemp("parts")
    for name, indices in {"a": (0, 3), "b": (2, 6), "c": (6, TOTAL)}.items():
        run(study, folder / name, indices)
    return folder


@pytest.fixture
def parts(made, tmp_path):
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return [tmp_path / name for name in "abc"]


def contents(folder):
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_a_part_holds_its_rows_with_their_true_numbers(study, whole, parts):
    part = results.open_ensemble(parts[1])
    np.testing.assert_array_equal(part["realisation"], [2, 3, 4, 5])
    np.testing.assert_array_equal(part["run_out"], whole["run_out"][2:6])
    assert (part.attrs["first_realisation"], part.attrs["realisations_of_study"]) == (2, TOTAL)


def test_parts_make_the_whole_and_are_not_touched(whole, parts, tmp_path):
    before = [contents(part) for part in parts]
    found = merge_parts(parts, tmp_path / "out")
    assert (found.total, found.missing.tolist()) == (TOTAL, [])
    merged = results.open_ensemble(tmp_path / "out")
    assert results.content_hash(merged) == results.content_hash(whole)
    assert [contents(part) for part in parts] == before
    starts = [json.loads((part / "journal.jsonl").read_text().splitlines()[0])["time"] for part in parts]
    assert merged.attrs["start"] == min(starts)


def test_what_is_missing_is_named_and_run_by_the_next_run(study, whole, parts, tmp_path):
    out = tmp_path / "out"
    found = merge_parts([parts[2], parts[0]], out)
    assert found.missing.tolist() == [3, 4, 5]
    assert not (out / "ensemble.nc").exists()
    assert results.content_hash(run(study, out)) == results.content_hash(whole)
    starts = [json.loads(line) for line in (out / "journal.jsonl").read_text().splitlines()]
    assert [event["todo"] for event in starts if "todo" in event] == [3]


def test_status_and_times_of_the_whole_are_those_of_the_parts(study, parts, tmp_path):
    merge_parts(parts[:2], parts[0])
    found = campaign_status.read(parts[0])
    assert (found["state"], found["done"], found["total"]) == ("stopped", 6, TOTAL)
    merge_parts(parts, parts[0])
    found = campaign_status.read(parts[0])
    assert (found["state"], found["done"], found["failed"]) == ("complete", TOTAL, {})
    before = results.open_ensemble(parts[0]).attrs
    after = run(study, parts[0]).attrs  # nothing is left to do
    assert (after["start"], after["end"]) == (before["start"], before["end"])
    assert after["end"] > after["start"]


def test_a_folder_takes_the_parts_that_it_lacks(whole, parts, tmp_path):
    assert merge_parts(parts[1:], parts[0]).missing.size == 0
    assert results.content_hash(results.open_ensemble(parts[0])) == results.content_hash(whole)


def test_parts_of_another_study_are_refused_with_the_difference(study, parts, tmp_path):
    other = study.with_changes({"material.0.residual_cohesion_kpa": 3.0})
    run(other, tmp_path / "other", (0, 1))
    with pytest.raises(ensemble.FolderMismatch, match=r"residual_cohesion_kpa: 3\.0 -> 2\.0"):
        merge_parts([*parts, tmp_path / "other"], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_parts_of_other_sources_are_refused(parts, tmp_path, monkeypatch):
    monkeypatch.setattr(results, "source_hash", lambda: "0" * 64)
    with pytest.raises(ensemble.FolderMismatch, match="another version of the program"):
        merge_parts(parts, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_rows_that_contradict_each_other_are_refused(parts, tmp_path):
    (path,) = (parts[1] / "segments").iterdir()
    stored = results.read_rows(path)
    changed = {**stored.columns, "run_out": stored.columns["run_out"] + [1e-12, 0.0, 0.0, 0.0]}
    results.write_rows(path.parent, "zzz", changed, stored.attributes)
    path.unlink()
    with pytest.raises(ensemble.RowsDiffer, match="realisation 2 has two different rows: run_out"):
        merge_parts(parts, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_damaged_segment_of_a_part_is_missing_and_left_where_it_is(parts, tmp_path):
    (path,) = (parts[2] / "segments").iterdir()
    path.write_bytes(path.read_bytes()[:-1])
    assert merge_parts(parts, tmp_path / "out").missing.tolist() == [6, 7]
    assert path.exists()


def test_a_folder_without_a_campaign_is_refused(parts, tmp_path):
    with pytest.raises(ensemble.FolderMismatch, match=r"nowhere: holds no readable study\.toml"):
        merge_parts([*parts, tmp_path / "nowhere"], tmp_path / "out")


def test_the_study_is_that_of_the_part_with_most_realisations(study, parts, tmp_path):
    shutil.rmtree(parts[2])
    run(study.with_changes({"study.realisations": 10}), parts[2], (6, 9))
    found = merge_parts(parts, tmp_path / "out")
    assert (found.total, found.missing.tolist()) == (10, [9])
    assert load_study(tmp_path / "out" / "study.toml").study.realisations == 10


@pytest.mark.parametrize("indices", [(0, 0), (3, 2), (-1, 2), (0, TOTAL + 1)])
def test_indices_that_the_study_has_not_are_an_error(study, tmp_path, indices):
    with pytest.raises(ValueError, match=f"must be a part, not empty, of 0:{TOTAL}"):
        run(study, tmp_path / "out", indices)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("indices", "named"), [([], []), ([3], ["3"]), ([0, 1, 2, 5, 8, 9], ["0 to 2", "5", "8 to 9"])]
)
def test_ranges(indices, named):
    assert ranges(np.array(indices, int)) == named
