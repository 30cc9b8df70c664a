"""Folders that hold something else are refused and not touched; torn files are put aside and their rows run again."""

from pathlib import Path

import pytest

from rfmpm import ensemble, results
from rfmpm.study import load_study

COARSE = Path(__file__).with_name("coarse.toml")


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def run(study, directory, realisations=4, **options):
    return ensemble.run(study, directory, realisations, workers=1, progress=False, **options)


def test_another_study_is_refused_and_named_and_nothing_is_changed(study, tmp_path):
    run(study, tmp_path)
    before = contents(tmp_path)
    other = study.with_changes({"material.0.residual_cohesion_kpa": 3.0, "study.name": "another name"})
    with pytest.raises(ensemble.FolderMismatch, match=r"material\.0\.residual_cohesion_kpa: 2\.0 -> 3\.0") as refusal:
        run(other, tmp_path)
    assert "study.name" not in str(refusal.value)  # a name is no physics
    assert contents(tmp_path) == before


def test_fresh_replaces_another_study(study, tmp_path):
    run(study, tmp_path)
    (tmp_path / "report.html").write_text("of the first study")
    (tmp_path / "snapshots").mkdir()
    (tmp_path / "snapshots" / "0.nc").write_text("of the first study")
    (tmp_path / "notes.txt").write_text("of the user")
    other = study.with_changes({"study.seed": 1})
    found = run(other, tmp_path, fresh=True)
    assert found.attrs["seed"] == 1
    assert not (tmp_path / "report.html").exists()
    assert not (tmp_path / "snapshots").exists()
    assert (tmp_path / "notes.txt").read_text() == "of the user"
    assert load_study(tmp_path / "study.toml").study.seed == 1


@pytest.mark.parametrize("fresh", [False, True])
@pytest.mark.parametrize("name", ["thesis.txt", "study.toml"])
def test_foreign_folder_is_refused_and_not_touched(study, tmp_path, name, fresh):
    (tmp_path / name).write_text("[somebody]\nelse = 1\n")
    before = contents(tmp_path)
    with pytest.raises(ensemble.FolderMismatch, match="choose another folder"):
        run(study, tmp_path, fresh=fresh)
    assert contents(tmp_path) == before
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_segments_of_somebody_else_are_not_touched(study, tmp_path):
    (tmp_path / "segments").mkdir()
    (tmp_path / "segments" / "route.nc").write_text("not ours")
    with pytest.raises(ensemble.FolderMismatch, match="choose another folder"):
        run(study, tmp_path)
    assert contents(tmp_path) == {"segments/route.nc": b"not ours"}


def test_folder_of_a_run_that_was_killed_as_it_began_is_taken(study, tmp_path):
    (tmp_path / "segments").mkdir()
    (tmp_path / ".lock").write_text("")
    assert run(study, tmp_path, 2).sizes["realisation"] == 2


def test_folder_below_a_file_cannot_be_written(study, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ensemble.FolderMismatch, match="cannot be written"):
        run(study, tmp_path / "file" / "results")


def test_file_in_the_place_of_the_folder_is_refused(study, tmp_path):
    (tmp_path / "file").write_text("kept")
    with pytest.raises(ensemble.FolderMismatch, match="is not a folder"):
        run(study, tmp_path / "file")
    assert (tmp_path / "file").read_text() == "kept"


def test_another_version_of_the_sources_is_refused_until_fresh(study, tmp_path, monkeypatch):
    first = run(study, tmp_path)
    monkeypatch.setattr(results, "source_hash", lambda: "0" * 64)
    with pytest.raises(ensemble.FolderMismatch, match="another version of the program"):
        run(study, tmp_path)
    monkeypatch.undo()
    assert results.content_hash(run(study, tmp_path)) == results.content_hash(first)


@pytest.mark.parametrize("damage", ["truncated", "empty", "flipped"])
def test_damaged_segment_is_put_aside_and_its_rows_run_again(study, tmp_path, damage):
    first = run(study, tmp_path)
    segment, *_ = (tmp_path / "segments").glob("*.rows")
    content = bytearray(segment.read_bytes())
    if damage == "flipped":
        content[len(content) // 2] ^= 1
    segment.write_bytes({"truncated": content[: len(content) // 2], "empty": b"", "flipped": content}[damage])
    again = run(study, tmp_path)
    assert results.content_hash(again) == results.content_hash(first)
    assert [path.name for path in (tmp_path / "quarantine").iterdir()] == [segment.name]
    assert not segment.exists()
    assert f'"quarantine", "segment": "{segment.name}"' in (tmp_path / "journal.jsonl").read_text()
    assert segment.name in (tmp_path / "rfmpm.log").read_text()


def test_a_segment_that_is_put_aside_is_said(study, tmp_path, capsys):
    run(study, tmp_path)
    segment, *_ = (tmp_path / "segments").glob("*.rows")
    segment.write_bytes(b"")
    ensemble.run(study, tmp_path, workers=1)
    assert f"rfmpm: {segment.name} is not valid and was moved to {tmp_path / 'quarantine'}" in capsys.readouterr().err
