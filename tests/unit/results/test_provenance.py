import shutil
from pathlib import Path

import pytest

import rfmpm
from rfmpm.results import provenance


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """A copy of the package's sources whose hash can be taken."""
    package = tmp_path / "rfmpm"
    shutil.copytree(Path(rfmpm.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(provenance, "__file__", str(package / "results" / "provenance.py"))
    return package


def current():
    return provenance.source_hash.__wrapped__()


def test_hash_depends_on_the_sources_that_decide_a_row(copy):
    before = current()
    for name in ("seeds.py", "realisation.py", "mpm/laws/von_mises.py", "kernel_tools/jit.py"):
        path = copy / name
        original = path.read_bytes()
        path.write_bytes(original + b"\n")
        assert current() != before, name
        path.write_bytes(original)
    assert current() == before


def test_hash_does_not_depend_on_others_or_on_the_place(copy):
    assert current() == provenance.source_hash()
    (copy / "report" / "new.py").write_text("x = 1\n")
    (copy / "mpm" / "notes.txt").write_text("not a source")
    assert current() == provenance.source_hash()


def test_moving_a_source_changes_the_hash(copy):
    before = current()
    (copy / "mpm" / "state.py").rename(copy / "mpm" / "states.py")
    assert current() != before


def test_versions_name_the_libraries():
    assert {"rfmpm", "python", "numpy", "numba"} <= set(provenance.versions())
