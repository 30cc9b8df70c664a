from contextlib import contextmanager

import pytest

from rfmpm.ensemble import folder


def test_differences_name_keys_that_only_one_study_has(study):
    other = study.with_changes({"material.0.softening_length_m": 1.0})
    assert folder.differences(study, other) == ["material.0.softening_length_m: absent -> 1.0"]


def test_failure_policy_is_no_difference(study):
    other = study.with_changes({"failures.action": "abort", "failures.realisation_time_limit_s": 3.0})
    assert folder.differences(study, other) == []


def test_a_folder_that_another_study_took_before_it_was_locked_is_left_alone(study, tmp_path, monkeypatch):
    other = study.with_changes({"study.seed": study.study.seed + 1})

    @contextmanager
    def locked_late(directory, _):
        (directory / folder.STUDY_FILE).write_text(other.to_toml())
        yield

    monkeypatch.setattr(folder, "locked", locked_late)
    with pytest.raises(folder.FolderMismatch, match=r"study\.seed"), folder.opened(tmp_path, study, fresh=False):
        pass
    assert (tmp_path / folder.STUDY_FILE).read_text() == other.to_toml()
