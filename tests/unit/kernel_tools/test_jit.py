"""How kernels are compiled: dispatch by class, records of arrays, scalars or None, and the cache's folder."""

import tempfile
from pathlib import Path
from typing import NamedTuple, Protocol

import numba
import numpy as np
import pytest

from rfmpm.kernel_tools import at, cache_folder, generic, kernel, part, put


class Shape(Protocol):
    def area(self, scale):
        """Area times scale."""


area = generic(Shape.area)


class Square(NamedTuple):
    side: float

    def area(self, scale):
        return scale * self.side * self.side


class Circle(NamedTuple):
    radius: float

    def area(self, scale):
        return scale * 3.0 * self.radius * self.radius


class Misnamed(NamedTuple):
    side: float

    def area(self, factor):
        return factor * self.side


class Mixed(NamedTuple):
    array: np.ndarray
    uniform: float
    count: int


class Nested(NamedTuple):
    mixed: Mixed
    array: np.ndarray


@kernel
def compiled_area(shape, scale):
    return area(shape, scale)


@kernel
def copy_nested(record, source, target):
    put(record, target, at(record, source))


@kernel
def sum_at(record, values):
    total = 0.0
    for p in range(values.size):
        one = at(record, p)
        total += one.array + 10.0 * one.uniform + 100.0 * one.count
    return total


@kernel
def double(record, count):
    for p in range(count):
        one = at(record, p)
        put(record, p, Mixed(2.0 * one.array, -1.0, -1))


@kernel
def double_part(record, first, last):
    piece = part(record, first, last)
    for p in range(piece.array.size):
        piece.array[p] = 2.0 * piece.array[p]
        piece.mixed.array[p] = piece.mixed.array[p] + piece.mixed.uniform
    return piece.array.size


@kernel
def part_of_nothing(record):
    return part(record, 0, 1)


@kernel
def put_nothing(record):
    put(record, 0, None)
    return at(record, 0)


@pytest.mark.parametrize("shape", [Square(2.0), Circle(2.0)])
def test_generic_function_calls_the_method_of_the_class(shape):
    expected = {Square: 20.0, Circle: 60.0}[type(shape)]
    assert area(shape, 5.0) == expected
    assert compiled_area(shape, 5.0) == expected


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="only the compiler looks at arguments' names")
def test_generic_function_refuses_a_class_that_breaks_the_protocol():
    with pytest.raises(numba.core.errors.TypingError):
        compiled_area(Misnamed(2.0), 5.0)
    with pytest.raises(numba.core.errors.TypingError):
        compiled_area(Mixed(np.zeros(1), 2.0, 3), 5.0)


def test_at_picks_from_arrays_and_passes_scalars_and_none():
    record = Mixed(np.array([1.0, 2.0, 3.0]), 0.5, 4)
    assert at(record, 1) == Mixed(2.0, 0.5, 4)
    assert sum_at(record, np.zeros(3)) == 6.0 + 3 * (5.0 + 400.0)
    assert at(None, 1) is None


@pytest.mark.parametrize("doubled", [double, getattr(double, "py_func", double)], ids=["compiled", "plain"])
def test_put_writes_into_arrays_and_leaves_the_rest(doubled):
    record = Mixed(np.array([1.0, 2.0, 3.0]), 0.5, 4)
    doubled(record, 2)
    assert record.array.tolist() == [2.0, 4.0, 3.0]
    assert (record.uniform, record.count) == (0.5, 4)


@pytest.mark.parametrize("copy", [copy_nested, getattr(copy_nested, "py_func", copy_nested)], ids=["compiled", "plain"])
def test_at_and_put_reach_arrays_in_records_and_tuples_within(copy):
    record = Nested(Mixed(np.array([1.0, 2.0]), 0.5, 7), np.array([10.0, 20.0]))
    copy(record, 1, 0)
    assert (record.mixed.array.tolist(), record.array.tolist()) == ([2.0, 2.0], [20.0, 20.0])
    pair = (np.array([1.0, 2.0]), np.array([3.0, 4.0]))
    copy(pair, 0, 1)
    assert [array.tolist() for array in pair] == [[1.0, 1.0], [3.0, 3.0]]


@pytest.mark.parametrize(
    "doubled", [double_part, getattr(double_part, "py_func", double_part)], ids=["compiled", "plain"]
)
def test_part_is_a_view_of_some_points_in_nested_records_too(doubled):
    record = Nested(Mixed(np.array([1.0, 2.0, 3.0, 4.0]), 0.5, 7), np.array([10.0, 20.0, 30.0, 40.0]))
    assert doubled(record, 1, 3) == 2
    assert record.array.tolist() == [10.0, 40.0, 60.0, 40.0]
    assert record.mixed.array.tolist() == [1.0, 2.5, 3.5, 4.0]


def test_part_passes_what_holds_no_arrays():
    assert part(Square(2.0), 0, 1) == Square(2.0)
    assert part(None, 0, 1) is None
    assert part_of_nothing(None) is None


@pytest.mark.parametrize("put_and_read", [put_nothing, getattr(put_nothing, "py_func", put_nothing)])
def test_put_into_none_writes_nothing(put_and_read):
    assert put_and_read(None) is None


def test_cache_folder_is_made_and_stays_the_same(tmp_path, monkeypatch):
    monkeypatch.setenv("RFMPM_CACHE", str(tmp_path / "cache"))
    folder = cache_folder()
    assert folder.parent == tmp_path / "cache"
    assert folder.is_dir()
    assert cache_folder() == folder
    assert list(folder.iterdir()) == []


def test_cache_folder_changes_with_a_switch_of_numba(tmp_path, monkeypatch):
    monkeypatch.setenv("RFMPM_CACHE", str(tmp_path))
    monkeypatch.delenv("NUMBA_BOUNDSCHECK", raising=False)
    names = [cache_folder().name]
    for value in ("0", "1"):
        monkeypatch.setenv("NUMBA_BOUNDSCHECK", value)
        names.append(cache_folder().name)
    monkeypatch.setenv("HOME_MADE", "1")
    assert len(set(names)) == 3
    assert cache_folder().name == names[-1]


def test_cache_folder_changes_with_a_source(tmp_path, monkeypatch):
    monkeypatch.setenv("RFMPM_CACHE", str(tmp_path))
    before = cache_folder()
    read = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: read(path) + (b"#" if path.name == "von_mises.py" else b""))
    assert cache_folder() != before


def test_cache_folder_moves_to_the_temporary_folder_where_it_cannot_be_written(tmp_path, monkeypatch):
    monkeypatch.setenv("RFMPM_CACHE", str(tmp_path))
    name = cache_folder().name
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("RFMPM_CACHE", str(tmp_path / "file"))
    folder = cache_folder()
    assert folder.name == name
    assert folder.is_relative_to(tempfile.gettempdir())
    assert not folder.is_relative_to(tmp_path / "file")
