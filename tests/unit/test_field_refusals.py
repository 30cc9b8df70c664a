"""Fields that a study asks for and that cannot be made, or would do nothing: said by `check`, in the study's units."""

from pathlib import Path

import numpy as np
import pytest
from cohesion_field import FIELD, changed, problems_of
from typer.testing import CliRunner

import rfmpm
from rfmpm import realisation
from rfmpm.cli import app
from rfmpm.random_fields import kinds, measurements, properties
from rfmpm.random_fields import layers as soils_of_points
from rfmpm.random_fields.methods import MOST_DENSE_POINTS
from rfmpm.study import StudyError, data_checks, fields_need_making, soils, with_fastest_methods
from rfmpm.study.making import FEW_POINTS

CONFIGS = Path(__file__).parents[2] / "configs"
FRICTION, RESIDUAL = "random_field.friction_angle", "random_field.residual_cohesion"
BETA = {"distribution": "beta", "lower_over_mean": 0.4, "upper_over_mean": 2.0}  # of a mean of 20 kPa: 8 to 40 kPa
THIRTY_BELOW = {"layer": [{"top_m": 3.0, "mean_kpa": 30.0}]}


@pytest.fixture(scope="module")
def study():
    """A slope 5 m high with a crest of 10 m and a toe at 15 m, of 200 squares of 0.5 m."""
    coarse = {"discretisation.cell_m": 1.0, "material.0.softening_length_m": 1.0, f"{FIELD}.method": "auto"}
    return rfmpm.load_study(CONFIGS / "short_slope_random.toml").with_changes(coarse)


@pytest.fixture(scope="module")
def drained():
    return rfmpm.load_study(CONFIGS / "drained_cross_correlated.toml")


def datum(value=20.0, x_m=3.0, y_m=2.0, **keys):
    return {"x_m": x_m, "y_m": y_m, "value": value} | keys


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        # beta between 0.4 and 2: place 0.375, largest share 1 / (1 + 0.2 / 0.375) of 0.6
        (
            BETA | {"layer": [{"top_m": 2.0, "coefficient_of_variation": 0.7}]},
            "layer.0.coefficient_of_variation = 0.7: must be less than 0.6255 between these bounds",
        ),
        # 20 * 0.25 + 2 * 5 = 15 kPa of 20 kPa at the base; 20 * 0.6255 - 5 = 7.51 in 5 m
        (
            BETA | {"standard_deviation_trend_kpa_per_m": 2.0},
            "standard_deviation_trend_kpa_per_m = 2.0: makes the coefficient of variation 0.75 at a depth of 5 m, "
            "where the mean is 20 kPa: must be less than 1.502",
        ),
        (BETA | {"data": [datum(41.0)]}, "data.0.value = 41.0: at x_m = 3, y_m = 2: must be greater than 8 and less"),
        (
            BETA | {"data": [datum(59.0), datum(61.0)], "measurement_error": 0.1} | THIRTY_BELOW,
            "data.1.value = 61.0: at x_m = 3, y_m = 2: must be greater than 12 and less than 60 kPa",
        ),
        (
            BETA | {"data": [datum(40.0), datum(64.0)], "measurement_error": 0.1, "trend_kpa_per_m": 4.0},
            "data.1.value = 64.0: at x_m = 3, y_m = 2: must be greater than 12.8 and less than 64 kPa",
        ),
        ({"data": [datum(0.02)]}, "data.0.value = 0.02: at x_m = 3, y_m = 2: must be greater than 2.7"),
        (
            {"data": [datum(y_m=-3.0)], "trend_kpa_per_m": -3.0},
            "data.0.y_m = -3.0: lies where the trend makes the mean 0 or less, at x_m = 3, a depth of 8 m",
        ),
        ({"data": [datum(20.0), datum(21.0)]}, "data.0 = {"),
        (
            {"data": [datum(x_m=1000.0), datum(21.0, x_m=-50.0)]},
            "data: are all too far from the body to change a value; the nearest, at x_m = -50, y_m = 2 with "
            "value = 21, is 50 m away: must be within 3 scales of fluctuation",
        ),
        ({"data": [datum(y_m=8.1)]}, "data: is too far from the body to change a value; the nearest, at x_m = 3, y_m "),
        (
            {"layer": [{"top_m": 4.8}]},
            "layer.0.top_m = 4.8: must be greater than 0 and at most 4.75, to have points above and below",
        ),
        (
            {"layer": [{"top_m": 2.0}, {"top_m": 3.0}]},
            "layer.0: holds no point of the body, as layer.1, listed later, reaches up to the soil above it",
        ),
        ({"layer": [{"top_m": 2.0}, {"top_m": 2.0}]}, "layer.0: holds no point of the body, as layer.1"),
        (
            {"layer": [{"top_m": 8.0, "dip_deg": -30.0}, {"top_m": 0.0, "dip_deg": 45.0}]},
            "layer: leave no point of the body above all of them",
        ),
        ({"karhunen_loeve_variance_share": 0.9}, 'share = 0.9: has no meaning where method = "auto": leave it out'),
        ({"method": "karhunen_loeve", "karhunen_loeve_variance_share": 1.0}, "must be greater than 0 and less than 1"),
    ],
    ids=str,
)  # fmt: skip
def test_what_the_field_could_not_do_is_one_problem_of_the_study(study, keys, said):
    (problem,) = problems_of(study, keys)
    assert problem.startswith(FIELD)
    assert said in problem


@pytest.mark.parametrize(
    "keys",
    [
        BETA | {"layer": [{"top_m": 2.0, "coefficient_of_variation": 0.62}]},
        BETA | {"standard_deviation_trend_kpa_per_m": 1.5},
        BETA | {"data": [datum(38.0)]},
        {"data": [datum(y_m=7.9)]},
        {"data": [datum(x_m=1000.0), datum(21.0)]},
        {"layer": [{"top_m": 4.75}]},
        {"layer": [{"top_m": 3.0}, {"top_m": 2.0}]},
        {"layer": [{"top_m": 2.0}, {"top_m": 0.0, "dip_deg": 20.0}]},
    ],
    ids=str,
)
def test_what_is_just_inside_is_realised(study, keys):
    fields = realisation.prepare_fields(changed(study, keys))
    values = properties.realise(fields, np.zeros(fields.n_variables))["cohesion"]
    assert np.all(np.isfinite(values) & (values > 0.0))


def test_angles_are_said_in_degrees(drained):
    beta = {f"{FRICTION}.{key}": value for key, value in BETA.items()}
    first = {"random_field_correlation": None, f"{FRICTION}.data": [datum(50.0), datum(85.0, x_m=4.0)]}
    with pytest.raises(StudyError) as refusal:
        drained.with_changes(beta | first)
    inside, above = refusal.value.problems
    # Mean of the tangent: tan 25 degrees, bounds 0.4 and 2 times that.
    low, high = (f"{np.degrees(np.arctan(share * np.tan(np.radians(25.0)))):.4g}" for share in (0.4, 2.0))
    assert f"{FRICTION}.data.0.value = 50.0" in inside
    assert f"must be greater than {low} and less than {high} degrees" in inside
    assert above.startswith(f"{FRICTION}.data.1.value = 85.0: at x_m = 4, y_m = 2: must be at most 80 degrees")


@pytest.mark.parametrize(
    ("key", "value", "chosen"), [("averaging", "volume", "averaging"), ("correlation_space", "physical", "correlation")]
)
def test_correlated_values_need_one_distribution(drained, key, value, chosen):
    both = {f"{path}.{key}": value for path in (FIELD, FRICTION)} | {f"{FIELD}.trend_kpa_per_m": 0.0}
    with pytest.raises(StudyError) as refusal:
        drained.with_changes(both)
    (problem,) = refusal.value.problems
    assert problem.startswith(f"{FRICTION}.coefficient_of_variation = 0.12: must be that of {FIELD}, with which it is")
    assert problem.endswith(": 0.3")
    assert f"where {chosen}" in problem
    equal = both | {f"{FRICTION}.coefficient_of_variation": 0.3}
    study = drained.with_changes(equal)
    if key == "correlation_space":  # the other takes seconds
        assert realisation.prepare_fields(study).mixing is not None
    layers = {
        f"{FIELD}.layer": [{"top_m": 3.0, "coefficient_of_variation": 0.2}],
        f"{FRICTION}.layer": [{"top_m": 3.0}],
    }
    with pytest.raises(
        StudyError, match=r"friction_angle\.layer\.0\.coefficient_of_variation: missing; must be that of"
    ):
        study.with_changes(layers)
    with pytest.raises(StudyError, match=r'friction_angle\.distribution = "gamma": must be that of .*: "lognormal"'):
        study.with_changes({f"{FRICTION}.distribution": "gamma"})


def test_limits_are_those_of_the_fields():
    assert data_checks.FARTHEST_DEVIATIONS == measurements.FARTHEST
    assert np.radians(data_checks.LARGEST_ANGLE) == pytest.approx(kinds.LARGEST_ANGLE, rel=1e-12)  # identity
    assert soils.BORDER == soils_of_points.BORDER


def test_soils_of_the_checks_are_those_of_the_points(study):
    dipping = changed(study, {"layer": [{"top_m": 4.0, "dip_deg": -10.0}, {"top_m": 1.0, "dip_deg": 12.0}]})
    given = dipping.random_field["cohesion"].layer
    places = np.random.default_rng(2).uniform([0.0, 0.0], [15.0, 5.0], (500, 2))
    lines = [(layer.top_m, np.tan(np.radians(layer.dip_deg))) for layer in given]
    assert [soils.soil_at(lines, place) for place in places] == soils_of_points.soil_of_points(given, places).tolist()


def test_outlines_of_soils_hold_their_places_and_no_others():
    body = [(0.0, 0.0), (15.0, 0.0), (10.0, 5.0), (0.0, 5.0)]
    lines = [(4.0, -0.2), (1.0, 0.25)]
    places = np.random.default_rng(3).uniform([0.0, 0.0], [10.0, 5.0], (300, 2))  # all in the body
    for number in range(3):
        outline = soils.outline_of_soil(body, lines, number)
        inside = [soils.distance(place, outline) == 0.0 for place in places]
        assert inside == [soils.soil_at(lines, place) == number for place in places]
    assert soils.distance((12.0, 4.0), body) == pytest.approx(np.sqrt(0.5))  # of x + y = 15


# --- what only making the fields tells


def check(study, folder):
    path = folder / "study.toml"
    path.write_text(study.to_toml(), encoding="utf-8")
    return CliRunner().invoke(app, ["check", str(path)])


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"data": [datum(10.0), datum(30.0, x_m=3.0001)]}, "data: they are on average"),
        ({"distribution": "gamma", "data": [datum(500.0)]}, "data.0 (x_m = 3, y_m = 2, value = 500) lies outside"),
        (
            {"correlation": "gaussian", "correlation_space": "physical", "coefficient_of_variation": 2.0,
             "method": "cholesky"},
            "cholesky: the correlation with scale_of_fluctuation_h_m = 6, scale_of_fluctuation_v_m = 1 on these",
        ),
        (
            {"distribution": "empirical", "sample": [1.0, 60.0, *range(90, 100)], "coefficient_of_variation": 2.0},
            "coefficient_of_variation = 2: too much for the shape of this sample",
        ),
    ],
    ids=range(4),
)  # fmt: skip
def test_check_makes_the_fields_that_only_then_are_known_to_be_wrong(study, tmp_path, keys, said):
    wrong = changed(study, keys)
    assert fields_need_making(wrong)
    outcome = check(wrong, tmp_path)
    assert outcome.exit_code == 2
    assert f"study.toml: {FIELD}: {said}" in outcome.stderr
    for token in ("InGaussianSpace", "theta", "rad", "e+0", "SI unit"):
        assert token not in outcome.stderr


def test_check_takes_the_fastest_method_only_where_another_would_be_refused_alike(study):
    dense = changed(study, {"method": "cholesky", "data": [datum()]})
    assert with_fastest_methods(dense).random_field["cohesion"].method == "auto"
    for keys in ({"correlation_space": "physical"}, {"rotation_deg": 10.0}, {"correlation": "markov_ellipsoidal"},
                 {"layer": [{"top_m": 3.0, "dip_deg": 5.0}]}, {"method": "circulant"}):  # fmt: skip
        kept = changed(dense, keys)
        assert with_fastest_methods(kept) == kept


def test_auto_may_be_refused_for_many_points_of_a_correlation_that_is_no_product(study):
    turned = changed(study, {"rotation_deg": 10.0})
    assert not fields_need_making(turned)  # 200 squares
    fine = turned.with_changes({"discretisation.cell_m": 0.125})
    assert fields_need_making(fine)
    assert not fields_need_making(changed(fine, {"rotation_deg": 0.0}))
    assert fields_need_making(changed(turned, {"reference_cell_m": 0.125}))
    assert FEW_POINTS < MOST_DENSE_POINTS


def test_check_makes_no_field_of_which_closed_forms_say_all(study, tmp_path, monkeypatch):
    assert not fields_need_making(study)
    assert not fields_need_making(study.with_changes({"random_field": {}}))
    monkeypatch.setattr(realisation, "prepare_fields", None)
    assert check(study, tmp_path).exit_code == 0


# --- what the laws make of it


def test_a_random_residual_above_the_peak_is_counted(study):
    field = study.model_dump(exclude_none=True)["random_field"]["cohesion"] | {"coefficient_of_variation": 1.0}
    both = study.with_changes({RESIDUAL: field, "material.0.residual_cohesion_kpa": 15.0})
    prepared = realisation.prepare(both)
    fields = realisation.realise_fields(both, 0)
    share = realisation.residual_above_peak(prepared, fields)
    assert share == np.mean(fields["residual_cohesion"] > fields["cohesion"])
    assert 0.0 < share < 1.0
    alone = both.with_changes({"random_field": {"residual_cohesion": field}})
    own = realisation.realise_fields(alone, 0)
    found = realisation.residual_above_peak(realisation.prepare(alone), own)
    assert found == np.mean(own["residual_cohesion"] > 20e3)
    assert realisation.residual_above_peak(prepared, {"cohesion": fields["cohesion"]}) is None
