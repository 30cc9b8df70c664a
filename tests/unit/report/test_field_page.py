"""The random field by itself: picture and table of asked and found statistics."""

import re

import numpy as np
import pytest
from PIL import Image
from synthetic import make_study

from rfmpm import load_study, realisation
from rfmpm.report import data_picture, field_page, write_field


@pytest.fixture
def words_only(monkeypatch):
    """Draw nothing: a picture takes longer than the words."""
    monkeypatch.setattr(field_page, "draw_field", lambda *arguments: None)


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


LAYERS = [
    {"top_m": 3.5, "dip_deg": -4.0, "mean_kpa": 35.0, "coefficient_of_variation": 0.1},
    {"top_m": 1.0, "mean_kpa": 12.0},
]


def test_every_soil_has_a_table_of_its_own_under_the_path_of_its_settings(tmp_path, words_only):
    study = make_study(**{"random_field.cohesion.layer": LAYERS, "discretisation.cell_m": 0.5})
    lines = write_field(study, 0, tmp_path)
    heads = [k for k, line in enumerate(lines) if line.startswith("cohesion, ")]
    words = [lines[k].split(":")[0] for k in heads]
    assert words == [
        "cohesion, soil above the layers (random_field.cohesion)",
        "cohesion, layer 0 (random_field.cohesion.layer.0)",
        "cohesion, layer 1 (random_field.cohesion.layer.1)",
    ]
    asked = [("20.0000", "5.0000"), ("35.0000", "3.5000"), ("12.0000", "3.0000")]
    for (mean, deviation), start, end in zip(asked, heads, [*heads[1:], len(lines)], strict=True):
        numbers = numbers_of(lines[start:end])
        assert (numbers["mean [kPa]"][0], numbers["standard deviation [kPa]"][0]) == (float(mean), float(deviation))
        assert all(abs(ratio) < 4.0 for *_, ratio in numbers.values())  # standard errors


@pytest.mark.parametrize("reference", [None, 0.25])
def test_layers_with_data_are_all_drawn_and_their_data_counted(tmp_path, monkeypatch, reference):
    drawn = []
    monkeypatch.setattr(data_picture, "_draw_maps", lambda figure, grid, body, *rest: drawn.append(body))
    data = [{"x_m": 3.0, "y_m": y, "value": value} for y, value in ((4.6, 18.0), (4.1, 22.0), (2.0, 34.0), (0.4, 11.0))]
    study = make_study(**{"random_field.cohesion.layer": LAYERS, "discretisation.cell_m": 0.5})
    keys = {"random_field.cohesion.data": data, "random_field.cohesion.reference_cell_m": reference}
    lines = write_field(study.with_changes(keys), 0, tmp_path)
    counts = [line.split()[2] for line in lines if line.startswith("conditioned on")]
    assert counts == ["2", "1", "1"]
    (body,) = drawn
    np.testing.assert_array_equal(np.sort(body.values), [11.0, 18.0, 22.0, 34.0])
    assert np.all(np.isfinite([body.mean, body.deviation, *body.sample]))
    # On the whole body: a mean for each soil, none far from what was asked or measured there.
    for height, mean in ((4.3, 20.0), (2.2, 35.0), (0.5, 12.0)):
        there = np.abs(body.points[:, 1] - height) < 0.3
        assert np.mean(body.mean[there]) == pytest.approx(mean, rel=0.1)  # data are within 0.1 of the mean
    points = realisation.prepare(study).scene.points.position[0]
    assert len(body.points) == len(points) * (1 if reference is None else 4)


def drained(**changes):
    return load_study("configs/drained_cross_correlated.toml").with_changes({"discretisation.cell_m": 1.0} | changes)


def test_every_material_has_the_statistics_of_its_own_field_and_a_picture(tmp_path):
    lines = write_field(load_study("configs/layered_slope.toml"), 0, tmp_path)
    heads = [k for k, line in enumerate(lines) if ": method " in line]
    assert [lines[k].split(":")[0] for k in heads] == ["cohesion of clay", "cohesion of stiff clay"]
    asked = [("17.0000", "4.2500"), ("60.0000", "24.0000")]
    for (mean, deviation), start, end in zip(asked, heads, [heads[1], len(lines)], strict=True):
        numbers = numbers_of(lines[start:end])
        assert (numbers["mean [kPa]"][0], numbers["standard deviation [kPa]"][0]) == (float(mean), float(deviation))
        assert all(abs(ratio) < 4.0 for *_, ratio in numbers.values())  # standard errors
    pictures = sorted(path.name for path in tmp_path.iterdir())
    assert pictures == ["field.png", "field_cohesion_of_material_1.png"]


def test_a_shared_field_is_that_of_the_first_material(tmp_path, words_only):
    study = load_study("configs/layered_slope.toml")
    shared = study.material[0].random_field["cohesion"].model_dump(exclude_unset=True)
    shared |= {"material": "clay", "shared_with": ["stiff clay"]}
    none = {"material.0.random_field": None, "material.1.random_field": None}
    lines = write_field(study.with_changes({"random_field.cohesion": shared} | none), 0, tmp_path)
    numbers = numbers_of(lines)
    assert numbers["mean [kPa]"][0] == 17.0
    assert all(abs(ratio) < 4.0 for *_, ratio in numbers.values())  # standard errors
    assert any(line.endswith("first material; in the others all is in proportion to the mean") for line in lines)


def test_correlated_properties_are_compared_with_each_other_and_after_they_are_mixed(tmp_path, words_only):
    lines = write_field(drained(), 0, tmp_path)
    row = next(k for k, line in enumerate(lines) if line.startswith("cohesion with tangent of the angle of friction"))
    (name, numbers), *_ = numbers_of(lines[row:]).items()
    assert name == "correlation at a point"
    assert numbers[0] == -0.5
    assert abs(numbers[-1]) < 4.0  # standard errors
    assert "the statistics are those of the field after it is mixed with the earlier one" in lines


def test_no_title_is_cut(tmp_path):
    write_field(drained(), 0, tmp_path)
    for name in ("field.png", "field_friction_angle.png"):
        with Image.open(tmp_path / name) as image:
            top = np.asarray(image.convert("L"))[:3]
        assert np.all(top == 255)  # the frame of the page; a cut title reaches the first row


def test_what_the_method_is_known_to_miss_is_said(tmp_path, words_only):
    plain = make_study(**{"discretisation.cell_m": 0.5})
    study = plain.with_changes({"random_field.cohesion.method": "karhunen_loeve"})
    lines = write_field(study, 0, tmp_path / "rough")
    (line,) = (line for line in lines if "is approximate" in line)
    found = re.search(r"up to (\S+), or (\S+) of these standard errors", line).groups()
    least = min(error for name, (*_, error, _) in numbers_of(lines).items() if name.startswith("correlation"))
    assert float(found[1]) == pytest.approx(float(found[0]) / least, rel=0.02)  # both printed to two or four places
    assert not [line for line in write_field(plain, 0, tmp_path) if "is approximate" in line]


def test_means_that_material_points_take_are_compared_too(tmp_path, words_only):
    study = make_study(**{"random_field.cohesion.reference_cell_m": 0.125, "discretisation.cell_m": 0.5})
    lines = write_field(study, 0, tmp_path)
    k = lines.index("the means over 16 reference points that material points take")
    mean, deviation = (list(map(float, line[33:].split())) for line in lines[k + 1 : k + 3])
    assert (mean[0], abs(mean[-1]) < 4.0) == (20.0, True)
    assert (deviation[0] < 5.0, abs(deviation[-1]) < 4.0) == (True, True)


def test_a_study_without_a_field_says_so(tmp_path):
    lines = write_field(make_study(random_field={}), 0, tmp_path)
    assert len(lines) == 1
    assert re.search("no random field", lines[0])
    assert list(tmp_path.iterdir()) == []
