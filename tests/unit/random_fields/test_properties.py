"""Random properties together: parts of xi, covariance between them, layers, and common fields of a slope."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.random_fields import properties
from rfmpm.random_fields.property import Properties, Property
from rfmpm.random_fields.site import Site

CONFIG = Path(__file__).parents[3] / "configs" / "drained_cross_correlated.toml"
PLAIN = {"random_field.cohesion.trend_kpa_per_m": None}


def rewritten(study, changes):
    """Study with changes, where None takes a key out."""
    content = study.model_dump(exclude_none=True)
    for path in [path for path, value in changes.items() if value is None]:
        *parents, last = path.split(".")
        table = content
        for key in parents:
            table = table[key]
        table.pop(last, None)
    return rfmpm.load_study(content).with_changes({p: v for p, v in changes.items() if v is not None})


@pytest.fixture(scope="module")
def study():
    return rewritten(rfmpm.load_study(CONFIG), PLAIN | {"discretisation.cell_m": 1.0})


@pytest.fixture(scope="module")
def site():
    # Middles of some of the squares of half a metre.
    square = np.random.default_rng(3).choice(120, 40, replace=False)
    points = 0.5 * (np.column_stack(np.divmod(square, 10)) + 0.5)
    return Site(points, 1.0, 0.5, 5.0, (10.0, 5.0))


def standard_normal(prepared, name, xi):
    """The field below a lognormal property."""
    values = properties.realise(prepared, xi)[name]
    marginal = prepared.entries[name].parts[0].field.marginal
    field = np.tan(values) if name == "friction_angle" else values
    return (np.log(field) - marginal.log_mean) / marginal.log_standard_deviation


def linear_map(prepared, name):
    units = np.eye(prepared.n_variables)
    return np.array([standard_normal(prepared, name, unit) for unit in units]).T


def asked_rho(study, points):
    field = study.random_field["cohesion"]
    lag = points[:, None] - points[None, :]
    h, v = lag[..., 0] / field.scale_of_fluctuation_h_m, lag[..., 1] / field.scale_of_fluctuation_v_m
    return np.exp(-2.0 * np.hypot(h, v))


def test_where_squares_are_cut_a_lattice_method_takes_their_middles_and_cholesky_their_points():
    study = rfmpm.load_study(CONFIG.parent / "short_slope_random.toml")
    prepared = {}
    for method in ("auto", "cholesky"):
        changed = study.with_changes({"random_field.cohesion.method": method})
        prepared[method] = realisation.prepare(changed).fields["cohesion"].parts[0]
    points, middles = prepared["cholesky"].points, prepared["auto"].points
    assert prepared["auto"].field.method == "ar1"
    square = 0.5 * study.discretisation.cell_m
    apart = np.abs(middles - points).max(axis=1)
    cut = apart > 1e-9
    assert 0 < cut.sum() == 40  # twenty cells of the face, two squares each
    assert apart.max() == pytest.approx(square / 6.0)  # the centroid of a triangle is a third of a side from the corner


def test_covariance_within_and_between_properties(study, site):
    prepared = properties.prepare(study, site)
    cohesion, friction = (linear_map(prepared, name) for name in ("cohesion", "friction_angle"))
    rho = asked_rho(study, site.points)
    # Exact but for the rounding of logarithms of values, relative to which unit variances are small: 1e-16 / s.
    np.testing.assert_allclose(cohesion @ cohesion.T, rho, rtol=0, atol=1e-11)
    np.testing.assert_allclose(friction @ friction.T, rho, rtol=0, atol=1e-11)
    np.testing.assert_allclose(cohesion @ friction.T, -0.5 * rho, rtol=0, atol=1e-11)


def test_properties_of_one_correlation_share_what_was_prepared(study, site):
    first, second = (entry.parts[0].field for entry in properties.prepare(study, site).entries.values())
    assert first.record is second.record
    changed = rewritten(
        study, {"random_field_correlation": None, "random_field.friction_angle.scale_of_fluctuation_h_m": 2.0}
    )
    first, second = (entry.parts[0].field for entry in properties.prepare(changed, site).entries.values())
    assert first.record is not second.record


def test_properties_take_their_parts_of_xi_in_the_order_of_the_study(study, site):
    independent = properties.prepare(rewritten(study, {"random_field_correlation": None}), site)
    n = len(site.points)
    assert independent.n_variables == 2 * n
    xi = np.random.default_rng(0).standard_normal(2 * n)
    both = properties.realise(independent, xi)
    changed = properties.realise(independent, np.concatenate([xi[:n], -xi[n:]]))
    assert list(both) == ["cohesion", "friction_angle"]
    np.testing.assert_array_equal(both["cohesion"], changed["cohesion"])
    assert not np.any(both["friction_angle"] == changed["friction_angle"])
    # A correlation leaves the first field of the table as it is.
    np.testing.assert_array_equal(properties.realise(properties.prepare(study, site), xi)["cohesion"], both["cohesion"])


def test_median_and_largest_friction_angle(study, site):
    prepared = properties.prepare(study, site)
    zero = np.zeros(prepared.n_variables)
    median = np.tan(np.radians(25.0)) / np.sqrt(1.0 + 0.12**2)
    np.testing.assert_allclose(np.tan(properties.realise(prepared, zero)["friction_angle"]), median, rtol=1e-12)
    high = properties.realise(prepared, zero + 100.0)["friction_angle"]
    assert high.max() == np.radians(80.0)


@pytest.mark.parametrize("count", [0, 79, 81])
def test_xi_of_another_length_is_refused(study, site, count):
    with pytest.raises(ValueError, match=r"must be \(80,\), as this study's fields take"):
        properties.realise(properties.prepare(study, site), np.zeros(count))


def test_correlated_properties_that_vary_differently_are_refused(study, site):
    friction = study.random_field["friction_angle"].model_copy(update={"scale_of_fluctuation_h_m": 3.0})
    unlike = study.model_copy(update={"random_field": study.random_field | {"friction_angle": friction}})
    with pytest.raises(ValueError, match="give both fields the same correlation, scales of fluctuation, rotation"):
        properties.prepare(unlike, site)


LAYERS = [
    {"top_m": 3.0, "dip_deg": -10.0, "mean_kpa": 12.0, "coefficient_of_variation": 0.1},
    {"top_m": 1.5, "scale_of_fluctuation_h_m": 2.0},
]


@pytest.fixture(scope="module")
def layered(study):
    changes = {"random_field_correlation": None, "random_field.friction_angle": None}
    return rewritten(study, changes | {"random_field.cohesion.layer": LAYERS})


def test_layers_have_their_own_moments_scales_rotation_and_variables(layered, site):
    prepared = properties.prepare(layered, site)
    parts = prepared.entries["cohesion"].parts
    assert [part.mean for part in parts] == [5e3, 12e3, 5e3]
    assert [part.field.correlation.rotation for part in parts] == [0.0, np.radians(-10.0), 0.0]
    assert [part.field.correlation.theta_h for part in parts] == [6.0, 6.0, 2.0]
    counts = [part.field.n_variables for part in parts]
    assert sum(counts) == prepared.n_variables == len(site.points)
    xi = np.random.default_rng(4).standard_normal(prepared.n_variables)
    before = properties.realise(prepared, xi)["cohesion"]
    xi[: counts[0]] *= -1.0
    changed = properties.realise(prepared, xi)["cohesion"] != before
    np.testing.assert_array_equal(np.flatnonzero(changed), parts[0].members)
    medians = properties.realise(prepared, np.zeros(prepared.n_variables))["cohesion"]
    np.testing.assert_allclose(medians[parts[1].members], 12e3 / np.sqrt(1.01), rtol=1e-12)


def test_a_soil_without_points_is_refused_by_its_place(layered, site):
    lowest, highest = site.points[site.points[:, 1] < 1.5], site.points[site.points[:, 1] > 4.0]
    with pytest.raises(ValueError, match=r"random_field\.cohesion: layer: no point lies in this soil"):
        properties.prepare(layered, site._replace(points=lowest))
    with pytest.raises(ValueError, match=r"random_field\.cohesion: layer\.0: no point lies in this soil"):
        properties.prepare(layered, site._replace(points=highest))


def test_layers_and_correlation_together(study, site):
    layers = [{"top_m": 2.5, "scale_of_fluctuation_h_m": 2.0}]
    both = {f"random_field.{name}.layer": layers for name in ("cohesion", "friction_angle")}
    prepared = properties.prepare(rewritten(study, both), site)
    cohesion, friction = (linear_map(prepared, name) for name in ("cohesion", "friction_angle"))
    np.testing.assert_allclose(cohesion @ friction.T, -0.5 * cohesion @ cohesion.T, rtol=0, atol=1e-11)
    upper = site.points[:, 1] >= 2.5
    assert np.all((cohesion @ cohesion.T)[np.ix_(upper, ~upper)] == 0.0)


def test_a_trend_scales_the_median_with_depth(study):
    trending = study.with_changes({"random_field.cohesion.trend_kpa_per_m": 0.5})
    prepared = realisation.prepare(trending)
    median = properties.realise(prepared.properties, np.zeros(prepared.properties.n_variables))["cohesion"]
    depth = 5.0 - prepared.fields["cohesion"].parts[0].points[:, 1]
    np.testing.assert_allclose(median, (5e3 + 500.0 * depth) / np.sqrt(1.09), rtol=1e-12)


def by_square(study):
    """Cohesion of each square of one realisation, by its lower left corner, and the length of xi."""
    prepared = realisation.prepare(study)
    xi = realisation.draw_xi(prepared, 7)
    cohesion = properties.realise(prepared.properties, xi)["cohesion"]
    square = study.discretisation.cell_m / np.sqrt(study.discretisation.points_per_cell)
    corners = np.floor(np.column_stack(prepared.scene.points.position) / square + 1e-9).astype(int)
    return dict(zip(map(tuple, corners), cohesion, strict=True)), xi


@pytest.mark.parametrize(("value", "per_cell"), [("mean", 4), ("point", 1)])
def test_the_same_xi_on_three_grids(study, value, per_cell):
    changes = {"random_field_correlation": None, "random_field.friction_angle": None}
    changes |= {"random_field.cohesion.reference_cell_m": 0.125, "random_field.cohesion.reference_value": value}
    changes |= {"random_field.cohesion.trend_kpa_per_m": 0.5, "discretisation.points_per_cell": per_cell}
    changes |= {"geometry.height_m": 2.0, "geometry.crest_m": 1.0, "discretisation.cell_m": 0.5}
    one = rewritten(study, changes)
    (coarse, xi), (medium, xi_medium), (fine, xi_fine) = (
        by_square(one.with_changes({"discretisation.cell_m": cell})) for cell in (0.5, 0.25, 0.125)
    )
    np.testing.assert_array_equal(xi, xi_medium)
    np.testing.assert_array_equal(xi, xi_fine)
    if value == "mean":
        for larger, smaller, ratio in ((coarse, medium, 2), (medium, fine, 2), (coarse, fine, 4)):
            whole = 0
            for (i, j), mean in larger.items():
                children = [(ratio * i + a, ratio * j + b) for a in range(ratio) for b in range(ratio)]
                if all(child in smaller for child in children):
                    whole += 1
                    assert mean == pytest.approx(np.mean([smaller[child] for child in children]), rel=1e-12)
            assert whole > 0.5 * len(larger)  # all but the squares that the face cuts
    else:
        prepared = realisation.prepare(one)
        carried = properties.realise(Properties({"cohesion": _all_of_the_lattice(prepared)}, None), xi)["cohesion"]
        (part,) = prepared.fields["cohesion"].parts
        at_place = dict(zip(map(tuple, np.round(part.points, 6)), carried, strict=True))
        for values, square in ((coarse, 0.5), (medium, 0.25), (fine, 0.125)):  # one point per cell
            for (i, j), own in values.items():
                assert own == at_place[round((i + 0.5) * square, 6), round((j + 0.5) * square, 6)]


def _all_of_the_lattice(prepared):
    """The property with every lattice point a material point."""
    entry = prepared.fields["cohesion"]
    return Property(entry.name, entry.parts, entry.count, None)
