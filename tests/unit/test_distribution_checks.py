"""Keys of a random field's distribution, correlation and averaging: what they need of each other."""

from pathlib import Path

import numpy as np
import pytest
from cohesion_field import FIELD, changed, problems_of

from rfmpm.random_fields.marginals import beta, bounded_tanh, empirical
from rfmpm.study import StudyError, distribution_checks, load_study

RANDOM = Path(__file__).parents[2] / "configs" / "short_slope_random.toml"
SAMPLE = [float(value) for value in range(10, 30)]
EMPIRICAL = {"distribution": "empirical", "sample": SAMPLE}
BETA = {"distribution": "beta", "upper_over_mean": 2.0}


@pytest.fixture
def study():
    return load_study(RANDOM)


@pytest.mark.parametrize(
    "keys",
    [
        BETA,
        BETA | {"lower_over_mean": 0.5},
        BETA | {"distribution": "bounded_tanh"},
        EMPIRICAL,
        {"distribution": "gamma", "coefficient_of_variation": 2.0},
        {"distribution": "weibull", "coefficient_of_variation": 0.01},
        {"correlation": "matern", "matern_nu": 2.5},
        {"correlation": "spherical", "correlation_space": "physical", "nugget": 0.2},
        {"correlation": "cosine_exponential"},
        {"correlation": "second_order_markov", "averaging": "volume"},
    ],
    ids=str,
)
def test_what_fits_together_is_accepted_and_written_out(study, keys):
    accepted = changed(study, keys)
    assert load_study(accepted.to_toml()) == accepted
    assert accepted.physics_hash != study.physics_hash


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"distribution": "beta"}, f'{FIELD}.upper_over_mean: missing; distribution = "beta" needs a number greater'),
        ({"distribution": "empirical"}, f"{FIELD}.sample: missing"),
        ({"correlation": "matern"}, f"{FIELD}.matern_nu: missing; correlation"),
        ({"matern_nu": 1.5}, f"{FIELD}.matern_nu = 1.5: has no meaning where correlation = "),
        ({"lower_over_mean": 0.5}, f'{FIELD}.lower_over_mean = 0.5: has no meaning where distribution = "lognormal"'),
        ({"upper_over_mean": 2.0}, f"{FIELD}.upper_over_mean = 2.0: has no meaning"),
        (BETA | {"coefficient_of_variation": 0.85}, "must be less than 0.8452 between these bounds"),
        (BETA | {"upper_over_mean": 1.1, "distribution": "bounded_tanh", "coefficient_of_variation": 0.4},
         "must be less than 0.3 between"),
        (EMPIRICAL | {"sample": SAMPLE[:9]}, f"{FIELD}.sample: has 9 values: must be at least 10"),
        (EMPIRICAL | {"sample": 3.0}, f"{FIELD}.sample = 3.0: must be a list, each a number greater than 0"),
        (EMPIRICAL | {"sample": [3.0] * 10}, f"{FIELD}.sample: has equal values only"),
        (EMPIRICAL | {"sample": [*SAMPLE, -1.0]}, f"{FIELD}.sample.20 = -1.0: must be greater than 0"),
        (EMPIRICAL | {"sample": [*SAMPLE, "a"]}, f'{FIELD}.sample.20 = "a": must be a number greater than 0'),
        ({"averaging": "volume", "nugget": 0.1}, f"{FIELD}.nugget = 0.1: must be 0 where averaging"),
        ({"sample_file": "values.csv"}, "is read where a study is loaded"),
    ],
    ids=str,
)  # fmt: skip
def test_what_does_not_fit_is_refused_by_its_path_with_what_to_change(study, keys, said):
    problems = [problem for problem in problems_of(study, keys) if said in problem]
    assert len(problems) == 1


def test_everything_is_said_at_once(study):
    keys = {"distribution": "beta", "correlation": "matern", "nugget": 0.2, "averaging": "volume"}
    assert len(problems_of(study, keys)) == 3


def test_limits_are_those_of_the_distributions():
    assert distribution_checks.LOWEST_BETA_PARAMETER == beta.LOWEST_PARAMETER
    assert distribution_checks.HIGHEST_TANH_SHARE == bounded_tanh.HIGHEST_SHARE
    assert distribution_checks.SMALLEST_SAMPLE == empirical.SMALLEST_SAMPLE
    for distribution in (beta.Beta, bounded_tanh.BoundedTanh):
        highest = 0.845154 if distribution is beta.Beta else np.sqrt(0.9)  # between 0 and twice the mean
        bounds = {"lower_over_mean": 0.0, "upper_over_mean": 2.0}
        distribution.from_moments(1.0, highest - 1e-5, **bounds)
        with pytest.raises(ValueError, match="must be less than"):
            distribution.from_moments(1.0, highest + 1e-5, **bounds)


# --- samples from a file


def csv_of(values):
    return "value\n" + "\n".join(map(str, values))


def write_study(folder, text, sample):
    (folder / "values.csv").write_text(sample)
    study = RANDOM.read_text().replace('distribution = "lognormal"', text)
    (folder / "study.toml").write_text(study)
    return folder / "study.toml"


FROM_FILE = 'distribution = "empirical"\nsample_file = "values.csv"'


def test_a_file_beside_the_study_becomes_the_sample(study, tmp_path):
    loaded = load_study(write_study(tmp_path, FROM_FILE, csv_of(SAMPLE)))
    assert loaded == changed(study, EMPIRICAL)
    assert loaded.random_field["cohesion"].sample_file is None


def test_the_values_of_a_file_are_part_of_the_physics(tmp_path):
    first = load_study(write_study(tmp_path, FROM_FILE, csv_of(SAMPLE)))
    other = load_study(write_study(tmp_path, FROM_FILE, csv_of([11.0, *SAMPLE[1:]])))
    assert first.physics_hash != other.physics_hash


@pytest.mark.parametrize(
    ("text", "sample", "said"),
    [
        (
            FROM_FILE,
            "value\n1\n-2\n3",
            f'{FIELD}.sample_file = "values.csv": line 3: value = -2: must be greater than 0',
        ),
        (FROM_FILE, "depth\n1\n2", "the header has no column value"),
        (FROM_FILE, "value\n1\nx", "line 3: value = 'x': must be a finite number"),
        (FROM_FILE.replace("values.", "other."), "value\n1", "cannot be read: No such file"),
        (FROM_FILE + "\nsample = [1.0, 2.0]", "value\n1", "cannot be given together with sample"),
    ],
    ids=range(5),
)
def test_what_is_wrong_with_a_file_is_said_by_line_beside_other_problems(tmp_path, text, sample, said):
    path = write_study(tmp_path, text + "\nnugget = 2.0", sample)
    with pytest.raises(StudyError) as refusal:
        load_study(path)
    assert any(said in problem for problem in refusal.value.problems)
    assert any("nugget" in problem for problem in refusal.value.problems)
