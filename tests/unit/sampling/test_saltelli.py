"""Designs for Sobol indices: what the blocks of a base point share, and that each vector is standard-normal."""

from math import sqrt

import numpy as np
import pytest

from rfmpm.sampling.saltelli import AT_ONCE, Saltelli


@pytest.mark.parametrize("base", [0, 3, AT_ONCE + 1])
def test_blocks_exchange_one_group_each(base):
    design = Saltelli(seed=7, n_uncertain=3, n_variables=40)
    assert (design.groups, design.blocks) == (4, 6)
    a, b, *exchanged = (design.xi(base * 6 + block) for block in range(6))
    assert not np.any(a == b)
    groups = [np.array([0]), np.array([1]), np.array([2]), np.arange(3, 40)]
    for group, vector in zip(groups, exchanged, strict=True):
        np.testing.assert_array_equal(vector[group], b[group])
        rest = np.setdiff1d(np.arange(40), group)
        np.testing.assert_array_equal(vector[rest], a[rest])


def test_vectors_depend_on_seed_and_index_alone():
    design = Saltelli(5, 2, 10)
    ahead = [design.xi(index) for index in range(3 * AT_ONCE)]
    for index in (2 * AT_ONCE, 0, AT_ONCE - 1):
        np.testing.assert_array_equal(Saltelli(5, 2, 10).xi(index), ahead[index])
    assert not np.any(Saltelli(6, 2, 10).xi(0) == ahead[0])
    assert design.place(13) == (2, 3)  # five blocks


def test_without_fields_or_without_uncertain_numbers():
    assert Saltelli(5, 2, 2).groups == 2
    alone = Saltelli(5, 0, 8)
    assert alone.groups == 1
    np.testing.assert_array_equal(alone.xi(2), alone.xi(1))  # all of A is exchanged


def test_vectors_are_standard_normal_and_uncertain_numbers_even():
    design = Saltelli(11, 2, 5)
    count = 2048
    vectors = np.array([design.xi(index) for base in range(count) for index in (base * 5, base * 5 + 1)])
    pairs = np.hstack([vectors[::2], vectors[1::2]])
    assert np.abs(pairs.mean(axis=0)).max() < 4.0 / sqrt(count)  # four standard errors of random points
    assert np.abs(pairs.T @ pairs / count - np.eye(10)).max() < 4.0 * sqrt(2.0 / count)
    # A sequence is far more even than random points: errors of its means are not 1 / sqrt(count).
    assert np.abs(pairs[:, [0, 1, 5, 6]].mean(axis=0)).max() < 0.1 / sqrt(count)
