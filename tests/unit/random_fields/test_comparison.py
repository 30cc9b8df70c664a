"""Random properties compared with what was asked: soil by soil, mixed, conditioned, averaged."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.random_fields import properties
from rfmpm.random_fields.comparison import compare_properties, shares_of
from rfmpm.random_fields.field import prepare
from rfmpm.random_fields.gaussian_space import space_map
from rfmpm.random_fields.statistics import ask, conditional_normal, variance_of_mean

CONFIGS = Path(__file__).parents[3] / "configs"
PAIR = ("cohesion", "friction_angle")
COUNT = 300


@pytest.fixture(scope="module")
def drained():
    study = rfmpm.load_study(CONFIGS / "drained_cross_correlated.toml")
    exact = {f"random_field.{name}.method": "cholesky" for name in PAIR}
    return study.with_changes(exact | {"discretisation.cell_m": 1.0})


@pytest.fixture(scope="module")
def with_data(drained):
    data = [{"x_m": 2.0, "y_m": y, "value": value} for y, value in ((4.5, 4.0), (3.1, 7.5), (1.2, 6.0))]
    layer = [{"top_m": 2.5, "dip_deg": 5.0}]
    keys = {"random_field.cohesion.data": data} | {f"random_field.{name}.layer": layer for name in PAIR}
    return realisation.prepare(drained.with_changes(keys)).properties


def linear_map(prepared) -> tuple[dict, dict]:
    """Mean, shape (n,), and factor of the covariance, shape (n, n_variables), of each standard-normal field."""
    mean = properties.standard_normal(prepared, np.zeros(prepared.n_variables))
    columns = [properties.standard_normal(prepared, unit) for unit in np.eye(prepared.n_variables)]
    return mean, {name: np.array([column[name] - mean[name] for column in columns]).T for name in mean}


def draws(prepared, count=COUNT, seed=7):
    generator = np.random.default_rng(seed)
    return [generator.standard_normal(prepared.n_variables) for _ in range(count)]


def departures(statistics) -> list[float]:
    return [abs(s.found - s.asked) / s.standard_error for s in statistics]


def test_what_is_asked_of_mixed_fields_with_data_and_layers_is_what_their_linear_map_has(with_data):
    mean, factor = linear_map(with_data)
    for name, entry in with_data.entries.items():
        for number, part in enumerate(entry.parts):
            shares = shares_of(with_data, name, number)
            asked = ask(part.at_crest, part.settings, part.mean, part.points, shares)
            own = factor[name][part.members]
            centre, deviation = conditional_normal(shares)
            # identity: the factors of Cholesky and of the data
            np.testing.assert_allclose(centre, mean[name][part.members], rtol=0, atol=1e-9)
            np.testing.assert_allclose(deviation**2, np.sum(own**2, axis=1), rtol=0, atol=1e-9)
            assert len(asked.pairs) > 5
            for pair in asked.pairs:
                covariance = np.mean(np.sum(own[pair.first] * own[pair.second], axis=1))
                assert pair.asked == pytest.approx(covariance, abs=1e-9)


def test_the_asked_correlation_between_properties_is_what_the_linear_map_has(with_data, drained):
    plain = realisation.prepare(drained).properties
    for prepared, name in ((with_data, "cross_covariance"), (plain, "cross_correlation")):
        _, factor = linear_map(prepared)
        (cross,) = compare_properties(prepared, [PAIR], draws(prepared, 2)).cross
        expected = np.mean(np.sum(factor["cohesion"] * factor["friction_angle"], axis=1))
        assert cross.statistic.asked == pytest.approx(expected, abs=1e-9)  # identity
        assert (cross.between, cross.statistic.name) == (PAIR, name)
    assert expected == pytest.approx(-0.5, abs=1e-9)


def test_found_is_asked_in_every_soil_of_every_property(with_data):
    found = compare_properties(with_data, [PAIR], draws(with_data))
    assert [soil.part.soil for soil in found.soils["cohesion"]] == [0, 1]
    for soils in found.soils.values():
        for soil in soils:
            assert max(departures(soil.statistics)) < 4.0  # standard errors
    assert max(departures([found.cross[0].statistic])) < 4.0
    assert len(found.first_two) == 2


def test_a_soil_is_judged_by_its_own_settings():
    study = rfmpm.load_study(CONFIGS / "short_slope_random.toml").with_changes(
        {
            "discretisation.cell_m": 0.5,
            "random_field.cohesion.layer": [
                {"top_m": 3.0, "mean_kpa": 40.0, "coefficient_of_variation": 0.1, "scale_of_fluctuation_h_m": 2.0}
            ],
        }
    )
    prepared = realisation.prepare(study).properties
    above, layer = compare_properties(prepared, [], draws(prepared)).soils["cohesion"]
    assert [s.asked for s in above.statistics[:2]] == [20e3, 5e3]
    assert [s.asked for s in layer.statistics[:2]] == [40e3, 4e3]
    assert [s.lag for s in layer.statistics if s.name == "correlation_h"][:2] == [0.5, 1.0]
    for soil in (above, layer):
        assert max(departures(soil.statistics)) < 4.0


@pytest.mark.parametrize(("value", "has_means"), [("mean", True), ("point", False)])
def test_means_over_reference_points_have_the_asked_variance(value, has_means):
    keys = {"reference_cell_m": 0.125, "reference_value": value, "nugget": 0.2, "method": "auto"}
    study = rfmpm.load_study(CONFIGS / "short_slope_random.toml").with_changes(
        {"discretisation.cell_m": 0.5} | {f"random_field.cohesion.{key}": own for key, own in keys.items()}
    )
    prepared = realisation.prepare(study).properties
    (soil,) = compare_properties(prepared, [], draws(prepared, 100)).soils["cohesion"]
    assert bool(soil.of_means) == has_means
    if has_means:
        mean, deviation = soil.of_means
        assert mean.asked == 20e3
        assert 4e3 < deviation.asked < 4.8e3
        assert max(departures(soil.of_means)) < 4.0


def test_variance_of_a_mean_is_the_mean_of_all_correlations_of_the_values(settings):
    settings.nugget = 0.3
    x, y = (mesh.ravel() for mesh in np.meshgrid(0.1 + 0.2 * np.arange(4), 0.3 + 0.1 * np.arange(3)))
    prepared = prepare(settings, 20e3, np.column_stack([x, y]))
    lags = (np.subtract.outer(x, x), np.subtract.outer(y, y))
    lags = tuple(np.where(np.abs(lag) < 1e-9, 0.0, lag) for lag in lags)
    expected = np.mean(space_map(prepared.marginal).to_physical(prepared.correlation.rho(*lags)))
    assert variance_of_mean(prepared, np.column_stack([x, y])) == pytest.approx(expected, rel=1e-12)  # identity
    assert expected < 0.9


def test_exact_data_on_points_are_met_and_a_field_without_own_data_says_nothing_of_them(drained):
    prepared = realisation.prepare(drained)
    points = prepared.fields["cohesion"].parts[0].points
    data = [{"x_m": float(x), "y_m": float(y), "value": 5.0} for x, y in points[[3, 40, 90]]]
    conditioned = realisation.prepare(drained.with_changes({"random_field.cohesion.data": data})).properties
    soils = compare_properties(conditioned, [], draws(conditioned, 5)).soils
    assert soils["cohesion"][0].misfit < 1e-9  # as the outcome asks
    assert np.isnan(soils["friction_angle"][0].misfit)


def test_one_realisation_is_refused(drained):
    prepared = realisation.prepare(drained).properties
    with pytest.raises(ValueError, match="two or more"):
        compare_properties(prepared, [PAIR], draws(prepared, 1))
