"""Rows of the report of the factors: what is kept of an earlier run, and when."""

from types import SimpleNamespace

import numpy as np
import pytest

from rfmpm.benchmark.safety import fields
from rfmpm.benchmark.safety.fields import CHECKED, SCENES, Row, measure, read_rows, write_rows

COUNT = CHECKED + 5


@pytest.fixture
def simulated(monkeypatch):
    """Indices simulated, of fields whose displacement is a tenth of their index and whose factor is twice it."""
    done = []

    def simulate(prepared, index):
        done.append(index)
        points = {"displacement_x": np.array([0.1 * index]), "displacement_y": np.zeros(1)}
        return SimpleNamespace(
            points=points, quantities={"factor_of_safety": 2.0 * index, "failure_volume": 1.0, "run_out": 2.0}
        )

    monkeypatch.setattr(fields, "COUNT", COUNT)
    monkeypatch.setattr(fields, "COUNT_OF_OTHERS", 1)
    monkeypatch.setattr(fields, "prepare", lambda study: None)
    monkeypatch.setattr(fields, "simulate", simulate)
    monkeypatch.setattr(
        fields, "stability", lambda prepared, method, index: (SimpleNamespace(factor=2.0 * index), None)
    )
    return done


def kept(tmp_path, displacement):
    rows = [Row(scene, index, 9.0, displacement * index, 1.0, 2.0) for scene in SCENES for index in range(COUNT)]
    write_rows(rows, tmp_path / "rows.csv")
    assert list(read_rows(tmp_path / "rows.csv").values()) == [
        row._replace(displacement=float(f"{row.displacement:.6g}")) for row in rows
    ]
    return tmp_path / "rows.csv"


def test_displacements_that_are_the_same_are_kept_with_new_factors(tmp_path, simulated):
    rows, taken = measure(False, lambda line: None, kept(tmp_path, 0.1))
    assert simulated == [0, CHECKED, 0, 0, 0]
    assert taken == COUNT - 2
    assert [row.factor for row in rows[:COUNT]] == [2.0 * index for index in range(COUNT)]
    assert [row.displacement for row in rows[:COUNT]] == pytest.approx([0.1 * index for index in range(COUNT)])


def test_all_are_simulated_where_one_came_out_otherwise(tmp_path, simulated):
    rows, taken = measure(False, lambda line: None, kept(tmp_path, 0.2))
    assert taken == 0
    assert sorted(simulated[: -len(SCENES) + 1]) == list(range(COUNT))
    assert rows[COUNT - 1].displacement == pytest.approx(0.1 * (COUNT - 1))


def test_all_are_simulated_where_none_is_kept(tmp_path, simulated):
    _, taken = measure(False, lambda line: None, tmp_path / "rows.csv")
    assert taken == 0
    assert len(simulated) == COUNT + len(SCENES) - 1
