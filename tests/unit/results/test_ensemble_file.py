from pathlib import Path

import netCDF4
import numpy as np
import pytest

from rfmpm import results
from rfmpm.results import netcdf, row_files
from rfmpm.study import load_study
from rfmpm.variables import FAILED, STATUS, active_variables, failed_row

COARSE = Path(__file__).parents[2] / "robustness" / "coarse.toml"
VARIABLES = {variable.name: variable for variable in active_variables(load_study(COARSE))}
BINS = 16  # the coarse domain is 4 + 4 + 8 m long


def finished_row(index, **changes):
    row = {name: 0.1 * index + place for place, name in enumerate(VARIABLES)}
    row.update(
        realisation=index, level=0, run_out_censored=False, retrogression_censored=True, block_count=index,
        failure_mode=index, status=STATUS["ok"], status_reason="", step_count=1000 + index, time_at_rest=np.nan,
        final_surface=np.linspace(4.0, 0.0, BINS) + index,
    )  # fmt: skip
    return row | changes


@pytest.fixture
def rows(study):
    return [finished_row(2), failed_row(study, 1, "diverged", "too fast é", wall_time=0.5), finished_row(0)]


@pytest.fixture
def stored(study, rows, tmp_path):
    write_ensemble(tmp_path / "ensemble.nc", rows, study)
    return results.open_ensemble(tmp_path)


def write_ensemble(path, rows, study, size=2):
    """Write rows in blocks of `size`."""
    found = results.columns(rows, study)
    found["origin"] = np.zeros(len(rows), "int32")
    blocks = [{name: values[i : i + size] for name, values in found.items()} for i in range(0, len(rows), size)]
    return results.write_ensemble(path, study, len(rows), blocks)


def test_rows_come_back_sorted_and_exact(stored, study):
    np.testing.assert_array_equal(stored["realisation"], [0, 1, 2])
    for place in (0, 2):
        for name, value in finished_row(place).items():
            np.testing.assert_array_equal(stored[name].values[place], value)


def test_failed_row_is_missing_values_with_a_status(stored):
    assert int(stored["status"][1]) == STATUS["diverged"]
    assert str(stored["status_reason"].values[1]) == "too fast é"
    for name in set(VARIABLES) - {"status", "status_reason", "wall_time"}:
        assert np.all(np.isnan(stored[name].values[1])), name


def test_on_disk_types_compression_and_fill_values_are_those_of_the_table(stored, tmp_path):
    with netCDF4.Dataset(tmp_path / "ensemble.nc") as file:
        for variable in VARIABLES.values():
            on_disk = file.variables[variable.name]
            assert on_disk.dimensions == variable.dims
            if variable.dtype == "str":
                continue
            assert on_disk.dtype == np.dtype(variable.dtype)
            assert on_disk.filters()["zlib"]
            assert on_disk.filters()["shuffle"]
        assert file.variables["block_count"]._FillValue == -1
        assert not hasattr(file.variables["status"], "_FillValue")
        assert file.variables["status"].flag_values.dtype == np.int8


def test_cf_attributes(stored, study):
    assert stored.attrs["Conventions"] == "CF-1.11"
    assert stored["run_out"].attrs["units"] == "m"
    assert "0.5 m" in stored["run_out"].attrs["comment"]
    assert "units" not in stored["status"].attrs
    assert stored["status"].attrs["flag_meanings"].split() == list(STATUS)
    assert stored["x"].attrs["axis"] == "X"
    np.testing.assert_allclose(stored["x"], np.arange(BINS) + 0.5, rtol=1e-12)  # identity
    assert stored.attrs["study"] == study.to_toml()
    assert stored.attrs["physics_hash"] == study.physics_hash
    assert stored.attrs["seed"] == study.study.seed
    assert {"source_hash", "rfmpm_version", "library_versions"} <= set(stored.attrs)


def test_every_variable_has_a_long_name_and_a_unit_or_flags(stored):
    for name, variable in stored.variables.items():
        assert variable.attrs["long_name"], name
        assert {"units", "flag_meanings"} & set(variable.attrs) or name == "status_reason", name


def test_missing_variable_is_an_error_that_names_it(study):
    row = finished_row(0)
    del row["influence_distance"]
    with pytest.raises(KeyError, match="influence_distance"):
        results.dataset([row], study)


def test_surface_with_another_number_of_bins_is_an_error(study):
    with pytest.raises(ValueError, match=f"{BINS + 1}"):
        results.dataset([finished_row(0), finished_row(1, final_surface=np.zeros(BINS + 1))], study)


def test_surface_has_its_length_even_if_every_row_failed(study):
    found = results.dataset([failed_row(study, 0, next(iter(FAILED)), "")], study)
    assert found["final_surface"].shape == (1, BINS)


def test_without_surface_there_is_no_x(study):
    found = results.dataset([finished_row(0)], study.with_changes({"output": {"directory": "elsewhere"}}))
    assert set(found.sizes) == {"realisation"}


def test_hash_ignores_order_and_wall_time_and_nothing_else(study, rows):
    expected = results.content_hash(results.dataset(rows, study))
    assert results.content_hash(results.dataset(rows[::-1], study)) == expected
    assert results.content_hash(results.dataset([rows[0] | {"wall_time": 9.0}, *rows[1:]], study)) == expected
    for name in set(rows[0]) - {"wall_time"}:
        value = rows[0][name]
        other = "x" if name == "status_reason" else np.nextafter(value, 9e9) if isinstance(value, float) else value + 1
        if name in ("run_out_censored", "retrogression_censored"):
            other = not value
        if name == "time_at_rest":
            other = 1.0
        changed = results.dataset([rows[0] | {name: other}, *rows[1:]], study)
        assert results.content_hash(changed) != expected, name


def test_hash_survives_the_file(stored, study, rows):
    assert results.content_hash(stored) == results.content_hash(results.dataset(rows, study))
    assert stored.attrs["content_hash"] == results.content_hash(stored)


@pytest.mark.parametrize("size", [1, 2, 3])
def test_block_by_block_is_the_same_file_as_at_once(study, rows, tmp_path, size):
    at_once = results.dataset(rows, study)
    results.write_dataset(tmp_path / "at_once.nc", at_once)
    found = write_ensemble(tmp_path / "blocks.nc", rows, study, size)
    assert found == at_once.attrs["content_hash"]
    first, second = (results.open_ensemble(tmp_path / name) for name in ("at_once.nc", "blocks.nc"))
    assert first.identical(second)
    for name in first.variables:
        assert first[name].encoding["dtype"] == second[name].encoding["dtype"], name


@pytest.mark.parametrize("most", [1, 7, 40])
def test_hash_does_not_depend_on_how_much_is_read_at_once(study, rows, monkeypatch, most):
    expected = results.content_hash(results.dataset(rows, study))
    monkeypatch.setattr(netcdf, "_VALUES_AT_ONCE", most)
    assert results.content_hash(results.dataset(rows, study)) == expected


def test_file_appears_whole_or_not_at_all(study, rows, tmp_path, monkeypatch):
    path = tmp_path / "ensemble.nc"
    write_ensemble(path, rows[:1], study)
    before = path.read_bytes()

    def fail(*_):
        raise OSError("no space left")

    monkeypatch.setattr(row_files.os, "replace", fail)
    with pytest.raises(OSError, match="no space left"):
        write_ensemble(path, rows, study)
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["ensemble.nc"]


def test_incomplete_campaign_is_said_to_be_so(tmp_path):
    with pytest.raises(FileNotFoundError, match="completed"):
        results.open_ensemble(tmp_path)


def test_a_full_disk_is_an_os_error_and_leaves_the_old_file_alone(tmp_path):
    class Unwritable:
        def to_netcdf(self, path, **options):
            path.write_bytes(b"half a file")
            raise RuntimeError("NetCDF: HDF error")  # what netCDF4 raises when the disk is full

    path = tmp_path / "ensemble.nc"
    path.write_bytes(b"old")
    with pytest.raises(OSError, match=r"ensemble\.nc: cannot be written, is the disk full"):
        netcdf.write_dataset(path, Unwritable())
    assert [(file.name, file.read_bytes()) for file in tmp_path.iterdir()] == [("ensemble.nc", b"old")]
