"""The standard deviation: its interval covers as it says, of normal values and of slopes that stand or run."""

import numpy as np
import pytest

from rfmpm.estimators import standard_deviation

REPEATS, N = 1000, 128
STANDARD_ERROR = np.sqrt(0.95 * 0.05 / REPEATS)


def normal(rng):
    return rng.normal(10.0, 2.0, N), 2.0


def stands_or_runs(rng):
    """A quarter of 0, the others normal: variance = within + between."""
    values = np.where(rng.random(N) < 0.25, 0.0, rng.normal(12.0, 2.0, N))
    return values, np.sqrt(0.75 * 2.0**2 + 0.25 * 0.75 * 12.0**2)


@pytest.mark.parametrize("draw", [normal, stands_or_runs])
def test_interval_covers(draw):
    rng = np.random.default_rng(7)
    covered = 0
    for _ in range(REPEATS):
        values, true = draw(rng)
        found = standard_deviation(values)
        covered += found.lower <= true <= found.upper
    assert abs(covered / REPEATS - 0.95) < 4.0 * STANDARD_ERROR


def test_value_is_that_of_the_completed():
    found = standard_deviation([1.0, np.nan, 3.0, 5.0, 7.0, 9.0])
    assert found.value == pytest.approx(np.sqrt(10.0), rel=1e-12)
    assert (found.n, found.note) == (5, "1 failed of 6 left out")


def test_scales_with_the_values_and_ignores_their_origin():
    values = np.random.default_rng(1).gamma(2.0, size=40)
    one, other = standard_deviation(values), standard_deviation(100.0 - 3.0 * values)
    assert (other.lower, other.value, other.upper) == pytest.approx(
        (3.0 * one.lower, 3.0 * one.value, 3.0 * one.upper), rel=1e-12
    )


@pytest.mark.parametrize(
    ("values", "expected"),
    [([1.0, 2.0, 3.0], (1.0, 0.0, np.inf)), ([1e7 / 7.0] * 11, (0.0, 0.0, 0.0)), ([3.0], (np.nan, 0.0, np.inf))],
)
def test_too_few_or_equal_values(values, expected):
    found = standard_deviation(values)
    assert (found.value, found.lower, found.upper) == pytest.approx(expected, nan_ok=True)
