"""The random field by itself: picture and table of asked and found statistics."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from synthetic import make_points, make_study

from rfmpm import realisation
from rfmpm.random_fields import field
from rfmpm.report import write_field


@pytest.fixture
def coarse(monkeypatch):
    """A scene of few points in place of the study's own, so that the field is quick."""

    def prepare(study):
        points = make_points(study, 0.0, spacing=0.5)
        places = np.column_stack([points["x_initial"], points["y_initial"]])
        prepared = field.prepare(study.random_field["cohesion"], 20e3, places)
        uppermost = SimpleNamespace(field=prepared, at_crest=prepared, points=places, mean=20e3)
        return SimpleNamespace(study=study, fields={"cohesion": SimpleNamespace(parts=[uppermost])})

    monkeypatch.setattr(realisation, "prepare", prepare)


@pytest.mark.usefixtures("coarse")
def test_table_compares_asked_and_found_and_the_picture_is_written(tmp_path):
    lines = write_field(make_study(), 3, tmp_path / "field")
    numbers = {line[:25].strip() + line[25:32].strip(): list(map(float, line[32:].split())) for line in lines[2:]}
    assert numbers["mean [kPa]"][0] == 20.0
    assert numbers["standard deviation [kPa]"][0] == 5.0
    assert numbers["correlation along h6.00"][0] == pytest.approx(np.exp(-2.0), abs=1e-4)  # printed to four places
    # statistical tolerance: 4 standard errors, as printed; found = asked + ratio x standard error up to rounding
    assert all(abs(ratio) < 4.0 for *_, ratio in numbers.values())
    for asked, found, error, ratio in numbers.values():
        assert found == pytest.approx(asked + ratio * error, abs=0.06 * error + 1e-3)
    assert len({len(line) for line in lines[1:]}) == 1
    with Image.open(tmp_path / "field" / "field.png") as image:
        image.verify()


def test_a_study_without_a_field_says_so(tmp_path):
    lines = write_field(make_study(random_field={}), 0, tmp_path)
    assert len(lines) == 1
    assert re.search("no random field", lines[0])
    assert list(tmp_path.iterdir()) == []
