"""The study: what it accepts, what it refuses and in which words, and what identifies its physics."""

import math
import pickle
import tomllib
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError

import rfmpm
from rfmpm.random_fields.marginals import HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION
from rfmpm.study import Study, StudyError, distribution_checks, load_study
from rfmpm.study.study import NOT_PHYSICS

CONFIGS = Path(__file__).parents[2] / "configs"
RANDOM = CONFIGS / "short_slope_random.toml"
HOMOGENEOUS = CONFIGS / "short_slope.toml"
JARGON = (
    "Input should",
    "valid dictionary",
    "union",
    "discriminator",
    "tag",
    "pydantic",
    "extra",
    "von_mises.",
    "mohr_coulomb.",
    "slope.",
)


@pytest.fixture
def tables():
    return tomllib.loads(RANDOM.read_text())


PLACE = {"name": "crown", "x_m": 9.0, "y_m": 5.0}


@pytest.fixture
def study():
    return load_study(RANDOM)


def problems_of(study, changes):
    with pytest.raises(StudyError) as refusal:
        study.with_changes(changes)
    return refusal.value.problems


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("**/*.toml")), ids=lambda path: path.stem)
def test_every_study_of_the_project_is_valid(path):
    assert load_study(path).study.name


def test_path_text_dict_tables_and_study_are_the_same_study(tables, study):
    assert load_study(str(RANDOM)) == study
    assert load_study(RANDOM.read_text()) == study
    assert load_study(tables) == study
    assert load_study(study) is study
    assert rfmpm.Study(**tables) == study


def test_values_arrive_under_the_names_of_the_file(study):
    assert study.geometry.kind == "slope"
    assert study.boundary.base.coefficient == 0.3
    assert study.material[0].cohesion_kpa == 20.0
    assert study.random_field["cohesion"].scale_of_fluctuation_h_m == 6.0
    assert load_study(HOMOGENEOUS).random_field == {}


def test_defaults(study):
    assert study.quantities.run_out_limit_m == 5.0
    assert study.discretisation.dissipation_time_s == 5.0
    bare = study.with_changes({"material.0": {**_elastic(study), "law": "von_mises", "cohesion_kpa": 20.0}})
    assert bare.material[0].residual_cohesion_kpa == 20.0
    assert bare.material[0].softening_modulus_kpa == 0.0
    assert bare.with_changes({"material.0.cohesion_kpa": 12.0}).material[0].residual_cohesion_kpa == 12.0


def _elastic(study):
    shared = ("name", "unit_weight_kn_m3", "youngs_modulus_kpa", "poissons_ratio")
    return {"law": "elastic"} | {name: getattr(study.material[0], name) for name in shared}


def test_toml_text_gives_the_same_study_with_its_defaults_written_out(study):
    text = study.to_toml()
    assert "run_out_limit_m = 5.0" in text
    assert load_study(text) == study
    endless = study.with_changes({"discretisation.dissipation_time_s": math.inf, "random_field": {}})
    assert load_study(endless.to_toml()) == endless


def test_study_is_immutable_and_travels_between_processes(study):
    with pytest.raises(ValidationError):
        study.time.end_s = 3.0
    assert pickle.loads(pickle.dumps(study)) == study
    error = StudyError(["a", "b"], "x.toml")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


# --- identity of the physics


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (".".join(path), value)
        for path, value in zip(
            NOT_PHYSICS,
            ["other", 7, None, "elsewhere", 0.5, 2.0, 0.3, {"action": "abort"}, 0.01, [PLACE]],
            strict=True,
        )
    ],
)
def test_what_does_not_change_a_realisation_does_not_change_the_hash(study, path, value):
    assert study.with_changes({path: value}).physics_hash == study.physics_hash


@pytest.mark.parametrize(
    "change",
    [
        {"study.seed": 1},
        {"discretisation.cell_m": 0.5},
        {"material.0.residual_cohesion_kpa": 8.0},
        {"random_field.cohesion.scale_of_fluctuation_v_m": 2.0},
        {"random_field": {}},
        {"quantities.displacement_threshold_m": 0.4},
    ],
    ids=str,
)
def test_what_changes_a_realisation_changes_the_hash(study, change):
    assert study.with_changes(change).physics_hash != study.physics_hash


def test_hash_is_that_of_the_values_not_of_how_they_are_written(study):
    written_out = study.with_changes({"time.step_fraction": 0.8, "geometry.height_m": 5, "quantities": {}})
    assert load_study(study.to_toml()).physics_hash == written_out.physics_hash == study.physics_hash


# --- changes


def test_changes_give_a_copy(study):
    changed = study.with_changes({"material.0.residual_cohesion_kpa": 8.0, "time.step_fraction": 0.2})
    assert (changed.material[0].residual_cohesion_kpa, changed.time.step_fraction) == (8.0, 0.2)
    assert (study.material[0].residual_cohesion_kpa, study.time.step_fraction) == (4.0, 0.8)


def test_changes_may_come_from_numpy(study):
    changed = study.with_changes(
        {"study.seed": np.int64(3), "time.end_s": np.float64(2.5), "geometry.crest_m": np.int32(8)}
    )
    assert (changed.study.seed, changed.time.end_s, changed.geometry.crest_m) == (3, 2.5, 8.0)
    assert type(changed.time.end_s) is float


def test_changes_may_set_a_key_or_table_that_the_file_leaves_out(study, tables):
    del tables["quantities"]
    changed = load_study(tables).with_changes({"quantities.run_out_limit_m": 3.0})
    assert changed == study.with_changes({"quantities.run_out_limit_m": 3.0})


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("material.0.residual_cohesion", "did you mean residual_cohesion_kpa?"),
        ("materal.0.cohesion_kpa", "did you mean material?"),
        ("material.1.cohesion_kpa", "material.1.cohesion_kpa: no such key"),
        ("study.seed.low", "study.seed.low: no such key"),
        ("nonsense", "allowed here: study, geometry"),
    ],
)
def test_unknown_path_of_a_change_is_refused(study, path, said):
    assert said in " ".join(problems_of(study, {path: 8.0}))


# --- types and ranges: each key alone

INF, NAN = math.inf, math.nan
REFUSED = {
    "study.name": ["", " ", 3],
    "study.seed": [-1, 1.0, "1", True, 2**63],
    "study.realisations": [0, 64.0, "64", True],
    "geometry.height_m": [0, -5.0, INF, NAN, "5", True, 1e7],
    "geometry.crest_m": [0.0, -1, INF, NAN],
    "geometry.angle_deg": [0, -45, 90.1, INF, NAN],
    "geometry.foreland_m": [0, -1, INF, NAN],
    "geometry.kind": ["long_slope", 3, ["slope"]],
    "discretisation.cell_m": [0, -0.25, INF, NAN, 1e-300],
    "discretisation.points_per_cell": [0, 2, 4.0, "4", True],
    "discretisation.shape": ["quadratic", 2],
    "discretisation.volumetric_strain": ["cell", True],
    "discretisation.dissipation_time_s": [0, -1, NAN, "inf"],
    "boundary.base": ["fixed", {"kind": "sticky"}, {"kind": "friction"}, {"kind": "roller", "coefficient": 0.3}],
    "boundary.base.coefficient": [-0.1, INF, NAN, "0.3"],
    "material.0.name": ["", 1],
    "material.0.law": ["cam_clay", None],
    "material.0.unit_weight_kn_m3": [0, -20, INF, NAN],
    "material.0.youngs_modulus_kpa": [0, -1000.0, INF, NAN],
    "material.0.poissons_ratio": [-0.1, 0.5, 0.491, INF, NAN],
    "material.0.cohesion_kpa": [0, -20, INF, NAN, "20", True],
    "material.0.residual_cohesion_kpa": [0, -4, INF, NAN, 20.1],
    "material.0.softening_modulus_kpa": [-50, INF, NAN],
    "material.0.softening_reference_cell_m": [0, -0.25, INF, NAN],
    "material.0.softening_length_m": [0, -0.5, INF, NAN],
    "material.0.viscosity_kpa_s": [-0.3, INF, NAN],
    "material.0.strength_convention": ["tresca"],
    "random_field.cohesion.material": ["", "sand", 1],
    "random_field.cohesion.distribution": ["normal"],
    "random_field.cohesion.coefficient_of_variation": [0, -0.25, 2.1, 5, INF, NAN],
    "random_field.cohesion.lower_over_mean": [-0.1, 1.0, 0.5, NAN],
    "random_field.cohesion.upper_over_mean": [1.0, 2.0, INF, "2"],
    "random_field.cohesion.sample_file": ["", 1, "values.csv"],
    "random_field.cohesion.sample": [[1.0] * 20, 3.0, [1.0, 2.0]],
    "random_field.cohesion.correlation": ["matern_32"],
    "random_field.cohesion.matern_nu": [0, 0.04, 21, 1.5, NAN],
    "random_field.cohesion.correlation_space": ["log"],
    "random_field.cohesion.nugget": [-0.1, 1.0, NAN],
    "random_field.cohesion.scale_of_fluctuation_h_m": [0, -6, INF, NAN],
    "random_field.cohesion.scale_of_fluctuation_v_m": [0, -1, INF, NAN],
    "random_field.cohesion.rotation_deg": [181, -181, INF, NAN],
    "random_field.cohesion.method": ["lu"],
    "random_field.cohesion.averaging": ["cell"],
    "random_field.cohesion.data_file": ["", 3],
    "random_field.cohesion.data": ["borings.csv", [3], [{"x_m": 1.0, "y_m": 2.0}], [{"x_m": 1, "y_m": 2, "value": 0}]],
    "random_field.cohesion.measurement_error": [-0.1, 2.1, INF, NAN],
    "time.end_s": [0, -1, INF, NAN, None],
    "time.initial_stress": ["isotropic"],
    "time.scheme": ["implicit"],
    "time.step_fraction": [0, 1.01, NAN],
    "quantities.displacement_threshold_m": [0, -0.5, INF, NAN],
    "quantities.front_quantile": [0.49, 1.01, NAN],
    "quantities.block_plastic_strain": [0, -1, INF, NAN],
    "quantities.block_minimum_area_m2": [-1, INF, NAN],
    "quantities.run_out_limit_m": [-1, INF, NAN],
    "quantities.inundation_depth_m": [0, -1, INF, NAN],
    "output.directory": ["", 3],
    "output.surface_bin_m": [0, -1, INF, NAN, 1e-9],
    "failures.action": ["ignore", True],
    "failures.retries": [0, -1, 2.0, 101],
    "failures.max_failed_fraction": [-0.1, 1.1, NAN, "5 %"],
    "failures.realisation_time_limit_s": [0, -1, INF, NAN],
}


@pytest.mark.parametrize(("path", "value"), [(path, value) for path, values in REFUSED.items() for value in values])
def test_value_out_of_range_or_of_the_wrong_type_is_refused_once_by_its_path(study, path, value):
    problems = problems_of(study, {path: value})
    assert len(problems) == 1
    assert problems[0].startswith(path)
    assert not [word for word in JARGON if word in problems[0]]


def test_every_key_has_a_range_test(study):
    def leaves(value, path=""):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, entry in items:
            yield from leaves(entry, f"{path}{key}.") if isinstance(entry, dict | tuple) else [f"{path}{key}"]

    untested = set(leaves(study.model_dump(exclude_none=True))) - REFUSED.keys()
    assert untested == {"boundary.base.kind", "boundary.sides.kind"}  # tested as whole tables


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("study.seed", [0, 2**63 - 1]),
        ("geometry.angle_deg", [1, 90]),
        ("geometry.crest_m", [10, 0.5]),
        ("geometry.height_m", [5, 1.0]),
        ("material.0.poissons_ratio", [0, 0.49]),
        ("material.0.residual_cohesion_kpa", [20, 20.0]),
        ("random_field.cohesion.coefficient_of_variation", [0.01, 2]),
        ("time.step_fraction", [1]),
        ("quantities.front_quantile", [0.5, 1]),
        ("boundary.base", [{"kind": "fixed"}, {"kind": "roller"}]),
    ],
)
def test_ends_of_the_ranges_and_whole_numbers_for_lengths_are_accepted(study, path, values):
    coarse = study.with_changes({"discretisation.points_per_cell": 1})
    for value in values:
        assert coarse.with_changes({path: value}) is not None  # a refusal raises


@pytest.mark.parametrize(
    ("path", "value", "sentence"),
    [
        ("material.0.poissons_ratio", 0.5, "material.0.poissons_ratio = 0.5: must be at least 0 and at most 0.49"),
        (
            "material.0.cohesion_kpa",
            "20",
            'material.0.cohesion_kpa = "20": must be a number greater than 0, without quotes',
        ),
        ("material.0.cohesion_kpa", True, "material.0.cohesion_kpa = true: must be a number greater than 0"),
        ("time.end_s", INF, "time.end_s = inf: must be a finite number greater than 0"),
        (
            "geometry.kind",
            "slop",
            'geometry.kind = "slop": must be one of "slope", "block", "regions" (did you mean "slope"?)',
        ),
        ("time.scheme", "implicit", 'time.scheme = "implicit": must be "explicit"'),
        ("discretisation.points_per_cell", 5, "discretisation.points_per_cell = 5: must be one of 1, 4, 9, 16"),
        ("boundary.base", {"kind": "friction"}, "boundary.base.coefficient: missing; must be a number at least 0"),
        (
            "boundary.base",
            {"kind": "fixed", "coefficient": 1.0},
            'boundary.base.coefficient = 1.0: unknown key where kind = "fixed" (allowed here: kind)',
        ),
    ],
)
def test_wording(study, path, value, sentence):
    assert problems_of(study, {path: value}) == [sentence]


# --- materials with friction


@pytest.fixture(params=["mohr_coulomb", "drucker_prager"])
def drained(study, request):
    soil = {**_elastic(study), "law": request.param, "cohesion_kpa": 5.0, "friction_angle_deg": 30.0}
    soil |= {"dilation_angle_deg": 8.0, "tension_cutoff_kpa": 1.0, "softening_reference_cell_m": 0.25}
    soil |= {"residual_cohesion_kpa": 1.0, "residual_friction_angle_deg": 20.0, "residual_dilation_angle_deg": 0.0}
    return study.with_changes({"material.0": {**soil, "residual_plastic_strain": 0.5}})


REFUSED_DRAINED = {
    "cohesion_kpa": [-1.0, INF, NAN, "5", None],
    "residual_cohesion_kpa": [-1.0, 5.1, INF, NAN],
    "friction_angle_deg": [-1.0, 81.0, INF, NAN, None],
    "residual_friction_angle_deg": [-1.0, 31.0, NAN],
    "dilation_angle_deg": [-1.0, 31.0, NAN, "8"],
    "residual_dilation_angle_deg": [-1.0, 8.1, NAN],
    "tension_cutoff_kpa": [-1.0, INF, NAN],
    "residual_plastic_strain": [0, -0.1, INF, NAN, None],
    "softening_reference_cell_m": [0, -0.25, INF, NAN],
}


@pytest.mark.parametrize(
    ("key", "value"), [(key, value) for key, values in REFUSED_DRAINED.items() for value in values]
)
def test_value_of_a_drained_soil_out_of_range_is_refused_once_by_its_path(drained, key, value):
    problems = problems_of(drained, {f"material.0.{key}": value})
    assert len(problems) == 1
    assert problems[0].startswith(f"material.0.{key}")
    assert not [word for word in JARGON if word in problems[0]]


def test_every_key_of_a_drained_soil_has_a_range_test(drained):
    shared = {"name", "law", "unit_weight_kn_m3", "youngs_modulus_kpa", "poissons_ratio"}
    shared |= {"random_field", "random_field_correlation"}
    assert type(drained.material[0]).model_fields.keys() == shared | REFUSED_DRAINED.keys()


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"residual_plastic_strain": None}, "residual_cohesion_kpa is less than cohesion_kpa"),
        ({"dilation_angle_deg": 30.5}, "dilation_angle_deg = 30.5: must be at most friction_angle_deg = 30"),
        ({"residual_friction_angle_deg": 5.0, "residual_dilation_angle_deg": 6.0}, "residual angle of friction, 5"),
        ({"residual_friction_angle_deg": 5.0, "residual_dilation_angle_deg": None},
         "dilation_angle_deg = 8.0: must be at most the residual angle of friction, 5"),
        ({"residual_plastic_strain": 0.01}, "else the stress falls faster than the material can unload"),
        ({"cohesion_kpa": 0.0, "residual_cohesion_kpa": 0.0}, "must be greater than 0, the mean of its random field"),
    ],
)  # fmt: skip
def test_wording_for_a_drained_soil(drained, changes, sentence):
    (problem,) = problems_of(drained, {f"material.0.{key}": value for key, value in changes.items()})
    assert sentence in problem


def test_drained_soil_may_lack_cohesion_or_friction_but_not_both(drained):
    loose = {"random_field": {}, "material.0.cohesion_kpa": 0.0, "material.0.residual_cohesion_kpa": 0.0}
    assert drained.with_changes(loose).material[0].cohesion_kpa == 0.0
    smooth = {f"material.0.{key}": 0.0 for key in REFUSED_DRAINED if key.endswith("angle_deg")}
    assert drained.with_changes(smooth).material[0].friction_angle_deg == 0.0
    (problem,) = problems_of(drained, {**loose, **smooth})
    assert problem.startswith("material.0.cohesion_kpa = 0.0: must be greater than 0 where friction_angle_deg = 0")


def test_residuals_of_a_drained_soil_default_to_the_peaks(study):
    bare = {**_elastic(study), "law": "mohr_coulomb", "cohesion_kpa": 5.0, "friction_angle_deg": 30.0}
    soil = study.with_changes({"material.0": bare}).material[0]
    residuals = soil.residual_cohesion_kpa, soil.residual_friction_angle_deg, soil.residual_dilation_angle_deg
    assert residuals == (5.0, 30.0, 0.0)
    assert soil.residual_plastic_strain is None


def test_cubic_splines_need_more_than_one_point_per_cell(study):
    one = {"discretisation.points_per_cell": 1}
    assert study.with_changes({**one, "discretisation.shape": "quadratic_bspline"}) is not None  # a refusal raises
    (problem,) = problems_of(study, {**one, "discretisation.shape": "cubic_bspline"})
    assert problem.startswith("discretisation.points_per_cell = 1: must be at least 4 where shape")


def test_volumetric_strain_that_is_not_given_follows_the_law(study, drained):
    def of(changed):
        return changed.discretisation.volumetric_strain

    elastic = {"random_field": {}, "material.0": _elastic(study)}
    assert (of(study), of(study.with_changes(elastic)), of(drained)) == ("cell_mean", "cell_mean", "point")
    assert of(drained.with_changes(elastic)) == "cell_mean"
    assert of(drained.with_changes({"discretisation.volumetric_strain": "cell_mean"})) == "cell_mean"
    given = study.with_changes({"discretisation.volumetric_strain": "point"})
    assert of(given.with_changes(elastic)) == "point"
    written_out = drained.with_changes({"discretisation.volumetric_strain": "point"})
    assert written_out.physics_hash == load_study(drained.to_toml()).physics_hash == drained.physics_hash


@pytest.mark.parametrize(("reference", "scale"), [(None, 1.0), (0.125, 2.0)])
def test_drained_softening_that_snaps_back_is_refused(drained, reference, scale):
    # Under 5 m of 20 kN/m3; per unit plastic strain the shear stress unloads by sqrt(3) G.
    angles = [math.radians(angle) for angle in (30.0, 20.0)]
    loss = 5.0 * math.cos(angles[0]) - 1.0 * math.cos(angles[1]) + 100.0 * (math.sin(angles[0]) - math.sin(angles[1]))
    least = scale * loss / (math.sqrt(3.0) * 1000.0 / (2.0 * 1.33))
    softening = {"material.0.softening_reference_cell_m": reference}
    drained.with_changes({**softening, "material.0.residual_plastic_strain": least * 1.001})
    (problem,) = problems_of(drained, {**softening, "material.0.residual_plastic_strain": least * 0.999})
    assert f"must be greater than {least:.6g}" in problem


# --- several keys together


def test_lengths_must_be_whole_numbers_of_cells(study):
    (problem,) = problems_of(study, {"geometry.height_m": 5.1})
    assert (
        problem == "geometry.height_m = 5.1: must be a whole number of cells of 0.25 m, at least 4; nearest: 5 or 5.25"
    )
    (problem,) = problems_of(study, {"geometry.crest_m": 0.25})
    assert problem.endswith("at least 2; nearest: 0.5")
    (problem,) = problems_of(study, {"geometry.height_m": 0.75})
    assert problem.endswith("at least 4; nearest: 1")
    study.with_changes({"discretisation.cell_m": 0.1, "geometry.height_m": 0.7})  # 0.7 / 0.1 = 6.999...


def test_block_needs_whole_cells_too_and_may_be_confined(study):
    block = {"kind": "block", "width_m": 0.5, "height_m": 5.0, "foreland_m": 0.0}
    study.with_changes({"geometry": block})
    (problem,) = problems_of(study, {"geometry": {**block, "width_m": 0.25}})  # three nodes of a spline need two cells
    assert problem.endswith("at least 2; nearest: 0.5")
    (problem,) = problems_of(study, {"geometry": block, "discretisation.shape": "cubic_bspline"})  # four need three
    assert problem.endswith("at least 3; nearest: 0.75")
    assert problems_of(study, {"geometry": {**block, "width_m": 0.3}})[0].startswith("geometry.width_m = 0.3")


SCALED = {"material.0.softening_length_m": None, "material.0.softening_reference_cell_m": 0.25}


@pytest.mark.parametrize(
    ("changes", "divisor"),
    [
        ({}, 1.0),
        ({"material.0.softening_reference_cell_m": 0.125}, 2.0),  # a cell twice the reference: twice the modulus
        ({"material.0.strength_convention": "sqrt_3j2"}, 1.0 / math.sqrt(3.0)),
    ],
    ids=["as given", "scaled to the cell", "sqrt_3j2"],
)
def test_softening_that_snaps_back_is_refused(study, changes, divisor):
    changes = SCALED | changes
    shear_modulus = 1000.0 / (2.0 * 1.33)
    steepest = math.sqrt(3.0) * shear_modulus / divisor
    study.with_changes({**changes, "material.0.softening_modulus_kpa": steepest * 0.999})
    (problem,) = problems_of(study, {**changes, "material.0.softening_modulus_kpa": steepest * 1.001})
    assert f"must be less than {steepest:.6g}" in problem


def test_unscaled_softening_does_not_look_at_the_cells(study):
    unscaled = study.with_changes({"material.0.softening_length_m": None, "discretisation.cell_m": 1.0})
    assert unscaled.with_changes({"material.0.softening_modulus_kpa": 650.0}).material[0].softening_modulus_kpa == 650.0


def test_softening_over_a_length_of_the_soil_needs_cells_no_larger(study):
    study.with_changes({"discretisation.cell_m": 0.5})
    (problem,) = problems_of(study, {"discretisation.cell_m": 1.0})
    assert problem.startswith("material.0.softening_length_m = 0.5: must be at least 1 m with these cells")


def test_softening_has_a_length_or_a_reference_cell_but_not_both(study):
    (problem,) = problems_of(study, {"material.0.softening_reference_cell_m": 0.25})
    assert "cannot be given together with softening_length_m" in problem


def test_softening_over_a_length_may_be_steeper_than_the_unloading(study):
    # Within a step the strength stays as it is, so that no stress has to be found on a line that snaps back.
    steep = study.with_changes({"material.0.softening_modulus_kpa": 1e4})
    assert steep.material[0].softening_modulus_kpa == 1e4


def test_field_needs_a_material_with_a_cohesion(study):
    (problem,) = problems_of(study, {"random_field.cohesion.material": "clsy"})
    assert problem == 'random_field.cohesion.material = "clsy": names no material; must be "clay"'
    (problem,) = problems_of(study, {"material.0": _elastic(study)})
    assert 'law = "elastic", which has no cohesion' in problem


def test_truncated_normal_is_not_asked_for_more_spread_than_it_has(study):
    assert distribution_checks.HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION == HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION
    changes = {"random_field.cohesion.distribution": "normal_truncated"}
    spread = "random_field.cohesion.coefficient_of_variation"
    study.with_changes({**changes, spread: 0.98})
    (problem,) = problems_of(study, {**changes, spread: 0.99})
    assert problem.startswith(f"{spread} = 0.99: must be less than 0.99 for normal_truncated")
    layer = [{"top_m": 2.0, "coefficient_of_variation": 1.0}]
    (problem,) = problems_of(study, {**changes, "random_field.cohesion.layer": layer})
    assert problem.startswith("random_field.cohesion.layer.0.coefficient_of_variation = 1.0: must be less than 0.99")


def test_there_is_exactly_one_material_and_names_differ(tables):
    tables["material"] *= 2
    with pytest.raises(StudyError) as refusal:
        load_study(tables)
    assert any("exactly one table, written [[material]]; there are 2" in problem for problem in refusal.value.problems)
    assert any('material.1.name = "clay": is the name of 2' in problem for problem in refusal.value.problems)


def test_study_that_cannot_be_afforded_is_refused_before_it_allocates(study):
    (problem,) = problems_of(study, {"discretisation.cell_m": 0.1})
    assert 'random_field.cohesion.method = "cholesky"' in problem
    assert "5.0 GB" in problem  # 25 000 points, squared, of 8 bytes
    study.with_changes({"discretisation.cell_m": 0.1, "random_field": {}})
    problems = problems_of(study, {"discretisation.cell_m": 0.0025, "random_field": {}})
    assert "material points" in problems[0]
    (problem,) = problems_of(study, {"geometry.foreland_m": 500_000.0, "output.surface_bin_m": None})
    assert problem.startswith("discretisation.cell_m = 0.25: gives 40,001,200 cells")  # 500 015 m by 5 m
    (problem,) = problems_of(study, {"output.surface_bin_m": 1e-4})
    assert "gives 400,000 bins" in problem


# --- everything at once


def test_all_errors_are_reported_at_once(study):
    wrong = {
        "study.seed": -1,
        "geometry.kind": "slop",
        "geometry.height_m": 5.1,
        "material.0.law": "von_mise",
        "material.0.youngs_modulus_kpa": -1.0,
        "material.0.residual_cohesion_kpa": 30.0,
        "random_field.cohesion.material": "sand",
        "output.colour": "red",
    }
    problems = problems_of(study, wrong)
    assert sorted(problem.split(" = ")[0] for problem in problems) == sorted(wrong)


def test_errors_behind_a_choice_that_cannot_be_guessed_are_reported(study):
    problems = problems_of(study, {"material.0.law": "cam_clay", "material.0.poissons_ratio": 0.5})
    assert [problem.split(" = ")[0] for problem in problems] == ["material.0.law", "material.0.poissons_ratio"]


def test_missing_tables_are_all_named():
    with pytest.raises(StudyError) as refusal:
        Study()
    required = ["study", "geometry", "discretisation", "boundary", "material", "time", "output"]
    assert [problem.split(": missing")[0] for problem in refusal.value.problems] == required


@pytest.mark.parametrize("wrong", [3, "text", [], [3], True, None, {}, {"kind": {}}], ids=str)
@pytest.mark.parametrize(
    "path", ["study", "geometry", "boundary", "boundary.base", "material", "random_field.cohesion"]
)
def test_wrong_shape_of_a_table_is_a_study_error_in_plain_words(study, path, wrong):
    problems = problems_of(study, {path: wrong})
    assert all(problem.startswith(path) for problem in problems)
    assert not [word for problem in problems for word in JARGON if word in problem]


# --- files


def test_syntax_error_names_file_and_line(tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text("[study]\nname = 'x'\nseed = = 3\n")
    with pytest.raises(StudyError, match=r"wrong\.toml: is not valid TOML: .*line 3"):
        load_study(path)
    with pytest.raises(StudyError, match="line 1"):
        load_study("seed = = 3")


def test_file_that_cannot_be_read_is_a_study_error(tmp_path):
    with pytest.raises(StudyError, match=r"none\.toml: there is no such study file"):
        load_study(tmp_path / "none.toml")
    with pytest.raises(StudyError, match="cannot be read"):
        load_study(tmp_path)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(StudyError, match="not a text file"):
        load_study(binary)


def test_errors_in_a_file_are_named_by_the_file(tmp_path, tables):
    path = tmp_path / "x.toml"
    path.write_text(RANDOM.read_text().replace("seed = 20160901", "seed = -1"))
    with pytest.raises(StudyError, match=r"x\.toml: study\.seed = -1"):
        load_study(path)


# --- schema


def test_schema_describes_every_key(tables):
    schema = Study.json_schema()
    undescribed = {
        key
        for table in schema["$defs"].values()
        for key, entry in table["properties"].items()
        if "description" not in entry and "const" not in entry
    }
    assert not undescribed
    assert schema["additionalProperties"] is False
    assert "[kPa]" in schema["$defs"]["VonMisesMaterial"]["properties"]["youngs_modulus_kpa"]["description"]


def test_loading_does_not_touch_the_given_dict(tables):
    before = deepcopy(tables)
    tables["geometry"]["kind"] = "slop"
    before["geometry"]["kind"] = "slop"
    with pytest.raises(StudyError):
        load_study(tables)
    assert tables == before
