"""Streams: one for each seed, level and index, whatever was drawn before and on which process."""

from concurrent.futures import ProcessPoolExecutor

import numpy as np

from rfmpm.seeds import standard_normal

ARGUMENTS = [(seed, level, index, 50) for seed in (0, 1, 2**63 - 1) for level in (0, 1) for index in (0, 1, 7, 10**7)]


def test_streams_do_not_depend_on_order():
    forwards = [standard_normal(*each) for each in ARGUMENTS]
    backwards = [standard_normal(*each) for each in reversed(ARGUMENTS)]
    np.testing.assert_array_equal(forwards, backwards[::-1])


def test_streams_do_not_depend_on_the_process():
    with ProcessPoolExecutor(2) as pool:
        elsewhere = list(pool.map(standard_normal, *zip(*ARGUMENTS, strict=True)))
    assert np.array(elsewhere).tobytes() == np.array([standard_normal(*each) for each in ARGUMENTS]).tobytes()


def test_streams_of_different_arguments_share_no_value():
    values = np.concatenate([standard_normal(*each) for each in ARGUMENTS])
    assert len(np.unique(values)) == len(values)


def test_a_longer_vector_begins_with_the_shorter_one():
    np.testing.assert_array_equal(standard_normal(5, 0, 3, 100)[:40], standard_normal(5, 0, 3, 40))


def test_a_stream_is_standard_normal():
    # 4 standard errors: of the mean 1 / sqrt(n), of the variance sqrt(2 / n).
    xi = standard_normal(20160901, 0, 0, 100_000)
    assert abs(xi.mean()) < 4.0 / np.sqrt(len(xi))
    assert abs(xi.var() - 1.0) < 4.0 * np.sqrt(2.0 / len(xi))
