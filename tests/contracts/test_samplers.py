"""Every listed sampler: each point is N(0, I), the same bits in any order, replicates independent, means that gain."""

from functools import cache

import numpy as np
import pytest

from rfmpm import seeds
from rfmpm.sampling import SAMPLERS, Directions

SEED, VARIABLES, SCALARS, COMPONENTS, SIZE, REPLICATES = 20160901, 12, 2, 3, 16, 250
every_sampler = pytest.mark.parametrize("name", SAMPLERS)


def orthonormal(rows: int, columns: int) -> np.ndarray:
    return np.linalg.qr(np.random.default_rng(5).standard_normal((columns, rows)))[0].T


def directions(with_components: bool = True, seed: int = SEED) -> Directions:
    components = orthonormal(COMPONENTS, VARIABLES - SCALARS) if with_components else None
    return Directions(seed, VARIABLES, SCALARS, components)


@cache
def drawn(name: str, with_components: bool = True) -> np.ndarray:
    """Vectors of all replicates, shape (REPLICATES, SIZE, VARIABLES)."""
    sampler = SAMPLERS[name](directions(with_components), SIZE)
    xi = [sampler.xi(index) for index in range(REPLICATES * SIZE)]
    return np.array(xi).reshape(REPLICATES, SIZE, VARIABLES)


def along(xi: np.ndarray) -> np.ndarray:
    """Scalars and scores along the components, shape (..., SCALARS + COMPONENTS)."""
    scores = xi[..., SCALARS:] @ orthonormal(COMPONENTS, VARIABLES - SCALARS).T
    return np.concatenate([xi[..., :SCALARS], scores], axis=-1)


@every_sampler
@pytest.mark.parametrize("with_components", [True, False])
def test_each_point_of_a_replicate_is_standard_normal(name, with_components):
    xi = drawn(name, with_components)
    for point in (0, 1, SIZE - 1):
        for sample in (xi[:, point], along(xi[:, point])):
            # statistical tolerance: 4 standard errors of a mean, a variance and a covariance of REPLICATES independent
            # standard-normal vectors, widened by 1/4 since there are some hundred of them
            error = 1.25 * 4.0 / np.sqrt(REPLICATES)
            assert np.abs(sample.mean(axis=0)).max() < error
            deviation = sample.T @ sample / REPLICATES - np.eye(sample.shape[1])
            assert np.abs(np.diag(deviation)).max() < np.sqrt(2.0) * error
            assert np.abs(deviation - np.diag(np.diag(deviation))).max() < error


@every_sampler
def test_a_vector_depends_on_seed_and_index_alone(name):
    xi = drawn(name).reshape(-1, VARIABLES)
    again = SAMPLERS[name](directions(), SIZE)
    for index in (3 * SIZE + 2, 5, 3 * SIZE + 1, 0, 3 * SIZE + 2):
        assert again.xi(index).tobytes() == xi[index].tobytes()
    other = SAMPLERS[name](directions(seed=SEED + 1), SIZE)
    assert not np.any(other.xi(5) == xi[5])


@every_sampler
def test_replicates_are_independent(name):
    means = drawn(name)[..., :SCALARS] ** 2
    first, second = means[:-1, 0].ravel(), means[1:, 0].ravel()
    # statistical tolerance: 4 standard errors of a correlation
    assert abs(np.corrcoef(first, second)[0, 1]) < 4.0 / np.sqrt(first.size)
    eta = along(drawn(name))
    assert len(np.unique(eta[:, :, 0])) == REPLICATES * SIZE


@every_sampler
def test_what_is_not_set_is_the_plain_vector(name):
    xi, plain = drawn(name)[2, 3], seeds.standard_normal(SEED, 0, 2 * SIZE + 3, VARIABLES)
    components = orthonormal(COMPONENTS, VARIABLES - SCALARS)
    off = np.eye(VARIABLES - SCALARS) - components.T @ components
    np.testing.assert_allclose(off @ xi[SCALARS:], off @ plain[SCALARS:], rtol=0, atol=1e-12)  # identity
    np.testing.assert_array_equal(drawn(name, with_components=False)[2, 3, SCALARS:], plain[SCALARS:])


@every_sampler
def test_the_mean_of_an_additive_function_has_less_variance(name):
    value = np.sum(np.exp(0.5 * along(drawn(name))), axis=-1)
    variance = value.mean(axis=1).var(ddof=1)
    independent = (SCALARS + COMPONENTS) * (np.exp(0.5) - np.exp(0.25)) / SIZE
    # statistical tolerance: with no gain the ratio were 1, its standard error sqrt(2 / REPLICATES) = 0.09
    assert variance / independent < 1.0 - 4.0 * np.sqrt(2.0 / REPLICATES)
    # unbiased: 4 standard errors over the replicates
    expected = (SCALARS + COMPONENTS) * np.exp(0.125)
    assert abs(value.mean() - expected) < 4.0 * np.sqrt(variance / REPLICATES)


@every_sampler
def test_one_interval_one_point(name):
    # Both designs are Latin: scaled to (0, 1), every direction has one point in each of SIZE intervals.
    from scipy.special import ndtr

    for replicate in along(drawn(name))[:5]:
        intervals = np.floor(SIZE * ndtr(replicate)).astype(int)
        np.testing.assert_array_equal(np.sort(intervals, axis=0), np.arange(SIZE)[:, None] + 0 * intervals[:1])


@every_sampler
def test_a_design_with_nothing_to_set_or_of_one_point_is_refused(name):
    with pytest.raises(ValueError, match="nothing to set"):
        SAMPLERS[name](Directions(SEED, VARIABLES), SIZE)
    with pytest.raises(ValueError, match="replicate_size = 1: at least 2"):
        SAMPLERS[name](directions(), 1)
    with pytest.raises(ValueError, match=r"must be \(d, 10\), as the fields take"):
        Directions(SEED, VARIABLES, SCALARS, np.eye(3))


def test_sobol_takes_powers_of_two():
    with pytest.raises(ValueError, match=r"replicate_size = 100: must be a power of two .* such as 64 or 128"):
        SAMPLERS["sobol"](directions(), 100)
