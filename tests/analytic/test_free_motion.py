"""A thrown block obeys symplectic Euler step by step: velocity first, then position with the new velocity."""

import numpy as np
import pytest

from rfmpm.mpm.shapes import SHAPES

GRAVITY = 9.81
THROW = 2.0, 3.0  # [m/s]
IDENTITY = 1e-12


def positions(points):
    return np.array(points.position)


@pytest.fixture(params=SHAPES)
def thrown(blocks, request):
    """The flight of a block in the air, its mass, its first positions, and the lengths of its steps."""
    scene = blocks.scene(1.0, 1.0, 3.0, discretisation__shape=request.param)
    flight = blocks.flight(blocks.launched(scene, shift=(0.6, 1.1), velocity=THROW, height=4.0))
    flight.until(0.0)
    times = [0.0]
    while times[-1] < 0.5:
        times.append(flight.until(np.nextafter(times[-1], np.inf)).time)
    return flight, scene.points.mass.sum(), positions(flight.scene.points), np.diff(times)


def test_positions_are_those_of_symplectic_euler(thrown):
    flight, _, first, steps = thrown
    ends = np.cumsum(steps)
    # With equal steps: v t - g t (t + dt) / 2. They are not equal, for they shrink with the speed.
    assert steps.max() > 1.01 * steps.min()
    expected = np.array([THROW[0] * ends[-1], THROW[1] * ends[-1] - GRAVITY * np.dot(steps, ends)])
    moved = positions(flight.points) - first
    np.testing.assert_allclose(moved, np.broadcast_to(expected[:, None], moved.shape), rtol=IDENTITY * len(steps))


def test_gravity_works_half_a_step_more_than_the_block_gains(thrown):
    flight, mass, _, steps = thrown
    speed = THROW[1] - GRAVITY * steps.sum()
    gained = 0.5 * mass * (speed**2 - THROW[1] ** 2)
    rounding = IDENTITY * len(steps) * 0.5 * mass * np.dot(THROW, THROW)
    assert flight.now.kinetic - 0.5 * mass * np.dot(THROW, THROW) == pytest.approx(gained, abs=rounding)
    assert flight.now.grid_gain == pytest.approx(gained, abs=rounding)
    # Work m g dt v of the new velocity, against the gain m g dt (v_old + v_new) / 2.
    surplus = 0.5 * mass * GRAVITY**2 * np.sum(steps**2)
    assert flight.now.gravity_work - gained == pytest.approx(surplus, abs=rounding)
    assert (flight.now.friction_work, abs(flight.now.stress_work) < rounding) == (0.0, True)
