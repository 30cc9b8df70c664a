"""The picture of a set-up is written for every kind of geometry."""

from pathlib import Path

import pytest

from rfmpm.report import write_setup_picture
from rfmpm.study import load_study

CONFIGS = Path(__file__).parents[3] / "configs"
BLOCK = {"kind": "block", "width_m": 3.0, "height_m": 2.0, "foreland_m": 4.0}
EXTRAS = {
    "load": [{"from_m": 1.0, "to_m": 2.0, "pressure_kpa": 5.0}],
    "obstacle": [{"corners_m": [[20, 0], [22, 0], [22, 3], [20, 3]]}],
    "geometry.foundation_m": 2.0,
    "geometry.cut": [{"corners_m": [[14, 2], [16, 2], [16, 5], [14, 5]]}],
    "obstacle.0.corners_m": [[20, 2], [22, 2], [22, 5], [20, 5]],
}


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("short_slope.toml", {}),
        ("short_slope.toml", {"geometry": BLOCK}),
        ("short_slope.toml", EXTRAS),
        ("papers/vardon_2017_long_slope.toml", {}),
    ],
    ids=["slope", "block", "everything", "regions"],
)
def test_a_set_up_is_drawn(name, changes, tmp_path):
    path = tmp_path / "set_up.png"
    write_setup_picture(load_study(CONFIGS / name).with_changes({"discretisation.cell_m": 0.5} | changes), path)
    assert path.read_bytes().startswith(b"\x89PNG")
    assert path.stat().st_size > 5000
