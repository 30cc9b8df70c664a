"""Scenes that broke the engine in the stress test."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.benchmark.stability.arrangements import lone_point

STUDY = rfmpm.load_study(Path(__file__).parents[2] / "configs" / "short_slope.toml").with_changes(
    {"discretisation.cell_m": 0.5, "time.end_s": 2.0}
)


@pytest.mark.parametrize("base", [{"kind": "fixed"}, {"kind": "friction", "coefficient": 0.3}], ids=lambda b: b["kind"])
@pytest.mark.parametrize("fraction", [0.5, 1.0])
def test_a_wedge_that_thins_out_on_the_base_stays_where_it_is(base, fraction):
    study = STUDY.with_changes({"geometry.angle_deg": 3.0, "boundary.base": base, "time.step_fraction": fraction})
    outcome = realisation.simulate(realisation.prepare(study))
    assert outcome.status == "not_at_rest"
    # The cutting of 3 degrees is stable: what moves is the ringing after its release, some millimetres.
    assert np.hypot(outcome.points["displacement_x"], outcome.points["displacement_y"]).max() < 0.1
    assert outcome.points["volume"].min() > 0.0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"material.0.youngs_modulus_kpa": 100.0, "material.0.softening_modulus_kpa": 0.0},
            "under its own weight of 100",
        ),
        ({"material.0.youngs_modulus_kpa": 1e300}, "time steps with these cells"),
        ({"time.step_fraction": 1e-9}, "time steps with these cells"),
    ],
)
def test_what_cannot_be_computed_is_refused(changes, said):
    with pytest.raises(rfmpm.StudyError, match=said):
        STUDY.with_changes(changes)


def test_the_least_stiffness_in_the_message_is_accepted():
    soft = {"material.0.softening_modulus_kpa": 0.0, "geometry.height_m": 5.0}
    with pytest.raises(rfmpm.StudyError) as refusal:
        STUDY.with_changes(soft | {"material.0.youngs_modulus_kpa": 1.0})
    least = float(refusal.value.problems[0].split("at least ")[1].split(":")[0])
    STUDY.with_changes(soft | {"material.0.youngs_modulus_kpa": 1.001 * least})  # it is written with four digits


@pytest.mark.parametrize("shape", ["linear", "gimp"])
@pytest.mark.parametrize("place", [0.0, 1e-12, 0.1])
def test_a_lone_point_beside_a_node_falls_and_rests_on_a_rough_base(shape, place):
    block = {"kind": "block", "width_m": 2.0, "height_m": 2.0, "foreland_m": 2.0}
    study = STUDY.with_changes({"geometry": block, "discretisation.shape": shape, "time.end_s": 5.0})
    outcome = realisation.simulate(lone_point(2.0 + place, 0.5, realisation.prepare(study)))
    assert outcome.status == "ok"
    # It rests where its weight is carried, half a cell high, and friction took no more than gravity gave.
    assert 0.49 < outcome.points["y"][0] / study.discretisation.cell_m < 0.5
    assert 0.0 <= outcome.quantities["friction_work_share"] < 1.0


def test_a_point_turned_inside_out_is_a_status():
    prepared = realisation.prepare(STUDY.with_changes({"time.end_s": 0.1}))
    prepared.scene.points.volume[5] *= -1.0
    outcome = realisation.simulate(prepared)
    assert outcome.status == "diverged"
    assert "inside out" in outcome.reason or "energy" in outcome.reason
