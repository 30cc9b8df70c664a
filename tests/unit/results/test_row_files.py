"""Files of rows: every bit comes back, and no bit that changed goes unnoticed."""

import numpy as np
import pytest

from rfmpm import results
from rfmpm.results import row_files
from rfmpm.variables import failed_row

ATTRIBUTES = {"physics_hash": "abc", "surface_bin_m": 1.0}


@pytest.fixture
def given(study):
    generator = np.random.default_rng(20160901)
    rows = [failed_row(study, index, "diverged", f"réason {index}", wall_time=0.1 * index) for index in range(5)]
    for row in rows[1:]:
        row.update(run_out=generator.normal(), failure_volume=-0.0, final_surface=generator.normal(size=16))
    return results.columns(rows, study)


@pytest.fixture
def stored(given, tmp_path):
    return results.write_rows(tmp_path, "00000-1-00000", given, ATTRIBUTES)


def test_rows_come_back_bit_for_bit(given, stored):
    found = results.read_rows(stored)
    assert found.attributes == ATTRIBUTES
    assert found.columns.keys() == given.keys()
    for name, values in given.items():
        assert found.columns[name].dtype == values.dtype
        assert found.columns[name].shape == values.shape
        assert found.columns[name].tobytes() == values.tobytes() or values.dtype == object
    assert found.columns["status_reason"].tolist() == given["status_reason"].tolist()


def test_equal_rows_have_equal_names(given, stored, tmp_path):
    assert results.write_rows(tmp_path, "00000-1-00000", given, ATTRIBUTES) == stored
    longer = {**given, "wall_time": given["wall_time"] + 1.0}
    assert results.write_rows(tmp_path, "00000-1-00000", longer, ATTRIBUTES) != stored


def test_every_flipped_bit_is_noticed(stored):
    content = stored.read_bytes()
    for place in np.random.default_rng(7).integers(0, 8 * len(content), 200):
        altered = bytearray(content)
        altered[place // 8] ^= 1 << (place % 8)
        stored.write_bytes(altered)
        with pytest.raises(results.UnreadableRows, match="does not match"):
            results.read_rows(stored)
    stored.write_bytes(content)
    results.read_rows(stored)


def test_every_truncation_is_noticed(stored):
    content = stored.read_bytes()
    for size in [0, len(content) - 1, *np.random.default_rng(7).integers(0, len(content), 50)]:
        stored.write_bytes(content[:size])
        with pytest.raises(results.UnreadableRows, match="does not match"):
            results.read_rows(stored)


def test_a_changed_name_is_noticed(stored):
    renamed = stored.rename(stored.with_name("00000-1-00000-0123456789abcdef.rows"))
    with pytest.raises(results.UnreadableRows, match="does not match"):
        results.read_rows(renamed)


def test_an_intact_file_of_something_else_is_unreadable(tmp_path):
    for content in (b"not ours", b"{}\n", b'{"texts": {}, "columns": [["a", "<f8", [9]]], "attributes": {}}\n'):
        path = tmp_path / f"route-{row_files._hash(content)}.rows"
        path.write_bytes(content)
        with pytest.raises(results.UnreadableRows, match="route"):
            results.read_rows(path)


def test_a_file_appears_whole_or_not_at_all(given, tmp_path, monkeypatch):
    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(row_files, "flush_to_disk", fail)
    with pytest.raises(OSError, match="No space left"):
        results.write_rows(tmp_path, "00000-1-00000", given, ATTRIBUTES)
    assert list(tmp_path.iterdir()) == []


def test_differences_are_of_bits_and_leave_out_what_depends_on_the_run(given):
    other = {**given, "wall_time": given["wall_time"] + 1.0, "attempt": given["attempt"] + 1}
    assert results.differences(given, other) == {}
    other["failure_volume"] = np.where(given["failure_volume"] == 0.0, 0.0, given["failure_volume"])  # from minus zero
    other["status_reason"] = np.array([*given["status_reason"][:4], "x"], object)
    other["final_surface"] = given["final_surface"] + np.eye(5, 16)
    found = results.differences(given, other)
    assert list(found) == ["failure_volume", "final_surface", "status_reason"]
    assert found["failure_volume"].tolist() == [False, True, True, True, True]
    assert found["final_surface"].tolist() == [False, True, True, True, True]  # NaN, plus one, is NaN
    assert found["status_reason"].tolist() == [False, False, False, False, True]


def test_surfaces_of_other_bins_are_not_compared(given):
    assert results.differences(given, {**given, "final_surface": np.zeros((5, 8))}) == {}


def test_a_copy_is_the_same_file_and_a_damaged_one_is_not_copied(stored, tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    results.copy_rows(stored, folder)
    assert (folder / stored.name).read_bytes() == stored.read_bytes()
    stored.write_bytes(b"torn")
    results.copy_rows(stored, folder)  # it has it already
    (folder / stored.name).unlink()
    with pytest.raises(results.UnreadableRows):
        results.copy_rows(stored, folder)
    assert list(folder.iterdir()) == []
