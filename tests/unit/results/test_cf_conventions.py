"""Result files pass a checker of the CF conventions (pip install compliance-checker), where one is installed."""

import json

import numpy as np
import pytest

from rfmpm import realisation, results

runner = pytest.importorskip("compliance_checker.runner")

# Of a dimension called time the checker wants the standard name "time", and of that name the units "seconds since" a
# date; a model time has none.
NO_CALENDAR = "Coordinate variable 'time' should have standard_name='time'"


@pytest.fixture(scope="module")
def prepared(study):
    return realisation.prepare(study)


def errors(path):
    """What the checker holds for errors."""
    runner.CheckSuite.load_all_available_checkers()
    report = path.with_suffix(".json")
    runner.ComplianceChecker.run_checker(
        str(path), ["cf:1.11"], verbose=0, criteria="normal", output_filename=str(report), output_format="json"
    )
    (found,) = json.loads(report.read_text()).values()
    assert found["scored_points"] > 100  # or nothing was checked
    return {message for entry in found["high_priorities"] for message in entry["msgs"]}


def test_ensemble_has_no_errors(study, prepared, tmp_path):
    block = results.columns([realisation.run(prepared, 0)], study) | {"origin": np.zeros(1, "int32")}
    results.write_ensemble(tmp_path / "ensemble.nc", study, 1, [block], {"origins": "0: here"})
    assert errors(tmp_path / "ensemble.nc") == set()


def test_simulation_has_no_errors_but_that_its_time_has_no_calendar(study, prepared, tmp_path):
    outcome = realisation.simulate(prepared, 0, frames=3)
    results.write_simulation(tmp_path / "simulation.nc", outcome, study)
    assert all(message.startswith(NO_CALENDAR) for message in errors(tmp_path / "simulation.nc"))
