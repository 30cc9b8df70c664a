"""The commands end with a report, whatever the machine's figures are."""

import pytest
from typer.testing import CliRunner

from rfmpm.cli import app

REPORTS = {
    "stability": ["Will an odd soil break it?", "What failed", "stability_softening.png"],
    "slope": ["How wrong is the run-out", "softening averaged half as often", "over a length, and viscosity"],
    "verification": ["sliding block on an incline", "axial vibration of an elastic bar: phase"],
    "fields": ["| circulant |", "| ar1 |", "Asked: at most 30 ms"],
    "safety": ["| 45 degrees, base at 1 H | Taylor (1937) |", "safety_rows.csv", "base holds, strength stays"],
    "savings": ["grid cells that no point touches", "imports that `rfmpm check` does not use"],
}
FILES = {"slope": "slope_error"}


@pytest.mark.slow
@pytest.mark.timeout(1500)  # many kernels to compile
@pytest.mark.parametrize("name", REPORTS)
def test_quick_benchmark_writes_its_report(tmp_path, name):
    result = CliRunner().invoke(app, ["benchmark", name, "--quick", "--out", str(tmp_path)])
    assert result.exit_code == 0
    text = (tmp_path / f"{FILES.get(name, name)}.md").read_text(encoding="utf-8")
    assert all(part in text for part in REPORTS[name])
    assert all((tmp_path / line.split("(")[1].rstrip(")")).is_file() for line in text.splitlines() if line[:2] == "![")
