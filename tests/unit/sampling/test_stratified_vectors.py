"""Vectors of stratified sampling: the same from the same rows, in their strata, plain across the direction."""

import numpy as np
import pytest

from rfmpm import seeds
from rfmpm.estimators import Question, Rows
from rfmpm.sampling import Directions, StratifiedVectors

SEED, VARIABLES, SCALARS, PILOT = 20160901, 30, 2, 40
QUESTION = Question("run_out", "exceedance", limit=2.0, at_most=4 * PILOT)


def sampler() -> StratifiedVectors:
    components = np.linalg.qr(np.random.default_rng(3).standard_normal((VARIABLES - SCALARS, 5)))[0].T
    return StratifiedVectors(Directions(SEED, VARIABLES, SCALARS, components), QUESTION, PILOT)


def rows_of(values) -> Rows:
    n = len(values)
    return Rows(np.zeros(n, int), np.arange(n), np.asarray(values, float), np.zeros(n, bool), np.ones(n))


@pytest.fixture(scope="module")
def finished():
    """Vectors and rows of three rounds of a quantity that the second scalar drives."""
    vectors, values, own = [], [], sampler()
    for stop in (PILOT, 2 * PILOT, 4 * PILOT):
        rows = rows_of(values)
        vectors += [own.xi(index, rows) for index in range(len(values), stop)]
        values = [xi[1] + 0.1 * xi[-1] for xi in vectors]
    return vectors, rows_of(values)


def test_the_first_are_the_plain_vectors():
    assert sampler().xi(7).tobytes() == seeds.standard_normal(SEED, 0, 7, VARIABLES).tobytes()


def test_any_vector_comes_again_from_all_rows_or_those_of_the_rounds_before(finished):
    vectors, rows = finished
    again = sampler()
    for index, before in ((150, 2 * PILOT), (3, 0), (45, PILOT), (100, 2 * PILOT + 7)):
        assert again.xi(index, rows).tobytes() == vectors[index].tobytes()
        assert again.xi(index, rows.first([before])).tobytes() == vectors[index].tobytes()


def test_later_vectors_lie_where_the_quantity_is_large(finished):
    vectors, rows = finished
    assert rows.value[: 2 * PILOT].mean() < rows.value[2 * PILOT :].mean()
    # across the direction, which is nearly that of the second scalar, numbers stay standard-normal; 4 standard errors
    others = np.array(vectors)[2 * PILOT :, 2:]
    assert abs(np.mean(others**2) - 1.0) < 4.0 * np.sqrt(2.0 / others.size)


def test_an_index_that_the_rows_do_not_lead_to_is_refused(finished):
    _, rows = finished
    with pytest.raises(ValueError, match="realisation 80: stratified sampling has planned 80 at most"):
        sampler().xi(80, rows.first([79]))
