"""The report of run time against error: its arithmetic, and a small run from the command line."""

from math import nan

import pytest
from typer.testing import CliRunner

from rfmpm.benchmark.engine import document, figures
from rfmpm.benchmark.engine.runs import Measurement
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.cli import app


def measurement(cpu_time, error, cell=1.0):
    return Measurement("column", Scheme("quadratic_bspline"), cell, cpu_time, {"stress": error})


def test_front_is_what_nothing_beats():
    best = measurement(1.0, 0.5), measurement(2.0, 0.1), measurement(4.0, 0.05)
    beaten = measurement(3.0, 0.2), measurement(1.0, 0.6), measurement(0.1, nan)
    assert figures.front([*beaten, *reversed(best)], "stress") == list(best)


def test_ranking_is_over_the_default_on_the_same_cells():
    other = Scheme("cubic_bspline")
    ones = [measurement(1.0, 0.2), measurement(4.0, 0.1, cell=0.5)]
    ones += [Measurement("column", other, cell, t, {"stress": e}) for cell, t, e in ((1.0, 2.0, 0.1), (0.5, 8.0, 0.05))]
    ones.append(Measurement("column", other, 0.25, 8.0, {"stress": 0.01}))  # the default was not run on these
    last = document._ranking(ones).splitlines()[-1]
    assert last == "| cubic B-spline, FLIP + FMPM(2) in 5 s, MUSL | 0.5 | 2 |"


@pytest.mark.slow
@pytest.mark.timeout(1500)  # it compiles every shape with every transfer
def test_quick_run_writes_report_pictures_and_table(tmp_path):
    done = CliRunner().invoke(app, ["benchmark", "engine", "--quick", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    text = (tmp_path / "run_time_against_error.md").read_text(encoding="utf-8")
    rows = (tmp_path / "run_time_against_error.csv").read_text(encoding="utf-8").splitlines()
    for scene in ("column", "bar", "vortex", "slope"):
        assert f"(run_time_against_error_{scene}.png)" in text
        assert (tmp_path / f"run_time_against_error_{scene}.png").stat().st_size > 10_000
        assert any(row.startswith(f"{scene},") for row in rows)
    assert "| production engine: quadratic B-spline" in text
