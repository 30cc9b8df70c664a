import numpy as np
import pytest

from rfmpm.quantities.volume import failure_volume, first_minimum


def test_failure_volume_sums_what_failed_as_it_was_at_the_start(state):
    before = [(1.0, 1.0), (2.0, 1.0), (3.0, 1.0)]
    after = [(1.0, 1.0), (2.0, 0.25), (9.0, 0.25)]
    assert failure_volume(state(before, after, volume=9.0, volume_initial=[0.25, 0.5, 1.0])) == 1.5


def test_failure_volume_counts_every_failed_mass(came_to):
    assert failure_volume(came_to((6.5, 0.25), (7.5, 0.25), (15.5, 0.25))) == 0.75


def test_nothing_failed(body):
    assert failure_volume(body()) == 0.0


def test_everything_failed(body):
    # 11 + 10 + 9 + 8 points, row by row from the base
    assert failure_volume(body(lambda x, y: (x + 3.0, y))) == 38 * 0.25


@pytest.mark.parametrize(
    ("kinetic_energy", "index"),
    [
        ([0, 4, 1, 3, 0], 2),
        ([0, 4, 1, 3, 0, 9, 0], 2),  # the first of two
        ([0, 4, 3, 2, 1], 4),  # no minimum inside: the end
        ([0, 1, 2, 3], 3),
        ([0, 20, 19, 20, 0], 2),  # a rise of just 5 % of the largest value
        ([0, 20, 19.1, 20, 0], 4),  # of less: vibration
        ([0, 20, 19.1, 20, 8, 12, 0], 4),  # vibration first, then the end of the first slide
        ([0, 20, 1, 1.9, 0.5, 100, 0], 4),  # 5 % is of the largest value of all
        ([0, 0, 0], 2),
        ([3], 0),
    ],
)
def test_first_minimum_of_the_kinetic_energy(kinetic_energy, index):
    assert first_minimum(np.array(kinetic_energy, dtype=float)) == index


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_first_minimum_knows_no_unit(scale):
    assert first_minimum(scale * np.array([0.0, 20.0, 19.5, 20.0, 8.0, 12.0, 0.0])) == 4


def test_first_minimum_is_that_of_find_peaks():
    from scipy.signal import find_peaks

    rng = np.random.default_rng(1)
    for length in rng.integers(1, 200, 300):
        energy = np.abs(np.cumsum(rng.integers(-2, 3, length))).astype(float)  # with plateaus
        minima, _ = find_peaks(-energy, prominence=0.05 * energy.max())
        assert first_minimum(energy) == (minima[0] if len(minima) else length - 1)
