"""Columns of numbers read from text files, and what is said of bad ones."""

import math

import pytest

from rfmpm.columns import ColumnsError, read_columns

NAMES = {"x": ("x_m", "x"), "value": ("value",), "error": ("error",)}


@pytest.fixture
def write(tmp_path):
    def written(text: str):
        path = tmp_path / "data.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return written


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_columns_in_any_order_with_comments_and_empty_lines(write, delimiter):
    text = "# boring 3\n\nValue,X_m,remark\n20.5,1,soft\n\n# more\n1e1, 2 ,\n".replace(",", delimiter)
    columns = read_columns(write(text), NAMES, optional=["error"])
    assert columns == {"x": [1.0, 2.0], "value": [20.5, 10.0]}
    assert columns.lines == [4, 7]


def test_an_optional_column_may_leave_cells_empty(write):
    columns = read_columns(write("x,value,error\n1,2,\n1,2,0.1\n"), NAMES, optional=["error"])
    assert math.isnan(columns["error"][0])
    assert columns["error"][1] == 0.1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("x,value\n", "no line of numbers"),
        ("x,cohesion\n1,2\n", "no column value; it has x, cohesion"),
        ("x,x_m,value\n1,2,3\n", "names x 2 times"),
        ("x,value\n1,nan\n", r"line 2: value = 'nan'"),
        ("x,value\n1,2\n\n1,inf\n", r"line 4: value = 'inf'"),
        ("x,value\n1,2 kPa\n", r"line 2: value = '2 kPa': must be a finite number"),
        ("x,value\n1\n", "line 2: value is empty"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(write, text, said):
    with pytest.raises(ColumnsError, match=said):
        read_columns(write(text), NAMES, optional=["error"])


def test_every_bad_line_is_named_up_to_a_number(write):
    with pytest.raises(ColumnsError) as caught:
        read_columns(write("x,value\n" + "a,b\n" * 30), NAMES, optional=["error"])
    assert len(caught.value.problems) == 21
    assert caught.value.problems[-1] == "and 40 more"
