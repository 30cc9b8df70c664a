import math
import re
from pathlib import Path

import pytest

from rfmpm.study import load_study
from rfmpm.variables import (
    COORDINATES,
    FAILED,
    HISTORY_VARIABLES,
    POINT_VARIABLES,
    STATUS,
    VARIABLES,
    active_variables,
    failed_row,
)

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"
TABLES = (VARIABLES, COORDINATES, POINT_VARIABLES, HISTORY_VARIABLES)
UNIT = re.compile(r"1|rad|(kg|m|s|J|N|Pa)-?\d*( (kg|m|s)-?\d*)*")
OF_MANY_UNITS = ("uncertain_value",)  # each in that of its key
# By a study with the tables for it.
ASKED_FOR = {"uncertain_value", "factor_of_safety", "impact_force_peak", "out_of_balance"}
CONTRACT = {
    "run_out": "m", "retrogression_distance": "m", "retrogression_censored": "", "failure_volume": "m3 m-1",
    "initial_failure_volume": "m3 m-1", "influence_distance": "m", "block_count": "1", "status": "",
    "time_at_rest": "s", "step_count": "1", "wall_time": "s", "energy_balance_error": "1", "final_surface": "m",
}  # fmt: skip


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


def test_names_and_units_that_others_rely_on():
    assert {name: VARIABLES[name].unit for name in CONTRACT} == CONTRACT


@pytest.mark.parametrize("table", TABLES)
def test_every_entry_is_labelled(table):
    for name, variable in table.items():
        assert variable.name == name
        assert variable.long_name
        is_flag_or_text = "flag_values" in variable.attributes or variable.dtype == "str" or name in OF_MANY_UNITS
        assert (variable.unit == "") == is_flag_or_text
        assert is_flag_or_text or UNIT.fullmatch(variable.unit)


@pytest.mark.parametrize("name", VARIABLES)
def test_every_quantity_is_defined_with_the_settings_used(name, study):
    changed = study.with_changes({"quantities.displacement_threshold_m": 0.75})
    text = VARIABLES[name].attributes["comment"].format(study=changed)
    assert text.endswith(".")
    assert "{" not in text
    assert ("0.75 m" in text) == ("displacement_threshold_m" in VARIABLES[name].attributes["comment"])


def test_flags_have_one_meaning_each():
    for variable in VARIABLES.values():
        if "flag_values" in variable.attributes:
            assert len(variable.attributes["flag_values"]) == len(variable.attributes["flag_meanings"].split())
    assert set(STATUS) >= FAILED
    assert len(set(STATUS.values())) == len(STATUS)


def test_surface_is_active_only_where_asked_for(study):
    without = load_study(study.to_toml().replace("surface_bin_m = 1.0\n", ""))
    assert {variable.name for variable in active_variables(study)} == set(VARIABLES) - ASKED_FOR
    assert {variable.name for variable in active_variables(without)} == set(VARIABLES) - ASKED_FOR - {"final_surface"}


def test_failed_row_has_every_active_variable_and_no_quantity(study):
    row = failed_row(study, 3, "crashed", "why", wall_time=2.0)
    assert row.pop("realisation") == 3
    assert row.pop("level") == 0
    assert (row.pop("status"), row.pop("status_reason"), row.pop("wall_time")) == (STATUS["crashed"], "why", 2.0)
    assert set(row) == set(VARIABLES) - ASKED_FOR - {"status", "status_reason", "wall_time"}
    assert all(math.isnan(value) for value in row.values())


@pytest.mark.parametrize("status", ["ok", "not_at_rest", "unheard_of"])
def test_failed_row_is_for_failures_only(study, status):
    with pytest.raises(ValueError, match=status):
        failed_row(study, 0, status, "")
