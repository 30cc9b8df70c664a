"""Schedules in which nothing is computed, against answers that can be worked out."""

import numpy as np
import pytest

from rfmpm.benchmark.scheduling.replay import ideal, replay
from rfmpm.benchmark.scheduling.stopping import biases

EXACT = 1e-12  # identity


def test_equal_times_fill_every_rank():
    schedule = replay(np.full(12, 2.0), 4)
    assert schedule.makespan == pytest.approx(6.0, rel=EXACT)
    assert schedule.efficiency == pytest.approx(1.0, rel=EXACT)


def test_handing_out_in_order_of_index():
    # rank 0: 3 s, then 1 s; rank 1: 1, 1, 5 s, of which the last begins at 2 s
    schedule = replay(np.array([3.0, 1.0, 1.0, 5.0, 1.0]), 2)
    assert schedule.began.tolist() == [0.0, 0.0, 1.0, 2.0, 3.0]
    assert schedule.makespan == 7.0
    assert ideal(np.array([3.0, 1.0, 1.0, 5.0, 1.0]), 2) == 5.5
    assert ideal(np.array([9.0, 1.0]), 2) == 9.0


def test_one_rank_pays_for_every_claim():
    schedule = replay(np.full(5, 1.0), 1, service=0.1, sleep=0.05)
    assert schedule.makespan == pytest.approx(5 * 1.15, rel=EXACT)
    assert schedule.efficiency == pytest.approx(1.0 / 1.15, rel=EXACT)


def test_a_desk_that_is_too_slow_hands_out_one_after_the_other():
    schedule = replay(np.full(1000, 1e-3), 100, service=0.1)
    assert np.allclose(np.diff(schedule.began), 0.1, rtol=EXACT)
    assert schedule.makespan == pytest.approx(1000 * 0.1 + 1e-3, rel=EXACT)


def test_stopping_at_the_first_finished_is_biased_and_a_fixed_number_is_not():
    fails = np.arange(100) < 20
    found = biases(np.random.default_rng(5), fails, np.where(fails, 3.0, 1.0), 64, 200, campaigns=300)
    first, fixed = found["first finished"], found["prefix of N"]
    assert first.value < -10.0 * first.error
    assert abs(fixed.value) < 4.0 * fixed.error  # statistical
    assert abs(found["prefix then"].value) < 0.25 * abs(first.value)


def test_nothing_is_biased_where_times_tell_nothing():
    fails = np.arange(100) % 5 == 0
    found = biases(np.random.default_rng(6), fails, np.ones(100), 8, 80, campaigns=200)
    assert all(abs(bias.value) < 4.0 * bias.error for bias in found.values())  # statistical
