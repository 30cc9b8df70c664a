"""Random fields in a study file: what is refused, in which words, and all at once."""

from pathlib import Path

import pytest

import rfmpm
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.study import StudyError
from rfmpm.study.field_checks import SEPARABLE

CONFIGS = Path(__file__).parents[2] / "configs"
COHESION, FRICTION = "random_field.cohesion", "random_field.friction_angle"
PAIR = "random_field_correlation.0"
INF, NAN = float("inf"), float("nan")


@pytest.fixture
def drained():
    return rfmpm.load_study(CONFIGS / "drained_cross_correlated.toml")


@pytest.fixture
def undrained():
    return rfmpm.load_study(CONFIGS / "short_slope_random.toml")


def problems_of(study, changes):
    with pytest.raises(StudyError) as refusal:
        study.with_changes(changes)
    return refusal.value.problems


def layer(**keys):
    return {f"{COHESION}.layer": [{"top_m": 2.0} | keys]}


DATUM = {"x_m": 3.0, "y_m": 2.0, "value": 15.0}
FIELD = {
    "material": "clay",
    "distribution": "lognormal",
    "coefficient_of_variation": 0.2,
    "correlation": "markov_separable",
    "scale_of_fluctuation_h_m": 6.0,
    "scale_of_fluctuation_v_m": 1.0,
}


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({f"{COHESION}.trend_kpa_per_m": INF}, "must be a finite number"),
        ({f"{COHESION}.trend_kpa_per_m": -5.0}, "makes the mean -5 kPa at a depth of 5 m: must be above -4"),
        ({f"{COHESION}.standard_deviation_trend_kpa_per_m": NAN}, "must be a finite number"),
        ({f"{COHESION}.standard_deviation_trend_kpa_per_m": -1.0}, "must be greater than -1 and at most 7"),
        ({f"{COHESION}.standard_deviation_trend_kpa_per_m": 8.0}, "makes the standard deviation 45 kPa at a depth"),
        ({f"{COHESION}.reference_cell_m": 0.2}, "must be discretisation.cell_m = 0.25 over a whole number, such as"),
        ({f"{COHESION}.reference_cell_m": 0.5}, "must be discretisation.cell_m = 0.25 over a whole number"),
        ({f"{COHESION}.reference_cell_m": 0.0}, "must be greater than 0"),
        ({f"{COHESION}.reference_value": "mean"}, "needs a reference_cell_m"),
        (
            {f"{COHESION}.reference_cell_m": 0.25, f"{COHESION}.reference_value": "sum"},
            'must be one of "mean", "point"',
        ),
        ({f"{COHESION}.reference_cell_m": 0.05}, "lattice points need a dense factor"),
        (
            {f"{COHESION}.reference_cell_m": 0.0025},
            "gives 52,000,000 points of a lattice around the body, at most 5,00",
        ),
        (layer(top_m=4.94), "must be greater than 0 and at most 4.938, to have points above and below"),
        (layer(top_m=-1.0), "to have points above and below"),
        (layer(top_m=INF), "must be a finite number"),
        (layer(dip_deg=80.0), "must be greater than -80 and less than 80"),
        (layer(mean_kpa=0.0), "must be greater than 0"),
        (layer(mean_deg=20.0), "must be left out: the mean of cohesion is mean_kpa"),
        (layer(coefficient_of_variation=2.1), "must be greater than 0 and at most 2"),
        (layer(scale_of_fluctuation_h_m=0.0), "must be greater than 0"),
        (layer(scale_of_fluctuation_v_m=-1.0), "must be greater than 0"),
        (layer(rotation_deg=181.0), "must be at least -180 and at most 180"),
        (layer(thickness_m=2.0), "unknown key"),
        ({FRICTION: FIELD}, 'is a material with law = "von_mises", which has no friction_angle'),
        ({"random_field.youngs_modulus": FIELD}, "unknown key"),
        ({f"{COHESION}.measurement_error": 0.1}, "is that of data: give data or a data_file, or leave it out"),
        (
            {f"{COHESION}.method": "ar1", f"{COHESION}.correlation": "gaussian"},
            "needs one of the correlations markov_s",
        ),
        ({f"{COHESION}.method": "kronecker", f"{COHESION}.rotation_deg": 10.0}, "and no rotation or dip"),
        (
            {f"{COHESION}.method": "ar1", f"{COHESION}.layer": [{"top_m": 2.0, "dip_deg": 5.0}]},
            "and no rotation or dip",
        ),
        ({f"{COHESION}.method": "ar1", f"{COHESION}.averaging": "volume"}, "of the standard-normal field, at points"),
        (
            {f"{COHESION}.averaging": "volume", f"{COHESION}.data": [DATUM]},
            'must be "point" where there are data, which are values at points',
        ),
        (
            {f"{COHESION}.averaging": "volume", f"{COHESION}.standard_deviation_trend_kpa_per_m": 0.1},
            "these need one coefficient of variation at all depths",
        ),
        (
            {f"{COHESION}.correlation_space": "physical", f"{COHESION}.standard_deviation_trend_kpa_per_m": 0.1},
            "these need one coefficient of variation at all depths",
        ),
        (
            {"random_field.residual_cohesion": FIELD, "material.0.softening_modulus_kpa": 0.0},
            "must be given and greater",
        ),
        ({"random_field_correlation": [{"between": ["cohesion", "friction_angle"], "coefficient": 0.5}]}, "not random"),
    ],
)
def test_one_wrong_key_of_a_field_is_one_problem(undrained, changes, sentence):
    (problem,) = problems_of(undrained, changes)
    assert sentence in problem


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({f"{PAIR}.coefficient": 1.0}, "must be greater than -1 and less than 1"),
        ({f"{PAIR}.coefficient": NAN}, "must be a finite number"),
        ({f"{PAIR}.between": ["cohesion", "cohesion"]}, "must be two different fields, and each pair once"),
        ({f"{PAIR}.between": "cohesion"}, 'must be a list of 2, each one of "cohesion", "residual_cohesion"'),
        ({f"{PAIR}.between": ["cohesion"] * 3}, "must be a list of 2"),
        ({f"{PAIR}.between": ["cohesion", "friction"]}, 'must be one of "cohesion"'),
        ({f"{PAIR}.between": ["residual_cohesion", "cohesion"]}, "add the table random_field.residual_cohesion"),
        ({f"{FRICTION}.scale_of_fluctuation_v_m": 2.0}, "must be that of random_field.cohesion, with which it is"),
        ({f"{FRICTION}.correlation": "gaussian"}, "must be that of random_field.cohesion, with which it is correlated"),
        ({f"{COHESION}.reference_cell_m": 0.25}, "missing; must be that of random_field.cohesion"),
        ({f"{COHESION}.layer": [{"top_m": 2.0}]}, "missing; must have the borders, scales and rotations of"),
        ({f"{FRICTION}.coefficient_of_variation": 0.51}, "must be at most 0.5: it is that of tan(friction angle)"),
        ({f"{FRICTION}.trend_kpa_per_m": 1.0}, "must be left out: a friction angle has no trend in kPa"),
    ],
)
def test_one_wrong_key_of_correlated_fields_is_one_problem(drained, changes, sentence):
    (problem,) = problems_of(drained, changes)
    assert sentence in problem


def test_a_property_without_a_mean_cannot_vary(drained):
    problems = problems_of(drained, {"material.0.cohesion_kpa": 0.0, "material.0.residual_cohesion_kpa": 0.0})
    assert "material.0.cohesion_kpa = 0.0: must be greater than 0, the mean of its random field" in problems


def test_coefficients_that_exclude_each_other(drained):
    third = drained.model_dump(exclude_none=True)["random_field"]["friction_angle"]
    pairs = [("cohesion", "friction_angle", 0.9), ("cohesion", "residual_cohesion", 0.9)]
    both = [{"between": [first, second], "coefficient": value} for first, second, value in pairs]
    last = {"between": ["friction_angle", "residual_cohesion"]}
    changes = {"random_field.residual_cohesion": third}
    # The third coefficient of two of 0.9 lies within 0.81 +- 0.19.
    (problem,) = problems_of(drained, changes | {"random_field_correlation": [*both, last | {"coefficient": 0.61}]})
    assert (
        problem == "random_field_correlation: has coefficients that exclude each other: bring one of them closer to 0"
    )
    drained.with_changes(changes | {"random_field_correlation": [*both, last | {"coefficient": 0.63}]})


def test_the_separable_correlations_are_those_of_the_fields():
    assert set(SEPARABLE) == {name for name, kernel in CORRELATIONS.items() if kernel.separable}


def test_only_the_first_of_correlated_fields_may_have_data(drained):
    assert drained.with_changes({f"{COHESION}.data": [DATUM]})
    problems = problems_of(drained, {f"{FRICTION}.data": [DATUM]})
    assert len(problems) == 1
    assert "only the first in the study may have data" in problems[0]


def test_correlated_fields_may_have_distributions_of_their_own(drained):
    bounds = {f"{FRICTION}.lower_over_mean": 0.5, f"{FRICTION}.upper_over_mean": 2.0}
    assert drained.with_changes({f"{FRICTION}.distribution": "beta"} | bounds)


def test_the_same_pair_twice_is_refused(drained):
    again = {"between": ["friction_angle", "cohesion"], "coefficient": 0.1}
    first = drained.model_dump()["random_field_correlation"][0]
    (problem,) = problems_of(drained, {"random_field_correlation": [first, again]})
    assert problem.startswith("random_field_correlation.1.between")


def test_everything_wrong_is_said_at_once(drained):
    changes = {
        f"{FRICTION}.coefficient_of_variation": 0.6,
        f"{FRICTION}.scale_of_fluctuation_h_m": 1.0,
        f"{COHESION}.trend_kpa_per_m": -2.0,
        f"{COHESION}.reference_value": "mean",
        f"{PAIR}.coefficient": -2.0,
    }
    assert len(problems_of(drained, changes)) == 6  # reference_value is wrong in itself and missing in the other field


def test_studies_without_these_keys_say_nothing_of_them(undrained):
    text = undrained.to_toml()
    assert not [word for word in ("trend", "layer", "reference_cell_m = 0", "random_field_correlation") if word in text]


def test_a_study_with_all_of_them_survives_its_text(drained):
    changes = {
        f"{COHESION}.standard_deviation_trend_kpa_per_m": 0.0,
        f"{COHESION}.layer": [{"top_m": 3.0, "dip_deg": 5.0, "mean_kpa": 9.0}],
        f"{FRICTION}.layer": [{"top_m": 3.0, "dip_deg": 5.0, "mean_deg": 31.0}],
        f"{COHESION}.reference_cell_m": 0.25,
        f"{FRICTION}.reference_cell_m": 0.25,
    }
    study = drained.with_changes(changes)
    assert rfmpm.load_study(study.to_toml()) == study
    assert study.physics_hash != drained.physics_hash


@pytest.mark.parametrize("value", ["mean", "point"])
def test_the_reference_cell_that_a_refusal_names_is_allowed_and_the_next_smaller_one_is_not(undrained, value):
    method = {f"{COHESION}.method": "auto", f"{COHESION}.reference_value": value}
    (problem,) = problems_of(undrained, method | {f"{COHESION}.reference_cell_m": 0.0025})
    named = float(problem.rsplit("take ")[-1].split()[0])
    undrained.with_changes(method | {f"{COHESION}.reference_cell_m": named})
    smaller = 0.25 / (round(0.25 / named) + 1)
    (problem,) = problems_of(undrained, method | {f"{COHESION}.reference_cell_m": smaller})
    assert "points of a lattice around the body" in problem
