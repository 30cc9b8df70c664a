from rfmpm.ensemble import folder


def test_differences_name_keys_that_only_one_study_has(study):
    other = study.with_changes({"material.0.softening_length_m": 1.0})
    assert folder.differences(study, other) == ["material.0.softening_length_m: absent -> 1.0"]


def test_failure_policy_is_no_difference(study):
    other = study.with_changes({"failures.action": "abort", "failures.realisation_time_limit_s": 3.0})
    assert folder.differences(study, other) == []
