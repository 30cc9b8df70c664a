"""Every constitutive law: Hooke below yield, yield respected, dissipation, isotropy, compiled as in plain Python."""

import sys
from typing import get_args

import numpy as np
import pytest

from rfmpm.kernel_tools import Tensor, at, kernel
from rfmpm.mpm.laws import LAWS
from rfmpm.mpm.laws.elastic import lame_constants
from rfmpm.mpm.protocols import update_stress
from rfmpm.study.models import Material

every_law = pytest.mark.parametrize("name", LAWS)
STEP = 1e-3  # [s]
IDENTITY = 1e-12  # rounding of one update, relative to the stresses it handles
VALUES = {
    "name": "clay",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 1000.0,
    "poissons_ratio": 0.33,
    "cohesion_kpa": 20.0,
    "residual_cohesion_kpa": 4.0,
    "softening_modulus_kpa": 50.0,
    "friction_angle_deg": 30.0,
    "residual_friction_angle_deg": 18.0,
    "dilation_angle_deg": 10.0,
    "residual_dilation_angle_deg": 0.0,
    "tension_cutoff_kpa": 8.0,
    "residual_plastic_strain": 0.3,
}


def von_mises_excess(stress, strain):
    return root_j2(stress) - max(4e3, 20e3 - 50e3 * strain)


def softened_friction(strain):
    """Cohesion [Pa], friction and dilation [rad] after a plastic strain."""
    share = min(1.0, strain / 0.3)
    return 20e3 - 16e3 * share, np.radians(30.0 - 12.0 * share), np.radians(10.0 - 10.0 * share)


def mohr_coulomb_excess(stress, strain):
    """By the eigenvalues of the tensor."""
    cohesion, friction, _ = softened_friction(strain)
    minor, _, major = np.linalg.eigvalsh([[stress.xx, stress.xy, 0], [stress.xy, stress.yy, 0], [0, 0, stress.zz]])
    shear = 0.5 * (major - minor) + 0.5 * (major + minor) * np.sin(friction) - cohesion * np.cos(friction)
    return max(shear, major - 8e3)


def drucker_prager_excess(stress, strain):
    """Mohr-Coulomb in plane strain flow; the match by the slopes of that flow, b for the volume, kappa for the circle.

    There szz is 2/3 b sqrt(J2) below the mean, so that the circle's radius is kappa sqrt(J2).
    """
    cohesion, friction, dilation = softened_friction(strain)
    kappa = 1.0 / np.sqrt(1.0 + np.sin(dilation) ** 2 / 3.0)
    b = np.sin(dilation) * kappa
    slope = np.sin(friction) / (kappa + np.sin(friction) * b / 3.0)
    mean = np.mean(stress[:3])
    return max(root_j2(stress) + slope * (mean - cohesion / np.tan(friction)), mean - 8e3)


# How far a stress is beyond yield [Pa], after a plastic strain, and whether it is that of the end or of the start of
# the step (the strength then lags by a step). A new law adds its line.
EXCESS = {
    "elastic": (lambda stress, strain: -np.inf, "end"),
    "von_mises": (von_mises_excess, "end"),
    "mohr_coulomb": (mohr_coulomb_excess, "start"),
    "drucker_prager": (drucker_prager_excess, "start"),
}


@kernel
def compiled(law, stress, strain_increment, history):
    return update_stress(law, stress, strain_increment, history, STEP)


def one_point(name):
    """Law and history of one point, as records of scalars."""
    model = next(m for m in get_args(get_args(Material)[0]) if name in get_args(m.model_fields["law"].annotation))
    material = model(law=name, **{key: value for key, value in VALUES.items() if key in model.model_fields})
    law, history = LAWS[name].build(material, 0.25, 1, {})
    return at(law, 0), at(history, 0)


def random_paths(name, paths=20, steps=40):
    """Updates along random strain paths down to the residual: (law, stress, strain, history, stress, history)."""
    random = np.random.default_rng(7)
    for _ in range(paths):
        law, history = one_point(name)
        stress = Tensor(*random.normal(0.0, 10e3, 4))
        for _ in range(steps):
            exx, eyy, exy = random.normal(0.0, 0.02, 3)
            strain = Tensor(exx, eyy, 0.0, exy)
            after, changed = compiled(law, stress, strain, history)
            yield law, stress, strain, history, after, changed
            stress, history = after, changed


def hooke(stress, strain):
    lame, shear = lame_constants(VALUES["youngs_modulus_kpa"] * 1e3, VALUES["poissons_ratio"])
    volumetric = lame * (strain.xx + strain.yy + strain.zz) * np.array([1.0, 1.0, 1.0, 0.0])
    return np.array(stress) + volumetric + 2.0 * shear * np.array(strain)


def plastic_increment(stress, strain, after):
    """Strain increment without its elastic part, components xx, yy, zz, xy."""
    lame, shear = lame_constants(VALUES["youngs_modulus_kpa"] * 1e3, VALUES["poissons_ratio"])
    change = np.array(after) - np.array(stress)
    volumetric = lame / (3.0 * lame + 2.0 * shear) * change[:3].sum() * np.array([1.0, 1.0, 1.0, 0.0])
    return np.array(strain) - (change - volumetric) / (2.0 * shear)


def closing(history, changed):
    """Strain of the area by which an opening closed, where a law knows openings; no plastic flow."""
    return max(0.0, getattr(history, "opening", 0.0) - getattr(changed, "opening", 0.0))


def double_dot(a, b):
    return float(np.dot(np.array(a) * [1.0, 1.0, 1.0, 2.0], b))


def root_j2(stress):
    deviator = np.array(stress) - np.mean(stress[:3]) * np.array([1.0, 1.0, 1.0, 0.0])
    return np.sqrt(0.5 * double_dot(deviator, deviator))


def turned(tensor, angle):
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    (xx, xy), (_, yy) = turn @ np.array([[tensor.xx, tensor.xy], [tensor.xy, tensor.yy]]) @ turn.T
    return Tensor(xx, yy, tensor.zz, xy)


@every_law
def test_small_strains_follow_hooke_and_leave_no_history(name):
    random, (law, history) = np.random.default_rng(1), one_point(name)
    for _ in range(50):
        strain = Tensor(*random.normal(0.0, 1e-4, 4))._replace(zz=0.0)
        after, changed = compiled(law, Tensor(0.0, 0.0, 0.0, 0.0), strain, history)
        expected = hooke(np.zeros(4), strain)
        np.testing.assert_allclose(after, expected, rtol=0.0, atol=IDENTITY * np.abs(expected).max())
        assert changed == history


@every_law
def test_the_stress_stays_within_the_strength(name):
    reached = 0
    beyond_yield, moment = EXCESS[name]
    for _, _, _, history, after, changed in random_paths(name):
        past = changed if moment == "end" else history
        excess = beyond_yield(after, 0.0 if past is None else past.plastic_strain)
        scale = np.abs(after).max()
        assert excess <= IDENTITY * scale
        reached += excess >= -IDENTITY * scale
    assert reached > 100 or excess == -np.inf


@every_law
def test_plastic_flow_dissipates(name):
    for _, stress, strain, _, after, _ in random_paths(name):
        flow = plastic_increment(stress, strain, after)
        scale = np.abs([*stress, *after]).max() * np.abs(strain).max()
        assert double_dot(after, flow) >= -IDENTITY * scale


@every_law
def test_plastic_strain_never_falls_and_is_the_one_the_stress_tells(name):
    for _, stress, strain, history, after, changed in random_paths(name):
        flow = plastic_increment(stress, strain, after)
        grown = 0.0 if history is None else changed.plastic_strain - history.plastic_strain
        assert grown >= 0.0
        flow += closing(history, changed) * np.array([0.5, 0.5, 0.0, 0.0])
        flow -= np.mean(flow[:3]) * np.array([1.0, 1.0, 1.0, 0.0])
        # The stress, over 2 G about 750 kPa, gives strains to 1e-16 of itself; the sum in the history to 1e-16 too.
        assert grown == pytest.approx(np.sqrt(2.0 / 3.0 * double_dot(flow, flow)), rel=1e-9, abs=1e-14)


@every_law
@pytest.mark.parametrize("angle", [0.3, np.pi / 2, 2.5])
def test_turned_stress_and_strain_give_the_turned_answer(name, angle):
    for law, stress, strain, history, after, changed in random_paths(name, paths=5):
        found, found_history = compiled(law, turned(stress, angle), turned(strain, angle), history)
        scale = np.abs([*stress, *after]).max()
        # A few tens of roundings; G over the falling strength magnifies those of the trial stress.
        np.testing.assert_allclose(found, turned(after, angle), rtol=0.0, atol=5.0 * IDENTITY * scale)
        if history is not None:
            np.testing.assert_allclose(found_history, changed, rtol=IDENTITY, atol=1e-15)


@every_law
def test_compiled_law_is_the_plain_python_one(name, monkeypatch):
    module = sys.modules[LAWS[name].__module__]
    for key, value in vars(module).items():
        if hasattr(value, "py_func"):
            monkeypatch.setattr(module, key, value.py_func)
    for law, stress, strain, history, after, changed in random_paths(name, paths=5):
        plain, plain_history = update_stress(law, stress, strain, history, STEP)
        # Contraction fuses a product and a sum into one rounding.
        np.testing.assert_allclose(plain, after, rtol=0.0, atol=IDENTITY * np.abs([*stress, *after]).max())
        if history is not None:
            np.testing.assert_allclose(plain_history, changed, rtol=IDENTITY, atol=1e-15)
