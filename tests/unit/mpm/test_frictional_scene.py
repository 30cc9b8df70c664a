"""Scenes of drained soil: initial stresses beyond yield, random cohesion, and a run from release to rest."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import start

CONFIGS = Path(__file__).parents[3] / "configs"
SOIL = {
    "name": "clay",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 5000.0,
    "poissons_ratio": 0.3,
    "cohesion_kpa": 6.0,
    "residual_cohesion_kpa": 1.5,
    "friction_angle_deg": 25.0,
    "residual_friction_angle_deg": 20.0,
    "residual_plastic_strain": 0.4,
}
EVERY_LAW = pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])


def slope(law, **changes):
    study = rfmpm.load_study(CONFIGS / "short_slope_random.toml")
    changes = {key.replace("__", "."): value for key, value in changes.items()}
    return study.with_changes({"material.0": SOIL | {"law": law}, "discretisation.cell_m": 0.5, **changes})


def test_initial_stress_beyond_yield_goes_back_to_it_before_the_first_step():
    scene = scenes.build(slope("mohr_coulomb"))
    own = scenes.release(scene, None)
    points, history = own.points, own.history
    now = SOLVERS["explicit"](start(), 0.0, *scenes.arguments(scene, own))
    assert now.step_count == 0
    yielding = history.plastic_strain > 0.0
    assert 0 < yielding.sum() < yielding.size
    np.testing.assert_array_equal(points.position.x, scene.points.position.x)
    sine, cohesion = np.sin(np.radians(25.0)), 6e3 * np.cos(np.radians(25.0))
    for stress, beyond in ((points.stress, False), (scene.points.stress, True)):
        centre, radius = 0.5 * (stress.xx + stress.yy), np.hypot(0.5 * (stress.xx - stress.yy), stress.xy)
        major, minor = np.maximum(centre + radius, stress.zz), np.minimum(centre - radius, stress.zz)
        excess = 0.5 * (major - minor) + 0.5 * (major + minor) * sine - cohesion
        assert (excess.max() > 1e3) == beyond
        if not beyond:
            assert excess.max() < 1e-7  # [Pa], of stresses up to 100 kPa
            np.testing.assert_allclose(excess[yielding], 0.0, atol=1e-7)


@EVERY_LAW
def test_random_cohesion_is_the_peak_of_each_point_and_its_residual_follows(law):
    study = slope(law)
    cohesion = rfmpm.realise_fields(study, index=3)["cohesion"]
    assert cohesion.std() > 500.0
    soil = scenes.release(scenes.build(study), {"cohesion": cohesion}).law
    np.testing.assert_array_equal(soil.peak, cohesion)
    np.testing.assert_allclose(soil.residual, 0.25 * cohesion, rtol=1e-12)


@EVERY_LAW
def test_a_slope_of_drained_soil_slides_and_its_energies_add_up(law):
    outcome = realisation.simulate(realisation.prepare(slope(law, time__end_s=6.0)), index=3)
    assert outcome.status in ("ok", "not_at_rest")
    assert 1.0 < outcome.quantities["run_out"] < 15.0
    assert np.isfinite([outcome.points[name] for name in ("x", "y", "stress_xx", "stress_zz", "volume")]).all()
    assert abs(outcome.quantities["energy_balance_error"]) < 0.05
