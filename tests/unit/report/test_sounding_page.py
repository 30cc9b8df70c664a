"""`rfmpm sounding`: table, study table and picture of a sounding."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from rfmpm.cli import app
from rfmpm.report.sounding_page import write_sounding
from rfmpm.study import load_study

RANDOM = Path(__file__).parents[3] / "configs" / "short_slope_random.toml"


@pytest.fixture
def sounding(tmp_path):
    depth = np.arange(0.05, 10.0, 0.1)
    z = np.zeros(len(depth))
    noise = np.random.default_rng(3).standard_normal(len(depth))
    keep = np.exp(-2.0 * 0.1 / 0.5)  # Markov, theta 0.5 m
    for k in range(1, len(depth)):
        z[k] = keep * z[k - 1] + np.sqrt(1.0 - keep**2) * noise[k]
    path = tmp_path / "cpt.csv"
    rows = (f"{d:.3f},{20.0 * np.exp(0.25 * value):.4f}\n" for d, value in zip(depth, z, strict=True))
    path.write_text("depth_m,value_kpa\n" + "".join(rows), encoding="utf-8")
    return path


def test_the_study_table_can_be_put_into_a_study(sounding, tmp_path):
    lines = write_sounding(sounding, tmp_path / "out")
    table = tomllib.loads("\n".join(lines[lines.index("") + 1 :]))["random_field"]["cohesion"]
    study = load_study(RANDOM).with_changes({f"random_field.cohesion.{key}": value for key, value in table.items()})
    field = study.random_field["cohesion"]
    assert "scale_of_fluctuation_h_m" not in table  # nothing is made up: the user must say it
    assert 0.2 < field.scale_of_fluctuation_v_m < 1.5  # the interval of a sounding of 20 theta, roughly
    assert 0.15 < field.coefficient_of_variation < 0.4
    with Image.open(tmp_path / "out" / "sounding.png") as image:
        image.verify()


def test_a_factor_scales_the_mean_alone(sounding, tmp_path):
    first, other = (write_sounding(sounding, tmp_path, factor) for factor in (1.0, 0.1))
    assert [a for a, b in zip(first, other, strict=True) if a != b] == [
        line for line in first if line.startswith(("mean", "material"))
    ]


def test_the_command_prints_and_says_where_the_picture_is(sounding, tmp_path):
    result = CliRunner().invoke(app, ["sounding", str(sounding), "--out", str(tmp_path / "out")])
    assert result.exit_code == 0
    assert "[random_field.cohesion]" in result.stdout
    assert result.stdout.splitlines()[-1] == str(tmp_path / "out" / "sounding.png")


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [("none.csv", None, "No such file"), ("bad.csv", "depth,value\n1,x\n", "line 2"), ("a.gef", "#", "pygef")],
)
def test_what_cannot_be_read_ends_in_words(tmp_path, monkeypatch, name, text, said):
    monkeypatch.setitem(__import__("sys").modules, "pygef", None)
    if text is not None:
        (tmp_path / name).write_text(text, encoding="utf-8")
    result = CliRunner().invoke(app, ["sounding", str(tmp_path / name), "--out", str(tmp_path / "out")])
    assert result.exit_code == 2
    assert said in result.stderr
