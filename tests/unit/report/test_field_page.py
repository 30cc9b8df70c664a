"""The random field by itself: picture and table of asked and found statistics."""

import re

import numpy as np
import pytest
from PIL import Image
from synthetic import make_study

from rfmpm import realisation
from rfmpm.report import write_field


def numbers_of(lines: list[str]) -> dict[str, list[float]]:
    """Asked, found, standard error and their ratio by name and lag; rows are as wide as their header."""
    header = next(k for k, line in enumerate(lines) if "std. error" in line)
    rows = [line for line in lines[header + 1 :] if len(line) == len(lines[header])]
    return {line[:26].strip() + line[26:33].strip(): list(map(float, line[33:].split())) for line in rows}


def test_table_compares_asked_and_found_and_the_picture_is_written(tmp_path):
    lines = write_field(make_study(), 3, tmp_path / "field")
    numbers = numbers_of(lines)
    assert len(numbers) > 10
    assert numbers["mean [kPa]"][0] == 20.0
    assert numbers["standard deviation [kPa]"][0] == 5.0
    assert numbers["correlation along h6.00"][0] == pytest.approx(np.exp(-2.0), abs=1e-4)  # printed to four places
    # statistical tolerance: 4 standard errors, as printed; found = asked + ratio x standard error up to rounding
    assert all(abs(ratio) < 4.0 for *_, ratio in numbers.values())
    for asked, found, error, ratio in numbers.values():
        assert found == pytest.approx(asked + ratio * error, abs=0.06 * error + 1e-3)
    assert "cohesion: method ar1, " in lines[0]  # a separable Markov correlation on a lattice
    assert lines[-1] == str(tmp_path / "field" / "field.png")
    with Image.open(tmp_path / "field" / "field.png") as image:
        image.verify()


def test_a_field_with_data_is_compared_with_the_conditional_distribution(tmp_path):
    plain = make_study()
    x, y = realisation.prepare(plain).scene.points.position
    on = range(0, len(x), 40)
    data = [{"x_m": float(x[k]), "y_m": float(y[k]), "value": 15.0 + 0.01 * k} for k in on]
    data += [{"x_m": 3.1, "y_m": 2.2, "value": 25.0, "measurement_error": 0.1}, {"x_m": 1e4, "y_m": 0.0, "value": 20.0}]
    study = plain.with_changes({"random_field.cohesion.data": data})
    lines = write_field(study, 0, tmp_path)
    numbers = numbers_of(lines)
    assert any(name.startswith("conditional cov. along v") for name in numbers)
    assert all(abs(ratio) < 4.0 for *_, ratio in numbers.values())  # standard errors
    assert f"conditioned on {len(data)} data, {len(data) - 1} of them exact, {len(on)} on points" in "\n".join(lines)
    misfit = float(re.search(r"misfit at exact data on points (\S+),", lines[-2]).group(1))
    assert misfit < 1e-9
    with Image.open(tmp_path / "field.png") as image:
        image.verify()


def test_a_study_without_a_field_says_so(tmp_path):
    lines = write_field(make_study(random_field={}), 0, tmp_path)
    assert len(lines) == 1
    assert re.search("no random field", lines[0])
    assert list(tmp_path.iterdir()) == []
