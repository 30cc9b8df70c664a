from rfmpm.ensemble import folder


def test_differences_name_keys_that_only_one_study_has(study):
    text = study.to_toml().replace("surface_bin_m = 1.0\n", "")
    other = folder.load_study(text)
    assert folder.differences(study, other) == ["output.surface_bin_m: 1.0 -> absent"]


def test_failure_policy_is_no_difference(study):
    other = study.with_changes({"failures.action": "abort", "failures.realisation_time_limit_s": 3.0})
    assert folder.differences(study, other) == []
