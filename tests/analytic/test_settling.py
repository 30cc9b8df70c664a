"""What only swings is brought to rest, and that changes no answer; what flies, slides or cannot yield is left alone."""

from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import start

SHORT_SLOPE = Path(__file__).parents[2] / "configs" / "short_slope.toml"
CLAY = {
    "name": "clay",
    "law": "von_mises",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 1000.0,
    "poissons_ratio": 0.33,
    "cohesion_kpa": 1000.0,
    "softening_modulus_kpa": 0.0,
}


def settled_and_not(study):
    prepared = realisation.prepare(study)
    scene = prepared.scene
    swinging = replace(scene, controls=scene.controls._replace(settling_rate=0.0))
    return [realisation.simulate(replace(prepared, scene=one)) for one in (scene, swinging)]


@pytest.mark.parametrize("residual", [8.0, 12.0])
def test_a_slope_that_has_failed_settles_where_it_would_have_come_to_rest(residual):
    changes = {
        "material.0.residual_cohesion_kpa": residual,
        "discretisation.cell_m": 0.5,
        "geometry.foreland_m": 10.0,
        "time.end_s": 40.0,
    }
    settled, swinging = settled_and_not(rfmpm.load_study(SHORT_SLOPE).with_changes(changes))
    assert settled.status == "ok"
    assert settled.step_count < 0.7 * swinging.step_count
    kinetic = settled.history["kinetic_energy"]
    assert kinetic[-1] < 1e-4 * kinetic.max()
    # Swinging moves the front to and fro by about a millimetre, and a point in a hundred over the threshold.
    assert settled.quantities["run_out"] == pytest.approx(swinging.quantities["run_out"], abs=5e-3)
    assert settled.quantities["failure_volume"] == pytest.approx(swinging.quantities["failure_volume"], rel=0.01)


def test_a_body_in_the_air_is_not_slowed_down(blocks):
    scene = blocks.scene(1.0, 1.0, 6.0, material=[CLAY])
    thrown = blocks.launched(
        scene, shift=(0.5, 0.5), velocity=(1.0, 0.0), height=3.0, gravity=0.0, rest_time=0.2, energy_scale=1.0,
        growth_limit=inf,
    )  # fmt: skip
    assert thrown.controls.settling_rate > 0.0
    flight = blocks.flight(thrown)
    flight.until(2.0)
    np.testing.assert_allclose(flight.points.velocity.x, 1.0, rtol=1e-10)


def test_what_cannot_yield_swings_on(blocks):
    assert blocks.scene(1.0, 1.0, 1.0).controls.settling_rate == 0.0


def test_a_calm_swing_decays_at_the_settling_rate(blocks):
    # A calm column on a roller: damping m v takes half its rate from the amplitude, so all of it from the energy.
    scene = blocks.scene(1.0, 2.0, 0.0, material=[CLAY], discretisation__dissipation_time_s=inf)
    y = scene.points.position.y
    mode = 1e-3 * np.sin(0.25 * np.pi * y)
    rate = 0.2 * scene.controls.settling_rate
    calm = blocks.launched(
        scene, velocity=(0.0, mode), gravity=0.0, rest_time=1e-9, rest_fraction=0.0, settling_rate=rate
    )
    own, now, energies, period = scenes.release(calm, None), start(), [], 8.0 / calm.controls.wave_speed
    for periods in (1, 5):
        now = SOLVERS["explicit"](now, periods * period, *scenes.arguments(calm, own))
        energies.append((now.time, now.kinetic + now.stress_work))
    (before, first), (after, last) = energies
    assert np.log(first / last) / (after - before) == pytest.approx(rate, rel=0.1)
