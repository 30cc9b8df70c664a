"""Measured values in a study: read from a file when it is loaded, part of its physics, and refused in words."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from rfmpm import realisation
from rfmpm.study import StudyError, load_study

RANDOM = Path(__file__).parents[2] / "configs" / "short_slope_random.toml"
KEY = "random_field.cohesion"


@pytest.fixture
def write(tmp_path):
    """A study file beside a file of data, and its path."""

    def written(data: str, keys: str = 'data_file = "borings.csv"'):
        (tmp_path / "borings.csv").write_text(data, encoding="utf-8")
        text = RANDOM.read_text(encoding="utf-8").replace('method = "cholesky"', f'method = "cholesky"\n{keys}')
        path = tmp_path / "study.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return written


def problems_of(path) -> list[str]:
    with pytest.raises(StudyError) as refusal:
        load_study(path)
    return refusal.value.problems


def test_the_file_beside_the_study_becomes_its_data(write):
    study = load_study(write("x_m,y_m,value_kpa,measurement_error\n1,2,18,\n3,2.5,22.5,0.1\n"))
    field = study.random_field["cohesion"]
    assert field.data_file is None
    assert [(d.x_m, d.y_m, d.value, d.measurement_error) for d in field.data] == [
        (1.0, 2.0, 18.0, None),
        (3.0, 2.5, 22.5, 0.1),
    ]


def test_the_study_written_out_holds_the_data_and_not_the_file(write):
    path = write("x,y,value\n1,2,18\n")
    study = load_study(path)
    (path.parent / "borings.csv").unlink()
    assert load_study(study.to_toml()) == study
    assert load_study(study.to_toml()).physics_hash == study.physics_hash


def test_the_content_of_the_file_is_part_of_the_physics_and_its_name_is_not(write):
    first = load_study(write("x,y,value\n1,2,18\n")).physics_hash
    assert load_study(write("x,y,value\n# again\n1,2,18.0\n")).physics_hash == first
    assert load_study(write("x,y,value\n1,2,18.5\n")).physics_hash != first
    assert load_study(RANDOM).physics_hash != first


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ("x,y,value\n1,2,abc\n", "line 2: value = 'abc'"),
        ("x,y,value\n1,2,18\n1,nan,18\n", "line 3: y = 'nan'"),
        ("x,value\n1,2\n", "no column y_m or y"),
        ("x,y,value\n1,2,0\n", "line 2: value = 0: must be greater than 0"),
        ("x,y,value,measurement_error\n1,2,9,-1\n", "line 2: measurement_error = -1"),
        ("x,y,value\n1,2,18\n4,4,18\n1,2,19\n", "line 2 and line 4 contradict each other: 18 and 19"),
    ],
)
def test_a_bad_line_is_named(write, data, said):
    (problem,) = problems_of(write(data))
    assert problem.startswith(f'{KEY}.data_file = "borings.csv": ')
    assert said in problem


def test_a_missing_file_and_another_mistake_are_said_together(write):
    problems = problems_of(write("", 'data_file = "none.csv"\nmeasurement_error = -1'))
    assert len(problems) == 2
    assert "none.csv" in problems[0]
    assert "No such file" in problems[0]
    assert problems[1].startswith(f"{KEY}.measurement_error")


def test_contradictions_in_the_study_itself_are_named_by_position():
    tables = tomllib.loads(RANDOM.read_text(encoding="utf-8"))
    tables["random_field"]["cohesion"]["data"] = [{"x_m": 1, "y_m": 1, "value": v} for v in (18, 18, 20)]
    problems = problems_of(tables)
    assert len(problems) == 2  # the third with each of the first two
    assert problems[0].startswith(f"{KEY}.data.")
    tables["random_field"]["cohesion"]["measurement_error"] = 0.1
    assert len(load_study(tables).random_field["cohesion"].data) == 3


def test_a_file_named_in_a_change_says_what_to_do():
    with pytest.raises(StudyError, match="use load_study"):
        load_study(RANDOM).with_changes({f"{KEY}.data_file": "borings.csv"})


def test_realisations_pass_through_the_data_on_points():
    study = load_study(RANDOM).with_changes({"discretisation.cell_m": 1.0, "material.0.softening_length_m": 1.0})
    x, y = realisation.prepare(study).scene.points.position
    data = [{"x_m": float(x[k]), "y_m": float(y[k]), "value": 20.0 + 0.1 * k} for k in (0, 30, 77)]
    conditioned = study.with_changes({f"{KEY}.data": data})
    for index in range(3):
        cohesion = realisation.realise_fields(conditioned, index)["cohesion"]
        np.testing.assert_allclose(cohesion[[0, 30, 77]], [20e3, 23e3, 27.7e3], rtol=1e-9)


def test_data_that_only_the_field_can_tell_to_be_impossible_are_refused_in_the_units_of_the_study():
    study = load_study(RANDOM).with_changes({"discretisation.cell_m": 1.0, "material.0.softening_length_m": 1.0})
    below = [{"x_m": 9.0, "y_m": 4.0, "value": 20.0}, {"x_m": 1.0, "y_m": 1.0, "value": 5000.0}]
    layer = [{"top_m": 2.0, "mean_kpa": 30.0}]
    wrong = study.with_changes({f"{KEY}.data": below, f"{KEY}.layer": layer, f"{KEY}.distribution": "gamma"})
    said = rf"{KEY}: layer\.0: data\.1 \(x_m = 1, y_m = 1, value = 5000\) lies outside .* to 1\d\d\.\d kPa there"
    with pytest.raises(StudyError, match=said):
        realisation.prepare(wrong)
