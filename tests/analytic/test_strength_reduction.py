"""Strength reduction finds the factors of limit analysis; cases.md of the short slope, Chen (1975) with friction."""

from math import isinf, radians, tan

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.stability import strength_reduction
from rfmpm.stability.strength_reduction import LARGEST, SMALLEST, WIDTH, _bracket

ROUGH, SLIDING = 1.224, 1.10  # limit analysis of the short slope, base rough and with friction 0.3
NUMBER_AT_20_DEGREES = 16.16  # critical gamma H / c of a slope of 45 degrees, Chen (1975)


def slope(law, height, cell, base, **soil):
    return rfmpm.load_study(
        {
            "study": {"name": "slope", "seed": 1},
            "geometry": {
                "kind": "slope", "height_m": height, "crest_m": 2.0 * height, "angle_deg": 45.0, "foreland_m": height,
            },
            "discretisation": {"cell_m": cell, "points_per_cell": 4, "shape": "quadratic_bspline"},
            "boundary": {"base": base, "sides": {"kind": "roller"}},
            "material": [
                {"name": "soil", "law": law, "unit_weight_kn_m3": 20.0, "youngs_modulus_kpa": 1e3} 
                | {"poissons_ratio": 0.33} | soil
            ],
            "time": {"end_s": 1.0},
            "output": {"directory": "results"},
        }
    )  # fmt: skip


def short_slope(cell, base=None, **soil):
    return slope("von_mises", 5.0, cell, base or {"kind": "fixed"}, **{"cohesion_kpa": 20.0} | soil)


def found(study, fields=None, **options):
    return strength_reduction(realisation.prepare(study), fields or {}, **options)


@pytest.mark.parametrize("cell", [1.0, 0.5])
def test_short_slope_on_a_rough_base(cell):
    result = found(short_slope(cell))
    assert result.factor == pytest.approx(ROUGH, rel=0.03)
    low, high = result.bracket
    assert low < result.factor < high < low * (1.0 + 1.01 * WIDTH)
    assert all(trial.verdict.stands == (trial.factor <= low) for trial in result.history)


def test_short_slope_on_a_base_with_friction():
    assert found(short_slope(0.25, {"kind": "friction", "coefficient": 0.3})).factor == pytest.approx(SLIDING, rel=0.03)


def test_elastic_foundation_becomes_a_rough_base_as_cells_get_finer():
    """Shape functions reach across the interface, so that rock holds the soil within a cell of it: first order."""
    rock = {
        "name": "rock",
        "law": "elastic",
        "unit_weight_kn_m3": 20.0,
        "youngs_modulus_kpa": 1e4,
        "poissons_ratio": 0.2,
    }
    errors = []
    for cell in (0.5, 0.25):
        on_base = short_slope(cell)
        foundation = {"geometry.foundation_m": 1.0, "geometry.foundation_material": "rock"}
        study = on_base.with_changes(foundation | {"material": [on_base.material[0], rock]})
        study = study.with_changes({"quantities.factor_of_safety": "strength_reduction"})
        errors.append(found(study).factor / ROUGH - 1.0)
    assert 0.0 < errors[1] < 0.6 * errors[0]


def test_drained_slope_comes_down_to_limit_analysis_as_cells_get_finer():
    """Associated flow, as limit analysis has it; divided by the factor, the strength is the critical one."""
    height, factor = 3.0, 1.25
    critical = {
        "cohesion_kpa": factor * 20.0 * height / NUMBER_AT_20_DEGREES,
        "friction_angle_deg": np.degrees(np.arctan(factor * tan(radians(20.0)))),
    }
    soil = critical | {"dilation_angle_deg": critical["friction_angle_deg"]}
    errors = [
        found(slope("mohr_coulomb", height, cell, {"kind": "fixed"}, **soil)).factor / factor - 1.0
        for cell in (0.375, 0.1875)
    ]
    assert 0.0 < errors[1] < 0.6 * errors[0]
    assert errors[1] < 0.04


def test_twice_the_strength_is_twice_the_factor():
    one = found(short_slope(1.0))
    other = found(short_slope(1.0, cohesion_kpa=40.0), first=2.0)
    assert other.factor == pytest.approx(2.0 * one.factor, rel=1e-12)
    assert [trial.verdict for trial in other.history] == [trial.verdict for trial in one.history]


def test_neither_stiffness_nor_softening_nor_viscosity_count():
    plain = found(short_slope(1.0)).factor
    soft = {"residual_cohesion_kpa": 4.0, "softening_modulus_kpa": 50.0, "softening_length_m": 1.0}
    assert found(short_slope(1.0, viscosity_kpa_s=0.3, **soft)).factor == plain
    # Another stiffness is scaled to the same one, to rounding; a verdict at the limit of the bracket may differ.
    assert found(short_slope(1.0, youngs_modulus_kpa=2e4)).factor == pytest.approx(plain, rel=WIDTH)


def test_strength_of_the_realisation_counts_and_nothing_of_it_is_changed():
    study = short_slope(1.0)
    cohesion = np.full(len(realisation.prepare(study).scene.points.mass), 40e3)
    assert found(study, {"cohesion": cohesion}).factor == pytest.approx(2.0 * found(study).factor, rel=2.0 * WIDTH)
    assert (cohesion == 40e3).all()


def test_rows_hold_the_factor_where_the_study_asks_for_it():
    study = short_slope(1.0).with_changes({"quantities.factor_of_safety": "strength_reduction"})
    row = realisation.run(realisation.prepare(study), 0)
    assert row["factor_of_safety"] == found(study).factor


@pytest.mark.parametrize("critical", [0.3, 1.0, 1.1, 7.0])
def test_bracket_closes_around_what_fails(critical):
    low, high = _bracket(lambda factor: factor <= critical, 1.0)
    assert low <= critical < high < 1.3 * low


def test_bracket_of_what_never_fails_or_never_stands_is_open():
    low, high = _bracket(lambda factor: True, 1.0)
    assert low >= LARGEST
    assert isinf(high)
    low, high = _bracket(lambda factor: False, 1.0)
    assert low == 0.0
    assert high <= SMALLEST


def test_soil_that_cannot_fail_is_refused():
    elastic = {
        "name": "x", "law": "elastic", "unit_weight_kn_m3": 20.0, "youngs_modulus_kpa": 1e4, "poissons_ratio": 0.33
    }  # fmt: skip
    changes = {"material.0": elastic, "quantities.factor_of_safety": "strength_reduction"}
    with pytest.raises(rfmpm.StudyError, match=r"quantities\.factor_of_safety.*needs a material with strength"):
        short_slope(1.0).with_changes(changes)
