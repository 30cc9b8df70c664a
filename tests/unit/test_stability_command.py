"""`rfmpm stability`: what it prints, where its picture goes, what it refuses."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rfmpm import realisation
from rfmpm.cli import app
from rfmpm.stability import METHODS, Critical
from rfmpm.study import load_study

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"


def call(tmp_path, *arguments):
    return CliRunner().invoke(app, ["stability", *map(str, arguments), "--out", str(tmp_path / "out")])


def factor_in(text):
    return float(re.search(r"factor of safety +([0-9.]+)", text)[1])


def test_it_says_factor_surface_and_time_after_the_picture(tmp_path):
    result = call(tmp_path, COARSE, "--index", 2)
    assert result.exit_code == 0
    lines = result.output.splitlines()
    assert Path(lines[0]).is_file()
    assert "bishop, realisation 2" in lines[1]
    assert [line.split("  ")[0] for line in lines[2:]] == [
        "factor of safety",
        "slip surface",
        "enters at",
        "leaves at",
        "lowest point",
        "time, compiling included",
    ]


def test_it_says_the_column_of_the_campaign(tmp_path):
    study = load_study(COARSE).with_changes({"quantities.factor_of_safety": True})
    row = realisation.run(realisation.prepare(study), 2)
    found = factor_in(call(tmp_path, COARSE, "--index", 2).output)
    assert found == pytest.approx(row["factor_of_safety"], abs=5.1e-5)  # printed to four decimals


def test_a_homogeneous_slope_has_no_realisation(tmp_path):
    assert "homogeneous" in call(tmp_path, COARSE, "--homogeneous").output


def test_an_unknown_method_is_refused_with_the_choices(tmp_path):
    result = call(tmp_path, COARSE, "--method", "fellenius")
    assert result.exit_code == 2
    assert "--method fellenius: must be one of bishop, spencer, morgenstern_price" in result.output
    assert not (tmp_path / "out").exists()


def test_a_method_without_a_solution_says_so(tmp_path, monkeypatch):
    monkeypatch.setitem(METHODS, "spencer", lambda prepared, fields: Critical(float("inf"), "", None))
    result = call(tmp_path, COARSE, "--method", "spencer")
    assert result.exit_code == 3
    assert "spencer has no solution on any surface" in result.output


def test_an_elastic_soil_is_refused(tmp_path):
    text = COARSE.read_text(encoding="utf-8").replace('law = "von_mises"', 'law = "elastic"')
    text = re.sub(r"(?m)^(cohesion|residual|softening).*\n", "", text)
    text = re.sub(r"(?s)\[random_field\.cohesion\].*?\n\n", "", text)
    path = tmp_path / "elastic.toml"
    path.write_text(text, encoding="utf-8")
    result = call(tmp_path, path)
    assert result.exit_code == 2
    assert "has no strength" in result.output
