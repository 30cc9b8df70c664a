"""The factor of safety in a row: when a study asks for it, by which method, from which strength."""

from math import radians, sqrt
from pathlib import Path

import numpy as np
import pytest

from rfmpm.realisation import prepare, run, simulate
from rfmpm.stability import METHODS, section_of, strength_of
from rfmpm.stability.limit_equilibrium import ASSUMPTIONS
from rfmpm.study import StudyError, load_study
from rfmpm.study.models import Quantities
from rfmpm.study.schema import choices
from rfmpm.variables import VARIABLES

COARSE = Path(__file__).parents[2] / "robustness" / "coarse.toml"


def study(**changes):
    return load_study(COARSE).with_changes({"quantities.factor_of_safety": True, **changes})


def drained(method):
    given = load_study(COARSE).model_dump(exclude_unset=True)
    undrained = ("residual", "softening", "viscosity", "strength_convention")
    material = {key: value for key, value in given["material"][0].items() if not key.startswith(undrained)}
    given["material"] = [{**material, "law": "mohr_coulomb", "friction_angle_deg": 20.0}]
    given["random_field"] = {}
    given["quantities"] = {"factor_of_safety": method}
    return load_study(given)


def test_a_row_holds_the_factor_where_the_study_asks_for_it():
    plain_study = load_study(COARSE)
    plain, row = run(prepare(plain_study), 1), run(prepare(study()), 1)
    assert row.keys() - plain.keys() == {"factor_of_safety"}
    assert row["run_out"] == plain["run_out"]
    assert plain_study.with_changes({"quantities.factor_of_safety": False}).physics_hash == plain_study.physics_hash
    assert study().physics_hash != plain_study.physics_hash
    holding = {"boundary.base": {"kind": "fixed"}}
    homogeneous = simulate(prepare(study(**holding)), homogeneous=True).quantities["factor_of_safety"]
    # 8 kPa on 4 m of 20 kN/m3, 6.12 by Taylor (1937); the crest is as wide as the slope is high, which leaves out the
    # widest surfaces.
    assert homogeneous == pytest.approx(6.12 * 8.0 / 80.0, rel=0.02)
    other = prepare(study(**holding, **{"material.0.strength_convention": "sqrt_3j2"}))
    lower = simulate(other, homogeneous=True).quantities["factor_of_safety"]
    assert lower == pytest.approx(homogeneous / sqrt(3.0), rel=1e-12)


def test_an_uncertain_weight_enters_the_factor():
    entry = {"key": "material.0.unit_weight_kn_m3", "distribution": "uniform", "low": 16.0, "high": 20.0}
    prepared = prepare(study(uncertain=[entry]))
    xi = np.random.default_rng(0).standard_normal(prepared.n_variables)
    xi[0] = 0.0
    at_18 = run(prepared, 0, xi=xi)["factor_of_safety"]
    assert at_18 == pytest.approx(run(prepare(study()), 0, xi=xi[1:])["factor_of_safety"] * 20.0 / 18.0, rel=1e-9)


@pytest.mark.parametrize("method", ASSUMPTIONS)
def test_a_study_names_its_method(method):
    asked = drained(method)
    row = run(prepare(asked), 0)
    assert row["factor_of_safety"] == METHODS[method](prepare(asked), {}).factor
    comment = VARIABLES["factor_of_safety"].attributes["comment"].format(study=asked)
    assert f"by {method}:" in comment


def test_methods_of_a_study_are_those_of_the_table():
    assert set(choices(Quantities.model_fields["factor_of_safety"].annotation)) - {True} == set(METHODS)


def test_strength_is_the_material_s_or_the_field_s():
    prepared = prepare(drained("bishop"))
    count = len(prepared.scene.points.mass)
    own = strength_of(prepared, {})
    assert own.friction_angle == pytest.approx(np.full(count, radians(20.0)), rel=1e-12)
    assert own.unit_weight == pytest.approx(np.full(count, 20e3), rel=1e-12)
    field = np.linspace(0.2, 0.5, count)
    np.testing.assert_array_equal(strength_of(prepared, {"friction_angle": field}).friction_angle, field)


def test_what_is_elastic_holds_the_surface_up():
    given = drained("bishop").model_dump(exclude_unset=True)
    clay = given["material"][0]
    kept = ("unit_weight_kn_m3", "youngs_modulus_kpa", "poissons_ratio")
    rock = {"name": "rock", "law": "elastic", **{key: clay[key] for key in kept}}
    given["geometry"]["foundation_m"] = 3.0
    soft = prepare(load_study(given))
    given["geometry"]["foundation_material"] = "rock"
    given["material"] = [clay, rock]
    firm = prepare(load_study(given))
    weak, strong = (METHODS["bishop"](prepared, {}) for prepared in (soft, firm))
    toe = firm.scene.body.outline[:, 1].max() - given["geometry"]["height_m"]
    assert strong.surface[:, 1].min() > toe - 0.25  # half a square of a material point
    assert strong.factor >= weak.factor


@pytest.mark.parametrize(
    ("base", "friction"),
    [({"kind": "friction", "coefficient": 0.3}, 0.3), ({"kind": "roller"}, 0.0), ({"kind": "fixed"}, np.inf)],
)
def test_the_base_of_a_study_is_that_of_its_section(base, friction):
    prepared = prepare(study(**{"boundary.base": base}))
    assert section_of(prepared.scene, prepared.study.discretisation.points_per_cell).base_friction == friction


def test_an_elastic_soil_has_none():
    given = load_study(COARSE).model_dump(exclude_unset=True)
    kept = ("name", "unit_weight_kn_m3", "youngs_modulus_kpa", "poissons_ratio")
    given["material"] = [{"law": "elastic", **{key: given["material"][0][key] for key in kept}}]
    given["random_field"] = {}
    given["quantities"] = {"factor_of_safety": True}
    with pytest.raises(
        StudyError, match=r'quantities\.factor_of_safety = true: needs a material with strength.*"elastic"'
    ):
        load_study(given)


def test_an_unknown_method_is_refused_with_the_choices():
    with pytest.raises(StudyError, match=r'"morgenstern_price", "strength_reduction", true \(did you mean "bishop"'):
        study(**{"quantities.factor_of_safety": "bishops"})


def test_the_load_of_a_study_is_on_the_ground_of_its_section():
    load = {"from_m": 1.0, "to_m": 2.5, "pressure_kpa": 15.0}
    prepared = prepare(study(load=[load]))
    section = section_of(prepared.scene, prepared.study.discretisation.points_per_cell)
    start, end, pressure = section.load.T
    assert start.min() == pytest.approx(1.0, abs=1e-9)
    assert end.max() == pytest.approx(2.5, abs=1e-9)
    assert np.sum((end - start) * pressure) == pytest.approx(15e3 * 1.5, rel=1e-12)
    plain = prepare(study())
    with_load, without = (METHODS["bishop"](one, {}).factor for one in (prepared, plain))
    assert with_load < without
