"""Blocks in the air: free fall and throws are exact, and nothing that happens inside changes the momentum."""

import numpy as np
import pytest

GRAVITY = 9.81
IDENTITY = 1e-12
every_shape = pytest.mark.parametrize("shape", ["linear", "quadratic_bspline"])


def thrown(blocks, shape, **launch):
    scene = blocks.scene(1.0, 1.0, 3.0, discretisation__shape=shape)
    return blocks.flight(blocks.launched(scene, shift=(0.5, 1.0), height=4.0, **launch))


def momentum(points):
    return np.array([np.dot(points.mass, points.velocity.x), np.dot(points.mass, points.velocity.y)])


@every_shape
def test_thrown_block_follows_the_parabola(blocks, shape):
    flight = thrown(blocks, shape, velocity=(2.0, 3.0))
    first, mass = flight.scene.points, flight.scene.points.mass.sum()
    flight.until(0.6)
    points, time, step = flight.points, flight.now.time, flight.now.time / flight.now.step_count
    assert flight.now.step_count > 50
    # Identity, times the number of steps.
    rounding = IDENTITY * flight.now.step_count
    np.testing.assert_allclose(points.velocity.x, 2.0, rtol=rounding)
    np.testing.assert_allclose(points.velocity.y, 3.0 - GRAVITY * time, rtol=rounding)
    np.testing.assert_allclose(points.position.x - first.position.x, 2.0 * time, rtol=rounding)
    # Velocity first, position after: half a step of gravity more than the parabola.
    rise = points.position.y - first.position.y
    np.testing.assert_allclose(rise, rise[0], rtol=rounding)
    assert rise[0] - (3.0 * time - 0.5 * GRAVITY * time**2) == pytest.approx(-0.5 * GRAVITY * time * step, rel=0.05)
    # No stress but what rounding of the strains brings, against E.
    assert max(np.abs(component).max() for component in points.stress) < 1e6 * rounding
    # Gravity's work is their fall.
    assert flight.now.gravity_work == pytest.approx(-mass * GRAVITY * rise[0], rel=rounding)


@every_shape
def test_rigid_translation_over_cells_keeps_everything(blocks, shape):
    flight = thrown(blocks, shape, velocity=(1.7, -0.6), gravity=0.0)
    first = flight.scene.points
    flight.until(1.0)
    rounding = IDENTITY * flight.now.step_count
    for found, given, speed in zip(flight.points.position, first.position, (1.7, -0.6), strict=True):
        np.testing.assert_allclose(found - given, speed * flight.now.time, rtol=rounding)
    np.testing.assert_allclose(momentum(flight.points), momentum(first), rtol=rounding)
    assert flight.now.kinetic == pytest.approx(0.5 * first.mass.sum() * (1.7**2 + 0.6**2), rel=rounding)
    np.testing.assert_allclose(flight.points.volume, first.volume, rtol=rounding)


@every_shape
def test_inner_forces_and_filter_leave_the_momentum(blocks, shape):
    random = np.random.default_rng(5)
    flight = thrown(blocks, shape, gravity=0.0, dissipation_time=0.05)
    count = len(flight.points.mass)
    for component, speed in zip(flight.points.velocity, (1.0, 0.2), strict=True):
        component[:] = speed + 0.3 * random.normal(size=count)
    for component in flight.points.stress:
        component[:] = 5e3 * random.normal(size=count)
    before = momentum(flight.points)
    kinetic = 0.5 * np.dot(flight.points.mass, flight.points.velocity.x**2 + flight.points.velocity.y**2)
    flight.until(0.5)
    rounding = IDENTITY * flight.now.step_count * np.abs(before).max()
    np.testing.assert_allclose(momentum(flight.points), before, rtol=0.0, atol=rounding)
    assert flight.now.kinetic < 0.97 * kinetic  # the filter was at work
