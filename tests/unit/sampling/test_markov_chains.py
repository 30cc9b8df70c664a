"""Vectors of subset simulation: from the rows before them alone, standard-normal as long as nothing is rejected."""

import numpy as np
import pytest

from rfmpm import seeds
from rfmpm.estimators.question import Question
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.subset_simulation import SubsetSimulation
from rfmpm.sampling import MarkovChains

SEED, VARIABLES = 20160901, 1000
ESTIMATOR = SubsetSimulation(Question("run_out", "exceedance", limit=2.6, at_most=5000), 50, 0.2)


def rows_of(values) -> Rows:
    n = len(values)
    return Rows(np.zeros(n, int), np.arange(n), np.asarray(values, float), np.zeros(n, bool), np.ones(n))


def quantity(xi: np.ndarray) -> float:
    """A linear limit state in as many dimensions as there are: standard-normal."""
    return float(xi.sum() / np.sqrt(VARIABLES))


@pytest.fixture(scope="module")
def finished():
    """Vectors and rows of a campaign."""
    sampler, values, vectors = MarkovChains(SEED, VARIABLES, ESTIMATOR), [], []
    while plan := ESTIMATOR.plan(rows := rows_of(values)):
        for index in (index for part in plan for index in part.indices):
            vectors.append(sampler.xi(index, rows))
            values.append(quantity(vectors[-1]))
    return np.array(vectors), rows


def test_the_first_ones_are_the_plain_vectors(finished):
    vectors, _ = finished
    for index in (0, 99):
        assert vectors[index].tobytes() == seeds.standard_normal(SEED, 0, index, VARIABLES).tobytes()
    assert MarkovChains(SEED, VARIABLES, ESTIMATOR).xi(7).tobytes() == vectors[7].tobytes()


def test_any_vector_comes_again_from_all_rows_or_those_before_it(finished):
    vectors, rows = finished
    sampler = MarkovChains(SEED, VARIABLES, ESTIMATOR)
    starts = np.cumsum([0, *_turns(rows)])
    for index in (len(vectors) - 1, 3, 150, 101, 180):
        before = rows.first([starts[np.searchsorted(starts, index, side="right") - 1]])
        assert sampler.xi(index, rows).tobytes() == vectors[index].tobytes()
        assert sampler.xi(index, before).tobytes() == vectors[index].tobytes()


def _turns(rows: Rows) -> list[int]:
    sizes, done = [], 0
    while done < rows.value.size:
        sizes.append(len(ESTIMATOR.course(rows.first([done])).parent) - done)
        done += sizes[-1]
    return sizes


def test_a_step_keeps_the_distribution_and_states_stay_above_their_level(finished):
    vectors, rows = finished
    course = ESTIMATOR.course(rows)
    for run in course.runs:
        for level in run.levels[1:]:
            assert level.values.min() > level.above
    for index in (100, 150, len(vectors) - 1):
        width, parent = course.width[index], course.parent[index]
        step = vectors[index] - np.sqrt(1.0 - width**2) * vectors[parent]
        plain = seeds.standard_normal(SEED, 0, index, VARIABLES)
        np.testing.assert_allclose(step, width * plain, rtol=0, atol=1e-12)  # identity
    # Candidates before any is judged: sums of squares of independent standard-normal numbers are near their number;
    # statistical tolerance: 5 standard errors, of some hundred of them
    squares = np.sum(vectors**2, axis=1)
    assert np.abs(squares - VARIABLES).max() < 5.0 * np.sqrt(2.0 * VARIABLES)
    # The limit state is met far beyond what so many plain runs reach.
    assert rows.value.max() > 2.6


def test_an_index_that_the_rows_do_not_lead_to_is_refused(finished):
    _, rows = finished
    with pytest.raises(ValueError, match="realisation 100: subset simulation has planned 100"):
        MarkovChains(SEED, VARIABLES, ESTIMATOR).xi(100, rows.first([50]))
