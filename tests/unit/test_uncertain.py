"""Uncertain numbers of a study: what may be one, what a realisation draws, and what it prepares anew."""

from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from rfmpm import results
from rfmpm.realisation import draw_xi, drawn, prepare, realise_fields, run, simulate
from rfmpm.study import StudyError, load_study
from rfmpm.uncertainty import fitted, marginals, values
from rfmpm.variables import STATUS

COARSE = Path(__file__).parents[1] / "robustness" / "coarse.toml"
PEAK = {"key": "material.0.cohesion_kpa", "distribution": "lognormal", "mean": 9.0, "coefficient_of_variation": 0.2}
SCALE = {"key": "random_field.cohesion.scale_of_fluctuation_h_m", "distribution": "uniform", "low": 1.0, "high": 6.0}
FRICTION = {"key": "boundary.base.coefficient", "distribution": "uniform", "low": 0.1, "high": 0.5}


@pytest.fixture(scope="module")
def study():
    return load_study(COARSE)


def uncertain(study, *entries, **changes):
    return study.with_changes({"uncertain": list(entries), **changes})


def same(row, other, *but):
    assert row.keys() - {*but} == other.keys() - {*but}
    names = row.keys() - {"wall_time", *but}
    return all(np.asarray(row[name]).tobytes() == np.asarray(other[name]).tobytes() for name in names)


def test_a_study_without_the_table_is_as_it_was(study):
    assert "uncertain" not in study.to_toml()
    assert "uncertain" not in study.model_dump(exclude_none=True)  # what the physics hash is made of
    assert uncertain(study, PEAK).physics_hash != study.physics_hash
    assert uncertain(study, PEAK).with_changes({"uncertain": None}).physics_hash == study.physics_hash


def test_a_study_file_holds_the_table(study):
    asked = uncertain(study, PEAK, FRICTION)
    assert load_study(asked.to_toml()) == asked


@pytest.mark.parametrize(
    ("entry", "mean", "variation"),
    [
        (PEAK, 9.0, 0.2),
        ({**PEAK, "distribution": "normal_truncated", "coefficient_of_variation": 0.6}, 9.0, 0.6),
        ({**PEAK, "distribution": "uniform"}, 9.0, 0.2),
        (FRICTION, 0.3, 0.4 / sqrt(12.0) / 0.3),
    ],
)
def test_values_have_the_asked_moments(study, entry, mean, variation):
    z = np.random.default_rng(5).standard_normal(40_000)
    found = marginals(uncertain(study, entry))[0].transform(z)
    # Four standard errors; that of a standard deviation takes the kurtosis of the sample.
    deviation = found.std(ddof=1)
    spread = sqrt((np.mean((found - found.mean()) ** 4) / deviation**4 - 1.0) / 4.0)
    assert abs(found.mean() - mean) < 4.0 * deviation / sqrt(len(z))
    assert abs(deviation - variation * mean) < 4.0 * deviation * spread / sqrt(len(z))
    assert np.all(np.diff(found[np.argsort(z)]) > 0.0)


def test_a_row_is_that_of_the_study_at_the_drawn_values(study):
    prepared = prepare(uncertain(study, PEAK, SCALE, FRICTION))
    row, xi = run(prepared, 4), draw_xi(prepared, 4)
    np.testing.assert_array_equal(row["uncertain_value"], values(prepared.uncertain, xi))
    keys = [entry.key for entry in prepared.study.uncertain]
    plain = prepare(study.with_changes(dict(zip(keys, row["uncertain_value"], strict=True))))
    assert plain.n_variables == len(xi) - 3
    assert same(row, run(plain, 4, xi=xi[3:]), "uncertain_value")
    assert not same(row, run(prepared, 5), "uncertain_value", "realisation")
    assert same(run(prepare(prepared.study), 4), row)  # by another worker


def test_stresses_at_rest_follow_weight_and_stiffness(study):
    changes = {"material.0.unit_weight_kn_m3": 23.0, "material.0.youngs_modulus_kpa": 900.0}
    for extra in ({}, {"material.0.poissons_ratio": 0.2}):
        asked = [
            {"key": key, "distribution": "uniform", "low": value * 0.999, "high": value * 1.001}
            for key, value in (changes | extra).items()
        ]
        prepared = prepare(uncertain(study, *asked))
        own, _ = drawn(prepared, np.zeros(prepared.n_variables))  # the middles of the distributions
        fresh = prepare(own.study).scene
        for found, expected in zip(own.scene.points.stress, fresh.points.stress, strict=True):
            # The solve for the stresses has a shift of 1e-10 on a unit diagonal: they agree to that, times a condition.
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * np.abs(fresh.points.stress.yy).max())
        np.testing.assert_allclose(own.scene.points.mass, fresh.points.mass, rtol=1e-12)
        assert own.scene.controls.wave_speed == fresh.controls.wave_speed


def test_what_does_not_change_is_not_prepared_again(study):
    prepared = prepare(uncertain(study, PEAK, FRICTION))
    own, _ = drawn(prepared, draw_xi(prepared, 0))
    (before,), (after,) = prepared.fields["cohesion"].parts, own.fields["cohesion"].parts
    assert after.field.record is before.field.record
    assert after.mean != before.mean


def test_a_homogeneous_simulation_has_the_study_s_own_values(study):
    own = study.with_changes({"random_field": {}})
    found = simulate(prepare(uncertain(study, PEAK, FRICTION)), 3, homogeneous=True)
    assert same(found.quantities, simulate(prepare(own)).quantities)


def test_a_residual_above_the_peak_counts_as_the_peak(study):
    asked = uncertain(study, PEAK, {**PEAK, "key": "material.0.residual_cohesion_kpa", "mean": 6.0})
    assert asked.with_values([7.0, 5.0]).material[0].residual_cohesion_kpa == 5.0
    assert asked.with_values([7.0, 8.0]).material[0].residual_cohesion_kpa == 7.0
    alone = uncertain(study, PEAK)
    least = 0.5 * study.material[0].residual_cohesion_kpa
    assert alone.with_values([least]).material[0].residual_cohesion_kpa == least


def test_a_study_that_is_wrong_at_its_values_is_a_refused_row(study):
    soft = {"key": "material.0.youngs_modulus_kpa", "distribution": "lognormal", "mean": 900.0}
    prepared = prepare(uncertain(study, soft | {"coefficient_of_variation": 0.2}))
    xi = draw_xi(prepared, 2)
    xi[0] = -12.0
    row = run(prepared, 2, xi=xi)
    assert row["status"] == STATUS["refused"]
    assert "youngs_modulus_kpa" in row["status_reason"]
    assert np.isnan(row["run_out"])
    assert row["uncertain_value"].shape == (1,)
    assert row.keys() == run(prepared, 2).keys()


def test_fields_that_take_more_or_less_than_xi_holds():
    xi = np.random.default_rng(1).standard_normal(50)
    np.testing.assert_array_equal(fitted(xi, 20), xi[:20])
    longer = fitted(xi, 5000)
    np.testing.assert_array_equal(longer[:50], xi)
    np.testing.assert_array_equal(fitted(xi, 90), longer[:90])
    more = longer[50:]
    assert abs(more.mean()) < 4.0 / sqrt(len(more))  # standard normal, four standard errors
    assert abs(np.mean(more**2) - 1.0) < 4.0 * sqrt(2.0 / len(more))
    assert not np.any(np.isin(fitted(-xi, 5000)[50:], more))


def test_the_field_s_numbers_do_not_depend_on_other_uncertain_numbers(study):
    field = "random_field.cohesion"
    changes = {f"{field}.correlation": "markov_ellipsoidal", f"{field}.method": "circulant"}
    changes |= {f"{field}.scale_of_fluctuation_h_m": 1.0, f"{field}.scale_of_fluctuation_v_m": 1.0}
    prepared = prepare(uncertain(study, FRICTION, SCALE, **changes))
    xi = draw_xi(prepared, 1)
    xi[1] = 3.0
    own, numbers = drawn(prepared, xi)
    assert own.properties.n_variables > prepared.properties.n_variables  # a longer scale takes a larger torus
    other = xi.copy()
    other[0] = -xi[0]
    np.testing.assert_array_equal(drawn(prepared, other)[1], numbers)
    np.testing.assert_array_equal(
        realise_fields(prepared.study, 1, xi=xi)["cohesion"], realise_fields(prepared.study, 9, xi=other)["cohesion"]
    )


def test_a_vector_of_another_length_is_refused(study):
    prepared = prepare(uncertain(study, PEAK))
    with pytest.raises(ValueError, match=r"must be \(\d+,\), as this study"):
        run(prepared, 0, xi=np.zeros(prepared.n_variables - 1))


def test_a_dataset_labels_the_values(study, tmp_path):
    asked = uncertain(study, PEAK, FRICTION)
    prepared = prepare(asked)
    rows = [run(prepared, index) | {"attempt": 1} for index in (1, 0)]
    labelled = results.dataset(rows, asked)
    assert labelled["uncertain_value"].dims == ("realisation", "uncertain")
    assert list(labelled["uncertain"].values) == [PEAK["key"], FRICTION["key"]]
    np.testing.assert_array_equal(labelled["uncertain_value"].values[0], rows[1]["uncertain_value"])
    columns = results.columns(rows, asked) | {"origin": np.zeros(2, "i4")}
    results.write_ensemble(tmp_path / "ensemble.nc", asked, 2, [columns])
    stored = results.open_ensemble(tmp_path / "ensemble.nc")
    assert stored["uncertain_value"].equals(labelled["uncertain_value"])
    assert stored.attrs["content_hash"] == labelled.attrs["content_hash"]


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ({"key": "material.0.cohesion"}, r"did you mean material\.0\.cohesion_kpa\?"),
        ({"key": "discretisation.cell_m"}, r"number of material, boundary or random_field"),
        ({"key": "material.0.softening_reference_cell_m"}, r"number of material, boundary or random_field"),
        ({"key": "material.0.law"}, r"number of material, boundary or random_field"),
        (
            {"key": "material.0.poissons_ratio", "mean": 0.4},
            r"reaches 0\.866\d* at its high end: must be at most 0\.49",
        ),
        ({"key": "material.0.youngs_modulus_kpa", "mean": 200.0}, r"low end, and then material\.0\.youngs_modulus_kpa"),
        ({"mean": 0.0}, r"uncertain\.0\.mean = 0\.0: must be greater than 0"),
        ({"low": 1.0}, r"must have mean and coefficient_of_variation where it is \"lognormal\""),
        ({"distribution": "uniform", "low": 1.0}, r"must have mean and coefficient_of_variation, or low and high"),
        ({"distribution": "normal_truncated", "coefficient_of_variation": 1.0}, r"must be less than 0\.99"),
    ],
)
def test_what_may_not_be_uncertain_is_said(study, entry, text):
    with pytest.raises(StudyError, match=text) as refused:
        uncertain(study, PEAK | entry)
    assert len(refused.value.problems) == 1


def test_two_tables_of_one_key_and_no_table_are_refused(study):
    with pytest.raises(StudyError, match="is uncertain twice"):
        uncertain(study, PEAK, PEAK)
    with pytest.raises(StudyError, match=r"low = 3\.0: must be less than high = 2"):
        uncertain(study, {"key": PEAK["key"], "distribution": "uniform", "low": 3.0, "high": 2.0})
    with pytest.raises(StudyError, match=r"written \[\[uncertain\]\], or be left out"):
        uncertain(study)
    with pytest.raises(StudyError, match="must have a value of its own"):
        uncertain(
            study, {**FRICTION, "key": "material.0.softening_length_m"}, **{"material.0.softening_length_m": None}
        )
