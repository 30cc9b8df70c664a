"""Which realisations are finished, found and merged without holding their rows."""

import json

import numpy as np
import pytest

from rfmpm import ensemble, results
from rfmpm.ensemble import segments
from rfmpm.ensemble.folder import Journal
from rfmpm.variables import STATUS, failed_row


def row(study, index, **changes):
    """A row whose values tell its realisation."""
    made = {**failed_row(study, index, "diverged", f"reason {index}"), "run_out": 0.5 * index, "wall_time": 1.0}
    if study.output.surface_bin_m is not None:
        made["final_surface"] = float(index)
    return made | changes


def write(study, directory, indices, stem="00000-1-00000", **changes):
    (directory / "segments").mkdir(exist_ok=True)
    made = results.columns([row(study, index, **changes) for index in indices], study)
    return results.write_rows(directory / "segments", stem, made, results.row_attributes(study))


def merge(study, directory, total, name="merged.nc", first=0):
    found = segments.merge(directory, study, None, np.arange(first, total), directory / name, {})
    merged = results.open_ensemble(directory / name)
    assert found == merged.attrs["content_hash"] == results.content_hash(merged)
    return merged


@pytest.fixture
def scattered(study, tmp_path):
    """Rows 0 to 9 of three workers; row 4 is ok, the others failed."""
    write(study, tmp_path, [9, 0, 3], "00000-1-00000")
    write(study, tmp_path, [1, 2, 5, 8], "00001-1-00000")
    write(study, tmp_path, [7, 6], "00002-1-00000")
    write(study, tmp_path, [4], "00002-1-00001", status=STATUS["ok"])
    return tmp_path


def test_indices_and_statuses_are_sorted_and_counted(study, scattered):
    found = segments.finished(scattered, study, None)
    np.testing.assert_array_equal(found.codes, np.arange(10))
    assert (found.count, found.failed) == (10, 9)
    assert found.status.tolist() == [STATUS["diverged"]] * 4 + [STATUS["ok"]] + [STATUS["diverged"]] * 5


def test_nothing_is_finished_in_an_empty_folder(study, tmp_path):
    found = segments.finished(tmp_path, study, None)
    assert (found.count, found.failed, found.codes.tolist()) == (0, 0, [])


def test_only_new_segments_are_read_again(study, scattered, monkeypatch):
    before = segments.finished(scattered, study, None)
    new = write(study, scattered, [11, 10])
    read, seen = results.read_rows, []
    monkeypatch.setattr(results, "read_rows", lambda path: seen.append(path) or read(path))
    after = segments.finished(scattered, study, None, before)
    assert seen == [new]
    np.testing.assert_array_equal(after.codes, np.arange(12))


@pytest.mark.parametrize("bytes_at_once", [1, 400, 2**26])
def test_merging_gathers_scattered_rows_whatever_is_held_at_once(study, scattered, monkeypatch, bytes_at_once):
    monkeypatch.setattr(segments, "_BLOCK", bytes_at_once)
    merged = merge(study, scattered, 10)
    np.testing.assert_array_equal(merged["realisation"], np.arange(10))
    np.testing.assert_array_equal(merged["run_out"], 0.5 * np.arange(10))
    np.testing.assert_array_equal(merged["final_surface"][:, 3], np.arange(10))
    assert merged["status_reason"].values.tolist() == [f"reason {index}" for index in range(10)]
    expected = results.dataset([row(study, i, status=STATUS["ok" if i == 4 else "diverged"]) for i in range(10)], study)
    assert merged.attrs["content_hash"] == expected.attrs["content_hash"]


def test_a_part_says_which_it_is(study, scattered):
    merged = merge(study, scattered, 7, first=3)
    np.testing.assert_array_equal(merged["realisation"], [3, 4, 5, 6])
    assert (merged.attrs["first_realisation"], merged.attrs["realisations_of_study"]) == (3, 8)
    whole = merge(study, scattered, study.study.realisations, "whole.nc")
    assert "first_realisation" not in whole.attrs


def test_merging_with_a_gap_is_an_error_and_writes_nothing(study, scattered):
    with pytest.raises(ValueError, match="2 of 12 realisations have no row"):
        segments.merge(scattered, study, None, np.arange(12), scattered / "merged.nc", {})
    assert not (scattered / "merged.nc").exists()


def test_a_row_names_its_origin_and_its_attempts(study, tmp_path, monkeypatch):
    write(study, tmp_path, [0, 2], "00000-1-00000")
    elsewhere = {**results.row_attributes(study), "host": "zzz"}
    made = results.columns([row(study, 1, attempt=3)], study)
    results.write_rows(tmp_path / "segments", "00001-1-00000", made, elsewhere)
    merged = merge(study, tmp_path, 3)
    assert merged["origin"].values.tolist() == [0, 1, 0]
    assert merged["attempt"].values.tolist() == [1, 3, 1]
    here, there = merged.attrs["origins"].split("\n")
    assert there.startswith("1: zzz; rfmpm ")
    assert "numpy " in here
    assert merged.attrs["content_hash"] == results.content_hash(
        results.dataset([row(study, index) for index in range(3)], study)
    )


def test_many_repeated_rows_are_compared_each_with_its_own(study, scattered):
    write(study, scattered, range(4), "00005-1-00000")
    write(study, scattered, [0, 3], "00006-1-00000", wall_time=5.0)
    assert segments.finished(scattered, study, None).count == 10
    bad = write(study, scattered, [5], "00007-1-00000", status_reason="another")
    with pytest.raises(ensemble.RowsDiffer, match=rf"realisation 5 .*reason 5 in .*another in .*{bad.name}"):
        segments.finished(scattered, study, None)


@pytest.mark.parametrize("name", ["timeout", "crashed"])
def test_a_row_that_ended_by_chance_gives_way_to_one_that_did_not(study, tmp_path, name):
    write(study, tmp_path, [0, 1], "00000-1-00000", status=STATUS[name])
    write(study, tmp_path, [1, 2], "00001-1-00000", status=STATUS["ok"], run_out=3.0)
    found = segments.finished(tmp_path, study, None)
    assert found.status.tolist() == [STATUS[name], STATUS["ok"], STATUS["ok"]]
    assert merge(study, tmp_path, 3)["run_out"].values.tolist() == [0.0, 3.0, 3.0]


def test_without_a_journal_a_damaged_segment_stays_where_it_is(study, scattered, caplog):
    (damaged,) = scattered.glob("segments/00000-*")
    damaged.write_bytes(b"torn")
    assert segments.finished(scattered, study, None).count == 7
    assert damaged.read_bytes() == b"torn"
    assert damaged.name in caplog.text
    journal = Journal(scattered / "journal.jsonl")
    assert segments.finished(scattered, study, journal).count == 7
    assert (scattered / "quarantine" / damaged.name).read_bytes() == b"torn"
    assert json.loads(journal.path.read_text())["segment"] == damaged.name


class TestSurfaceAskedForLater:
    @pytest.fixture
    def bare(self, study):
        return study.with_changes({"output": {"directory": "elsewhere"}})

    def test_it_is_no_other_physics(self, study, bare):
        assert bare.physics_hash == study.physics_hash

    def test_rows_without_it_are_not_finished(self, study, bare, tmp_path):
        write(bare, tmp_path, [0, 1])
        assert segments.finished(tmp_path, bare, None).count == 2
        assert segments.finished(tmp_path, study, None).count == 0

    def test_rows_with_other_bins_are_not_finished(self, study, tmp_path):
        write(study, tmp_path, [0, 1])
        assert segments.finished(tmp_path, study.with_changes({"output.surface_bin_m": 0.5}), None).count == 0

    def test_the_row_that_has_it_is_taken(self, study, bare, tmp_path):
        write(bare, tmp_path, [0, 1, 2], "00000-1-00000")
        write(study, tmp_path, [2, 1], "00001-1-00000")
        assert segments.finished(tmp_path, study, None).codes.tolist() == [1, 2]
        write(study, tmp_path, [0], "00002-1-00000")
        np.testing.assert_array_equal(merge(study, tmp_path, 3)["final_surface"][:, 0], [0, 1, 2])
        assert "final_surface" not in merge(bare, tmp_path, 3)

    def test_the_other_columns_must_be_the_same(self, study, bare, tmp_path):
        write(bare, tmp_path, [0], "00000-1-00000")
        write(study, tmp_path, [0], "00001-1-00000", run_out=np.nextafter(0.0, 1.0))
        for asked in (study, bare):
            with pytest.raises(ensemble.RowsDiffer, match="realisation 0 has two different rows: run_out"):
                segments.finished(tmp_path, asked, None)


def test_a_row_is_found_by_its_index(study, scattered):
    found = segments.find_row(scattered, 8)
    assert found.columns["run_out"].tolist() == [4.0]
    assert found.columns["final_surface"].shape == (1, 16)
    assert found.attributes["physics_hash"] == study.physics_hash
    with pytest.raises(LookupError, match="realisation 10 has no row here"):
        segments.find_row(scattered, 10)
