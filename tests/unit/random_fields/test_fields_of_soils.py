"""Fields of several materials realised together: each on its own points, independent, or one through all of them."""

from copy import deepcopy
from functools import cache

import numpy as np
import pytest
from three_soils import CLAY, FIELD, ROCK
from three_soils import SAND as STEADY_SAND

import rfmpm
from rfmpm import realisation
from rfmpm.field_influence import field_influence
from rfmpm.random_fields import properties
from rfmpm.random_fields.principal_components import principal_components

SAND = STEADY_SAND | {"residual_cohesion_kpa": 1.0, "residual_plastic_strain": 0.5}
ROUGH = FIELD | {"coefficient_of_variation": 0.5, "correlation": "gaussian", "scale_of_fluctuation_h_m": 2.0}
REGIONS = [  # the rock in the middle: the other two are no neighbours in the order of the points
    {"name": "up", "material": "clay", "corners_m": [[0, 4], [6, 4], [4, 6], [0, 6]]},
    {"name": "middle", "material": "rock", "corners_m": [[0, 3], [7, 3], [6, 4], [0, 4]]},
    {"name": "down", "material": "sand", "corners_m": [[0, 0], [10, 0], [7, 3], [0, 3]]},
]


def study_of(clay=None, sand=None, pairs=None, **more):
    """Clay on rock on sand, with their fields by variable."""
    own = [CLAY | {"random_field": clay or {}}, ROCK, SAND | {"random_field": sand or {}}]
    if pairs:
        own[2]["random_field_correlation"] = pairs
    return rfmpm.load_study(
        deepcopy(
            {
                "study": {"name": "three soils", "seed": 1},
                "geometry": {"kind": "regions", "foreland_m": 4.0, "region": REGIONS},
                "discretisation": {"cell_m": 0.5, "points_per_cell": 4, "shape": "linear"},
                "boundary": {"base": {"kind": "fixed"}, "sides": {"kind": "roller"}},
                "material": own,
                "time": {"end_s": 0.2},
                "output": {"directory": "results"},
            }
            | more
        )
    )


@cache
def counts():
    """Points of clay, rock and sand, the same in every study here."""
    return realisation.prepare(study_of()).scene.soils.counts


def parts_of(values):
    """Values at the points of clay, rock and sand."""
    return np.split(values, np.cumsum(counts())[:-1])


def normal(values, mean, variation):
    """The standard-normal field below a lognormal one."""
    deviation = np.sqrt(np.log1p(variation**2))
    return (np.log(values / mean) + 0.5 * deviation**2) / deviation


def sample(study, count=300):
    prepared = realisation.prepare(study).properties
    xis = np.random.default_rng(5).standard_normal((count, prepared.n_variables))
    return [properties.realise(prepared, xi) for xi in xis]


def test_two_soils_have_fields_of_their_own_about_their_own_means():
    study = study_of({"cohesion": FIELD}, {"cohesion": ROUGH})
    clay, rock, sand = zip(*(parts_of(one["cohesion"]) for one in sample(study)), strict=True)
    assert np.isnan(rock).all()
    for own, mean, variation in ((clay, 17e3, 0.25), (sand, 4e3, 0.5)):
        z = normal(np.array(own), mean, variation)
        # means over the points of each realisation are independent: four standard errors of theirs
        means = z.mean(axis=1)
        assert abs(means.mean()) < 4.0 * means.std(ddof=1) / np.sqrt(len(means))
        squares = (z**2).mean(axis=1)
        assert abs(squares.mean() - 1.0) < 4.0 * squares.std(ddof=1) / np.sqrt(len(squares))


def test_fields_of_two_soils_take_different_parts_of_xi():
    study = study_of({"cohesion": FIELD}, {"cohesion": ROUGH})
    prepared = realisation.prepare(study).properties
    n = prepared.n_variables
    at_zero = properties.realise(prepared, np.zeros(n))["cohesion"]
    moved = np.array([properties.realise(prepared, unit)["cohesion"] != at_zero for unit in np.eye(n)])
    clay, _, sand = (one.T for one in np.split(moved, np.cumsum(counts())[:-1], 1))
    assert not np.any(clay.any(axis=0) & sand.any(axis=0))
    assert clay.any()
    assert sand.any()


def test_a_soil_s_field_does_not_change_where_another_soil_gets_one_after_it():
    one, both = (
        study_of({"cohesion": FIELD}),
        study_of({"cohesion": FIELD}, {"cohesion": ROUGH, "friction_angle": FIELD}),
    )
    (first, _, mean), (again, _, sand) = (parts_of(rfmpm.realise_fields(study, 3)["cohesion"]) for study in (one, both))
    np.testing.assert_array_equal(first, again)
    assert set(mean) == {4e3}
    assert len(set(sand)) > 100


def test_a_table_of_the_material_gives_what_one_of_the_study_gives():
    own = study_of(sand={"cohesion": FIELD, "friction_angle": FIELD})
    named = {name: FIELD | {"material": "sand"} for name in ("cohesion", "friction_angle")}
    wide = study_of(random_field=named)
    for name, values in rfmpm.realise_fields(own, 5).items():
        np.testing.assert_array_equal(values, rfmpm.realise_fields(wide, 5)[name])


def test_a_shared_field_runs_through_the_border_in_proportion_to_the_means():
    shared = FIELD | {"material": "sand", "shared_with": ["clay"]}
    study = study_of(random_field={"cohesion": shared})
    prepared = realisation.prepare(study)
    entry, (_, _, first) = prepared.fields["cohesion"], counts()
    z = properties.standard_normal(prepared.properties, realisation.draw_xi(prepared, 0))["cohesion"]
    clay, rock, sand = parts_of(rfmpm.realise_fields(study, 0)["cohesion"])
    assert np.isnan(rock).all()
    np.testing.assert_allclose(normal(sand, 4e3, 0.25), z[:first], rtol=0, atol=1e-12)
    np.testing.assert_allclose(normal(clay, 17e3, 0.25), z[first:], rtol=0, atol=1e-12)
    # one field: its linear map has the asked covariance between points of different soils, too
    units = np.eye(entry.n_variables)
    columns = np.array([properties.standard_normal(prepared.properties, unit)["cohesion"] for unit in units])
    (part,) = entry.parts
    lag = np.abs(part.points[0] - part.points[first:])
    asked = np.exp(-2.0 * (lag[:, 0] / 6.0 + lag[:, 1] / 1.0))
    np.testing.assert_allclose(columns[:, 0] @ columns[:, first:], asked, rtol=0, atol=1e-10)


def test_fields_of_one_material_may_be_correlated():
    pair = [{"between": ["cohesion", "friction_angle"], "coefficient": -0.5}]
    prepared = realisation.prepare(study_of({"cohesion": ROUGH}, {"cohesion": FIELD, "friction_angle": FIELD}, pair))
    found = prepared.properties
    units = np.eye(found.n_variables)
    names = ("cohesion of clay", "cohesion of sand", "friction_angle of sand")
    columns = [properties.standard_normal(found, unit) for unit in units]
    clay, cohesion, friction = (np.array([one[name] for one in columns]).T for name in names)
    np.testing.assert_allclose(cohesion @ friction.T, -0.5 * cohesion @ cohesion.T, rtol=0, atol=1e-11)
    assert np.all(clay @ friction.T == 0.0)


def test_each_soil_has_its_own_layers_lattice_and_data():
    datum = {"x_m": 2.125, "y_m": 2.125, "value": 6.0}
    sand = FIELD | {"layer": [{"top_m": 1.5, "mean_kpa": 9.0}], "data": [datum]}
    study = study_of({"cohesion": ROUGH | {"reference_cell_m": 0.25}}, {"cohesion": sand})
    prepared = realisation.prepare(study)
    names = list(prepared.fields)
    assert names == ["cohesion of clay", "cohesion of sand"]
    assert prepared.fields[names[0]].taken.shape[1] == 4
    assert [part.mean for part in prepared.fields[names[1]].parts] == [4e3, 9e3]
    points = np.column_stack(prepared.scene.points.position)
    at = np.flatnonzero(np.all(np.abs(points - [2.125, 2.125]) < 1e-9, axis=1))
    for index in range(3):
        np.testing.assert_allclose(rfmpm.realise_fields(study, index)["cohesion"][at], 6e3, rtol=1e-9)


def test_the_residual_follows_the_peak_of_each_soil():
    study = study_of({"cohesion": FIELD}, {"cohesion": ROUGH})
    cohesion = rfmpm.realise_fields(study, 2)["cohesion"]
    laws, _ = realisation.prepare(study).scene.soils.laws(0.5, {"cohesion": cohesion})
    clay, _, sand = parts_of(cohesion)
    np.testing.assert_allclose(laws.records[0].residual, clay * 4.0 / 17.0, rtol=1e-12)
    np.testing.assert_allclose(laws.records[2].residual, sand * 1.0 / 4.0, rtol=1e-12)


def test_components_and_influence_know_each_soil():
    study = study_of({"cohesion": FIELD}, {"cohesion": ROUGH})
    prepared = realisation.prepare(study)
    found = principal_components(prepared.properties, 5)
    assert found.directions.shape == (5, prepared.n_variables)
    fields = (properties.realise(prepared.properties, realisation.draw_xi(prepared, index)) for index in range(60))
    influence = field_influence(prepared, range(60), np.array([parts_of(one["cohesion"])[2].mean() for one in fields]))
    assert influence["cohesion of sand"].is_significant.any()
    assert influence["cohesion of clay"].correlation.shape == (counts()[0],)
    assert (
        np.abs(influence["cohesion of clay"].correlation).mean()
        < np.abs(influence["cohesion of sand"].correlation).mean()
    )


def test_the_factor_of_safety_counts_the_fields_of_all_soils():
    study = study_of({"cohesion": FIELD}, {"cohesion": ROUGH})
    prepared = realisation.prepare(study)
    _, strength = realisation.stability(prepared, "bishop", index=4)
    cohesion = rfmpm.realise_fields(study, 4)["cohesion"]
    for place in (0, 2):
        np.testing.assert_array_equal(parts_of(strength.cohesion)[place], parts_of(cohesion)[place])


@pytest.mark.parametrize("index", [0, 7])
def test_the_same_xi_makes_the_same_fields_on_coarser_cells(index):
    from rfmpm.planning.levels import studies_by_level

    question = {"name": "q", "seed": 1, "until": {"quantity": "run_out", "exceeds_m": 1.0, "half_width": 0.1}}
    estimator = {"method": "multilevel", "coarser_cells_m": [1.0]}
    study = study_of({"cohesion": FIELD}, {"cohesion": ROUGH}, study=question, estimator=estimator)
    fine, coarse = (realisation.prepare(level) for level in studies_by_level(study))
    assert fine.n_variables == coarse.n_variables
    xi = realisation.draw_xi(fine, index)
    for name in fine.fields:
        one, other = (properties.standard_normal(level.properties, xi)[name] for level in (fine, coarse))
        np.testing.assert_array_equal(one, other)
