"""The manufactured vortex: its motion, stress and force fit together; derivatives are taken by differences."""

import numpy as np
import pytest

from rfmpm.benchmark.engine import vortex

AMPLITUDE, STEP = 1.3, 1e-4
FORCE = vortex.Vortex(AMPLITUDE, vortex.DURATION, vortex.SHEAR / vortex.DENSITY, 0.0)
# A fourth-order difference: its error is the fifth derivative, some 1e6 times the function, times 1e-16 / 30.
NEAR, FAR = 8.0 / 12.0, -1.0 / 12.0
PLACES = [(radius, angle, time) for radius in (0.8, 0.97, 1.2) for angle in (0.3, 2.5) for time in (0.1, 0.6)]
every_place = pytest.mark.parametrize(("radius", "angle", "time"), PLACES)


def derivative(function, at):
    """Derivative of a function of one number, of any shape."""
    one, two = (function(at + k * STEP) - function(at - k * STEP) for k in (1, 2))
    return (NEAR * one + FAR * two) / STEP


def turned(radius, time):
    return AMPLITUDE * np.sin(np.pi * time / vortex.DURATION) * vortex.profile(radius)


def place(radius, angle, time):
    """Where the point is that started at (radius, angle)."""
    now = angle + turned(radius, time)
    return radius * np.array([np.cos(now), np.sin(now)])


def velocity(x, y, time):
    radius = np.hypot(x, y)
    spin = derivative(lambda t: turned(radius, t), time)
    return spin * np.array([-y, x])


def stress(x, y, time):
    """The closed form, in the fixed axes."""
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    gamma = radius * derivative(lambda r: turned(r, time), radius)
    along = vortex.SHEAR * (1.0 - np.cos(gamma))
    polar = np.array([[-along, vortex.SHEAR * np.sin(gamma)], [vortex.SHEAR * np.sin(gamma), along]])
    axes = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return axes @ polar @ axes.T


@every_place
def test_force_moves_the_points_as_manufactured(radius, angle, time):
    x, y = place(radius, angle, time)
    moved = derivative(lambda t: derivative(lambda s: place(radius, angle, s), t), time)
    divergence = (
        derivative(lambda u: stress(u, y, time)[0], x) + derivative(lambda u: stress(x, u, time)[1], y)
    ) / vortex.DENSITY
    # Largest terms 1e4 m/s2; differences of differences of numbers known to 1e-15 over 1e-4 squared: 1e-7 of them.
    np.testing.assert_allclose(FORCE.acceleration(x, y, time), moved - divergence, rtol=0.0, atol=1e-2)


@every_place
def test_stress_obeys_the_rate_law_of_the_engine(radius, angle, time):
    x, y = place(radius, angle, time)
    slope = np.column_stack(
        [derivative(lambda u: velocity(u, y, time), x), derivative(lambda u: velocity(x, u, time), y)]
    )
    spin, rate = 0.5 * (slope - slope.T), 0.5 * (slope + slope.T)
    now = stress(x, y, time)
    expected = spin @ now - now @ spin + 2.0 * vortex.SHEAR * rate
    found = derivative(lambda t: stress(*place(radius, angle, t), t), time)
    assert np.trace(rate) == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * vortex.SHEAR)


def test_rest_of_the_body_feels_no_force():
    assert FORCE.acceleration(0.7, 0.1, 0.3) == FORCE.acceleration(1.0, 0.9, 0.3) == (0.0, 0.0)


def test_initial_velocity_is_that_of_the_motion():
    from rfmpm.benchmark.engine.schemes import Scheme

    scene, start = vortex._scene(Scheme("quadratic_bspline"), 26, 0.1, AMPLITUDE)
    expected = np.array([velocity(*one, 0.0) for one in start])
    # Identity but for the difference.
    np.testing.assert_allclose(np.column_stack(scene.points.velocity), expected, rtol=0.0, atol=1e-8)
