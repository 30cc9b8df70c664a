import os
from pathlib import Path

import numpy as np
import pytest

from rfmpm.random_fields import store as field_store
from rfmpm.random_fields.field import prepare, realise
from rfmpm.random_fields.methods.cholesky import Cholesky

MEAN = 20e3


def field(prepared) -> bytes:
    return realise(prepared, np.random.default_rng(9).standard_normal(prepared.n_variables)).tobytes()


def factor_file(folder: Path) -> Path:
    (path,) = folder.glob("*.lower.npy")
    return path


@pytest.fixture
def no_factorisation(monkeypatch):
    """A call of the returned function makes every later factorisation an error."""

    def forbid():
        def prepare(correlation, points):
            raise AssertionError("factored again")

        monkeypatch.setattr(Cholesky, "prepare", staticmethod(prepare))

    return forbid


@pytest.mark.parametrize("correlation", ["markov_separable", "gaussian"])
def test_stored_and_fresh_factors_give_the_same_bits(settings, points, tmp_path, no_factorisation, correlation):
    settings.correlation = correlation
    fresh = prepare(settings, MEAN, points)
    first = prepare(settings, MEAN, points, tmp_path / "made" / "here")
    no_factorisation()
    found = prepare(settings, MEAN, points, tmp_path / "made" / "here")
    assert field(fresh) == field(first) == field(found)
    assert found.record.nugget == fresh.record.nugget


def test_a_store_holds_whole_files_only(settings, points, tmp_path):
    prepare(settings, MEAN, points, tmp_path)
    assert sorted(path.suffixes[-1] for path in tmp_path.iterdir()) == [".npy", ".npy"]


def test_the_factor_does_not_depend_on_mean_or_spread(settings, points, tmp_path, no_factorisation):
    prepare(settings, MEAN, points, tmp_path)
    no_factorisation()
    settings.coefficient_of_variation = 0.5
    prepare(settings, 2.0 * MEAN, points, tmp_path)  # would factorise, which raises, if it looked for another file
    assert len(list(tmp_path.glob("*.lower.npy"))) == 1


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("correlation", "markov_separable"),
        ("scale_of_fluctuation_h_m", 6.000000001),
        ("scale_of_fluctuation_v_m", 2.0),
        ("rotation_deg", 1.0),
    ],
)
def test_another_correlation_is_another_file(settings, points, tmp_path, key, value):
    prepare(settings, MEAN, points, tmp_path)
    setattr(settings, key, value)
    stored = prepare(settings, MEAN, points, tmp_path)
    assert len(list(tmp_path.glob("*.lower.npy"))) == 2
    assert field(stored) == field(prepare(settings, MEAN, points))


def test_other_points_are_another_file(settings, points, tmp_path):
    prepare(settings, MEAN, points, tmp_path)
    stored = prepare(settings, MEAN, points + np.array([0.0, 1e-9]), tmp_path)
    assert len(list(tmp_path.glob("*.lower.npy"))) == 2
    assert stored.n_variables == len(points)


def truncate(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def empty(path: Path) -> None:
    path.write_bytes(b"")


def fill_with_text(path: Path) -> None:
    path.write_text("not an array")


def leave_a_hole(path: Path) -> None:
    array = np.load(path)
    array[100:110] = 0.0
    np.save(path, array)


def put_other_shape(path: Path) -> None:
    np.save(path, np.eye(3))


def put_archive(path: Path) -> None:
    with open(path, "wb") as file:
        np.savez(file, lower=np.eye(3))


@pytest.mark.parametrize(
    "harm", [truncate, empty, fill_with_text, leave_a_hole, put_other_shape, put_archive, os.unlink]
)
@pytest.mark.parametrize("part", ["lower", "nugget"])
def test_a_damaged_or_foreign_file_is_remade(settings, points, tmp_path, harm, part):
    prepare(settings, MEAN, points, tmp_path)
    (path,) = tmp_path.glob(f"*.{part}.npy")
    if harm is leave_a_hole and part == "nugget":
        np.save(path, np.array(0.5))
    else:
        harm(path)
    whole = prepare(settings, MEAN, points)
    assert field(prepare(settings, MEAN, points, tmp_path)) == field(whole)
    assert np.array_equal(np.load(factor_file(tmp_path)), whole.record.lower)


def test_a_store_that_cannot_be_written_is_an_error(settings, points, tmp_path):
    (tmp_path / "store").write_text("a file where the folder should be")
    with pytest.raises(OSError, match="store"):
        prepare(settings, MEAN, points, tmp_path / "store")


def test_an_interrupted_write_leaves_no_file_and_names_the_folder(settings, points, tmp_path, monkeypatch):
    def full(file, array):
        raise OSError("no space left")

    monkeypatch.setattr(field_store.np, "save", full)
    with pytest.raises(OSError, match=f"{tmp_path}: no space left"):
        prepare(settings, MEAN, points, tmp_path)
    assert list(tmp_path.iterdir()) == []
