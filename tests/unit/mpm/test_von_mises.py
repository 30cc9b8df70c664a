"""Von Mises against closed forms: simple shear and uniaxial strain, softening branch and residual plateau."""

from math import sqrt

import numpy as np
import pytest

from rfmpm.kernel_tools import Tensor, at
from rfmpm.mpm.laws.von_mises import VonMises
from rfmpm.mpm.protocols import update_stress
from rfmpm.study.models import VonMisesMaterial

PEAK, RESIDUAL, SOFTENING = 20e3, 4e3, 50e3  # [Pa]
YOUNG, POISSON, CELL = 1e6, 0.33, 0.25
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
BULK = YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
NOTHING = Tensor(0.0, 0.0, 0.0, 0.0)
AMOUNTS = (0.01, 0.05, 0.06, 0.1, 0.3, 0.55, 0.6, 1.0)  # elastic, softening, residual
IDENTITY = 1e-12
STEP = 1e-3  # [s]


def law_and_history(cell=CELL, strengths=None, count=1, **changes):
    material = VonMisesMaterial(
        name="clay",
        law="von_mises",
        unit_weight_kn_m3=20.0,
        youngs_modulus_kpa=YOUNG / 1e3,
        poissons_ratio=POISSON,
        **{"cohesion_kpa": 20.0, "residual_cohesion_kpa": 4.0, "softening_modulus_kpa": 50.0} | changes,
    )
    return VonMises.build(material, cell, count, strengths or {})


def strained(direction, amount, steps=1, **options):
    """Stress and plastic strain after `amount` times a strain direction, from nothing, in equal steps."""
    law, history = (at(record, 0) for record in law_and_history(**options))
    stress, strain = NOTHING, Tensor(*(amount / steps * component for component in direction))
    for _ in range(steps):
        stress, history = update_stress(law, stress, strain, history, STEP)
    return stress, history.plastic_strain


def shear_strength(strain, peak=PEAK, residual=RESIDUAL, softening=SOFTENING):
    """sqrt(J2) and plastic strain at an engineering shear strain, or at 2 / sqrt(3) times a uniaxial strain.

    sqrt(J2) = G (strain - g) = peak - H g / sqrt(3), with the plastic strain g / sqrt(3); at least the residual.
    """
    slope = softening / sqrt(3.0)
    g = (strain - peak / SHEAR) / (1.0 - slope / SHEAR)
    if g <= 0.0:
        return SHEAR * strain, 0.0
    if peak - slope * g < residual:
        return residual, (strain - residual / SHEAR) / sqrt(3.0)
    return peak - slope * g, g / sqrt(3.0)


SIMPLE_SHEAR = (0.0, 0.0, 0.0, 0.5)  # of engineering strain 1
UNIAXIAL = (0.0, -1.0, 0.0, 0.0)


@pytest.mark.parametrize("strain", AMOUNTS)
def test_simple_shear_in_one_step(strain):
    stress, plastic = strained(SIMPLE_SHEAR, strain)
    strength, expected_plastic = shear_strength(strain)
    assert stress == pytest.approx((0.0, 0.0, 0.0, strength), rel=IDENTITY, abs=IDENTITY * PEAK)
    assert plastic == pytest.approx(expected_plastic, rel=IDENTITY, abs=IDENTITY)


@pytest.mark.parametrize("strain", AMOUNTS)
def test_uniaxial_strain_in_one_step(strain):
    stress, plastic = strained(UNIAXIAL, strain)
    strength, expected_plastic = shear_strength(2.0 / sqrt(3.0) * strain)
    mean, across, along = -BULK * strain, strength / sqrt(3.0), -2.0 * strength / sqrt(3.0)
    expected = (mean + across, mean + along, mean + across, 0.0)
    assert stress == pytest.approx(expected, rel=IDENTITY, abs=IDENTITY * PEAK)
    assert plastic == pytest.approx(expected_plastic, rel=IDENTITY, abs=IDENTITY)


@pytest.mark.parametrize("strain", AMOUNTS)
@pytest.mark.parametrize("direction", [SIMPLE_SHEAR, UNIAXIAL])
def test_one_step_over_both_kinks_equals_many(direction, strain):
    # The path is straight, so each small step lands on the same lines: only roundings add up, 1000 of them.
    once, once_plastic = strained(direction, strain)
    often, often_plastic = strained(direction, strain, steps=1000)
    assert often == pytest.approx(once, rel=1e-10, abs=1e-10 * PEAK)
    assert often_plastic == pytest.approx(once_plastic, rel=1e-10, abs=1e-12)


def test_unloading_is_elastic_and_reloading_finds_the_softened_strength():
    law, history = (at(record, 0) for record in law_and_history())
    stress, history = update_stress(law, NOTHING, Tensor(0.0, 0.0, 0.0, 0.1), history, STEP)
    softened, plastic = stress.xy, history.plastic_strain
    stress, history = update_stress(law, stress, Tensor(0.0, 0.0, 0.0, -0.01), history, STEP)
    assert stress.xy == pytest.approx(softened - 0.02 * SHEAR, rel=IDENTITY)
    stress, history = update_stress(law, stress, Tensor(0.0, 0.0, 0.0, 0.01), history, STEP)
    assert (stress.xy, history.plastic_strain) == pytest.approx((softened, plastic), rel=IDENTITY)
    stress, history = update_stress(law, stress, Tensor(0.0, 0.0, 0.0, 0.01), history, STEP)
    assert stress.xy < softened


@pytest.mark.parametrize(("cell", "factor"), [(0.125, 0.5), (0.25, 1.0), (0.5, 2.0)])
def test_softening_scales_with_the_cell_where_a_reference_is_named(cell, factor):
    for reference, expected in ((None, SOFTENING), (0.25, factor * SOFTENING)):
        stress, plastic = strained(SIMPLE_SHEAR, 0.1, cell=cell, softening_reference_cell_m=reference)
        assert (PEAK - stress.xy) / plastic == pytest.approx(expected, rel=1e-10)  # a difference of close numbers


@pytest.mark.parametrize("strain", AMOUNTS)
def test_sqrt_3j2_convention_yields_where_sqrt_3j2_is_the_cohesion(strain):
    stress, plastic = strained(SIMPLE_SHEAR, strain, strength_convention="sqrt_3j2")
    strength, expected_plastic = shear_strength(strain, *(v / sqrt(3.0) for v in (PEAK, RESIDUAL, SOFTENING)))
    assert stress.xy == pytest.approx(strength, rel=IDENTITY)
    assert plastic == pytest.approx(expected_plastic, rel=IDENTITY, abs=IDENTITY)
    if plastic > 0.0:
        cohesion = max(RESIDUAL, PEAK - SOFTENING * plastic)
        assert sqrt(3.0) * stress.xy == pytest.approx(cohesion, rel=IDENTITY)


def test_a_field_of_peaks_brings_residuals_in_proportion():
    peaks = np.array([10e3, 20e3, 45e3])
    law, history = law_and_history(strengths={"cohesion": peaks}, count=3)
    for point, peak in enumerate(peaks):
        start = at(history, point)
        weakest, _ = update_stress(at(law, point), NOTHING, Tensor(0.0, 0.0, 0.0, 50.0), start, STEP)
        assert weakest.xy == pytest.approx(0.2 * peak, rel=IDENTITY)
        onset = 0.5 * peak / SHEAR
        for share, yields in ((0.999, False), (1.001, True)):
            _, after = update_stress(at(law, point), NOTHING, Tensor(0.0, 0.0, 0.0, share * onset), start, STEP)
            assert (after.plastic_strain > 0.0) == yields


def test_no_residual_given_is_no_softening():
    stress, plastic = strained(SIMPLE_SHEAR, 1.0, residual_cohesion_kpa=None)
    assert plastic > 0.0
    assert stress.xy == pytest.approx(PEAK, rel=IDENTITY)


def test_strength_rises_with_the_rate_of_plastic_shear():
    rate, viscosity = 5.0, 300.0  # [1/s], [Pa s]
    law, history = (at(record, 0) for record in law_and_history(softening_modulus_kpa=0.0, viscosity_kpa_s=0.3))
    stress, steps = NOTHING, 2000  # to a strain of 10; the overstress relaxes by G dt / (G dt + eta) a step
    for _ in range(steps):
        stress, history = update_stress(law, stress, Tensor(0.0, 0.0, 0.0, 0.5 * rate * STEP), history, STEP)
    assert stress.xy == pytest.approx(PEAK + viscosity * rate, rel=IDENTITY)


def test_a_step_of_no_time_changes_nothing_even_with_viscosity():
    law, history = (at(record, 0) for record in law_and_history(viscosity_kpa_s=0.3))
    stress, after = update_stress(law, Tensor(0.0, 0.0, 0.0, PEAK), NOTHING, history, 0.0)
    assert stress == Tensor(0.0, 0.0, 0.0, PEAK)
    assert after == history


def test_with_a_softening_length_strength_follows_the_average_alone():
    law, history = (at(record, 0) for record in law_and_history(softening_length_m=0.5))
    large = Tensor(0.0, 0.0, 0.0, 0.5)
    stress, after = update_stress(law, NOTHING, large, history, STEP)
    assert stress.xy == pytest.approx(PEAK, rel=IDENTITY)
    assert after.plastic_strain > 0.0
    weakened = after._replace(averaged_strain=0.1)
    stress, _ = update_stress(law, stress, large, weakened, STEP)
    assert stress.xy == pytest.approx(PEAK - 0.1 * SOFTENING, rel=IDENTITY)
