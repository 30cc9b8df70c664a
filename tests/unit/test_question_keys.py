"""The question of a study and its estimator: what is refused, in which words, and what belongs to the physics."""

from pathlib import Path

import pytest

import rfmpm
from rfmpm.study import StudyError

CONFIGS = Path(__file__).parents[2] / "configs"
PROBABILITY = {"quantity": "run_out", "exceeds_m": 5.0, "half_width": 0.05, "at_most": 2000}
MEAN = {"quantity": "failure_volume", "half_width_m3_per_m": 0.5}
LEVELS = {"method": "multilevel", "coarser_cells_m": [0.5]}


@pytest.fixture(scope="module")
def study():
    fixed = rfmpm.load_study(CONFIGS / "short_slope_random.toml")
    return fixed.with_changes({"study.realisations": None, "study.until": PROBABILITY})


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"study.realisations": 7}, "study.realisations = 7: must be left out together with study.until"),
        ({"study.until.quantile": 0.9}, "cannot be asked together with exceeds_m"),
        ({"study.until.quantity": "speed"}, "must be one of"),
        (
            {"study.until.quantity": "failure_volume"},
            "does not fit failure_volume, which is in m3_per_m: write exceeds",
        ),
        ({"study.until.half_width": None, "study.until.half_width_m": 0.5}, "of a probability, write half_width"),
        ({"study.until": MEAN | {"half_width": 0.1, "half_width_m3_per_m": None}}, "of a mean or a quantile, write"),
        ({"study.until": MEAN | {"half_width_m": 0.1, "half_width_m3_per_m": None}}, "write half_width_m3_per_m"),
        ({"study.until.relative_half_width": 0.1}, "cannot be given together with half_width"),
        ({"study.until": {"quantity": "run_out"}}, "never ends: give one of"),
        ({"study.until": {"quantity": "run_out", "relative_half_width": 0.1}}, "needs at_most too"),
        ({"study.until.half_width": 0.5}, "must be greater than 0 and less than 0.5"),
        ({"study.until.limit_m": 5.0}, "unknown key"),
        ({"estimator": LEVELS | {"replicate_size": 8}}, "is read by latin_hypercube, sobol alone"),
        ({"estimator": {"coarser_cells_m": [0.5]}}, "is read by multilevel, control_variate, two_phase alone"),
        ({"estimator": {"method": "multilevel"}}, "needs coarser_cells_m"),
        ({"estimator": {"method": "two_phase"}}, "needs one cell size, such as twice"),
        ({"estimator": {"method": "two_phase", "coarser_cells_m": [0.5, 1.0]}}, "needs one cell size, such as twice"),
        (
            {"estimator": {"method": "two_phase", "coarser_cells_m": [0.5]}, "study.until.at_most": 63},
            "at_most = 63: must be at least 64",
        ),
        ({"estimator": LEVELS | {"sampling": "sobol"}}, 'must be "random" where method = "multilevel"'),
        ({"estimator": LEVELS, "random_field": {}}, "has no use where nothing is random"),
        ({"estimator": {"sampling": "sobol"}, "random_field": {}}, 'sampling = "sobol": has no use where nothing'),
        (
            {"estimator": {"sampling": "sobol", "replicate_size": 48}},
            "must be a power of two for sobol; nearest: 32",
        ),
        (
            {"estimator": {"sampling": "sobol"}, "study.until.at_most": 400},
            "tells its error; or let estimator.replicate_size be at most 50",
        ),
        ({"estimator": LEVELS, "study.until": None}, "needs a question"),
        ({"estimator": {"method": "subset_simulation"}, "study.until": MEAN}, "finds a probability of exceeding"),
        ({"estimator": {"method": "stratified"}, "study.until": MEAN}, "finds a probability of exceeding"),
        ({"estimator": {"method": "stratified"}, "study.until.at_most": 199}, "must be at least 200"),
        ({"estimator": {"method": "stratified", "level_size": 50}}, "is read by subset_simulation alone"),
        ({"estimator": LEVELS | {"coarser_cells_m": [0.25]}}, "must be larger than the cells before it, 0.25 m"),
        ({"estimator": LEVELS | {"coarser_cells_m": [1.0, 0.5]}}, "must be larger than the cells before it, 1 m"),
        (
            {"estimator": LEVELS | {"coarser_cells_m": [0.6]}},
            "must be a whole multiple of discretisation.cell_m",
        ),
        ({"estimator": LEVELS | {"coarser_cells_m": [0.75]}}, "does not fit: geometry.height_m = 5.0: must be a"),
        (
            {"estimator": LEVELS, "material.0.softening_reference_cell_m": None, "material.0.softening_length_m": 0.3},
            "coarser_cells_m.0 = 0.5: does not fit: material.0.softening_length_m = 0.3: must be at least 0.5 m",
        ),
    ],
)
def test_refusals(study, changes, sentence):
    with pytest.raises(StudyError) as refusal:
        study.with_changes(changes)
    assert sentence in str(refusal.value)


@pytest.mark.parametrize("estimator", [LEVELS, {"sampling": "sobol"}, {"method": "stratified"}, {}])
def test_defaults_that_are_written_out_are_read_again(study, estimator):
    asked = study.with_changes({"estimator": estimator})
    assert rfmpm.load_study(asked.to_toml()) == asked
    assert asked.study.realisations is None


def test_a_study_without_the_tables_keeps_its_hash():
    # regression: the hash that this study had before there were questions
    study = rfmpm.load_study(CONFIGS / "short_slope_random.toml")
    assert study.physics_hash == "10eb67acf9d207363ded3087e896ddaa621c3f95d33ec08cc5c42c46acae208d"
    assert study.with_changes({"estimator": {"method": "monte_carlo"}}).physics_hash == study.physics_hash


def test_the_question_is_no_physics_and_the_estimator_is(study):
    fixed = study.with_changes({"study.until": None})
    designed = study.with_changes({"estimator": {"sampling": "sobol"}})
    assert fixed.study.realisations == 1
    assert fixed.physics_hash == study.physics_hash != designed.physics_hash
    narrower = designed.with_changes({"study.until.half_width": 0.01})
    assert narrower.physics_hash == designed.physics_hash


@pytest.mark.parametrize("method", ["stratified", "subset_simulation"])
def test_the_limit_is_physics_where_realisations_are_sought_near_it(study, method):
    rare = study.with_changes({"estimator": {"method": method}})
    assert rare.with_changes({"study.until.half_width": 0.01}).physics_hash == rare.physics_hash
    assert rare.with_changes({"study.until.exceeds_m": 9.0}).physics_hash != rare.physics_hash


def test_a_design_that_is_refused_is_not_counted(study):
    with pytest.raises(StudyError) as refusal:
        study.with_changes({"estimator": LEVELS | {"sampling": "sobol"}, "study.until.at_most": 400})
    assert "must be at least" not in str(refusal.value)
