"""Every wall: nothing passes it, it gives no energy; and what fixed, roller and friction mean."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rfmpm.kernel_tools import kernel
from rfmpm.mpm.boundary import WALLS, Fixed, Friction, Roller
from rfmpm.mpm.protocols import constrain

COEFFICIENT = 0.3
every_wall = pytest.mark.parametrize("kind", WALLS.values(), ids=WALLS)
speeds = st.floats(-10.0, 10.0)
IDENTITY = 1e-12
untimed = settings(deadline=None)  # the first example compiles


@kernel
def compiled(wall, inward, along, push, drag):
    return constrain(wall, inward, along, push, drag)


def wall_of(kind):
    return kind(*({"coefficient": COEFFICIENT}[name] for name in kind._fields))


@every_wall
@untimed
@given(inward=speeds, along=speeds, push=speeds, drag=speeds)
def test_nothing_moves_into_the_wall_and_no_energy_comes_out_of_it(kind, inward, along, push, drag):
    before_in, before_along, after_in, after_along = constrain(wall_of(kind), inward, along, push, drag)
    trial_in, trial_along = inward + push, along + drag
    assert after_in >= 0.0
    # Identity: each component is kept, shortened or dropped.
    for before, given_speed in ((before_in, inward), (before_along, along)):
        assert abs(before) <= abs(given_speed)
    assert abs(after_in) <= abs(trial_in)
    assert abs(after_along) <= abs(trial_along)
    assert after_along * trial_along >= 0.0
    # What the wall takes of the kinetic energy, beyond what the other forces do on the way it allows.
    taken = (trial_in**2 + trial_along**2) - (after_in**2 + after_along**2)
    assert taken >= 0.0


@every_wall
@untimed
@given(inward=speeds, along=speeds, push=speeds, drag=speeds)
def test_compiled_wall_is_the_plain_python_one(kind, inward, along, push, drag):
    plain = constrain(wall_of(kind), inward, along, push, drag)
    found = compiled(wall_of(kind), inward, along, push, drag)
    np.testing.assert_allclose(found, plain, rtol=0.0, atol=IDENTITY * 10.0)


@every_wall
@untimed
@given(inward=speeds, along=speeds, push=speeds, drag=speeds)
def test_wall_knows_no_left_or_right(kind, inward, along, push, drag):
    plain = constrain(wall_of(kind), inward, along, push, drag)
    mirrored = constrain(wall_of(kind), inward, -along, push, -drag)
    assert mirrored == (plain[0], -plain[1], plain[2], -plain[3])


@pytest.mark.parametrize("push", [-2.0, 2.0])
def test_fixed_wall_stops_everything(push):
    assert constrain(Fixed(), -1.0, 3.0, push, 0.5) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("push", [-2.0, 2.0])
def test_roller_holds_both_ways_across_and_hinders_nothing_along(push):
    assert constrain(Roller(), -1.0, 3.0, push, 0.5) == (0.0, 3.0, 0.0, 3.5)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_friction_slows_sliding_by_the_coefficient_times_the_push(sign):
    _, along, inward, after = constrain(Friction(COEFFICIENT), 0.0, sign * 3.0, -2.0, sign * 0.5)
    assert (along, inward) == (sign * 3.0, 0.0)
    assert after == pytest.approx(sign * (3.5 - COEFFICIENT * 2.0), rel=IDENTITY)


@pytest.mark.parametrize(("drag", "sticks"), [(0.599, True), (-0.599, True), (0.601, False), (-0.601, False)])
def test_friction_holds_up_to_its_limit(drag, sticks):
    before_in, before_along, inward, after = constrain(Friction(COEFFICIENT), 0.0, 0.0, -2.0, drag)
    assert (before_in, before_along, inward) == (0.0, 0.0, 0.0)
    assert after == pytest.approx(0.0 if sticks else np.sign(drag) * 0.001, abs=IDENTITY)


def test_friction_lets_go_of_what_lifts_off():
    assert constrain(Friction(COEFFICIENT), -1.0, 3.0, 1.5, 0.5) == (-1.0, 3.0, 0.5, 3.5)


def test_friction_takes_the_whole_impulse_of_the_wall_for_its_limit():
    # Flying into the wall without being pushed: what stops the approach slows the sliding too.
    assert constrain(Friction(COEFFICIENT), -5.0, 3.0, 0.0, 0.0) == (0.0, 3.0, 0.0, 3.0 - COEFFICIENT * 5.0)


@untimed
@given(inward=speeds, along=speeds, push=st.floats(-10.0, -0.1), drag=speeds)
def test_friction_lies_between_a_roller_and_a_fixed_wall(inward, along, push, drag):
    if inward + push < -1e-6:  # which the coefficient below makes more than any speed drawn
        smooth = constrain(Friction(0.0), inward, along, push, drag)
        rolled = constrain(Roller(), inward, along, push, drag)
        assert smooth[2:] == rolled[2:]
        assert constrain(Friction(1e9), inward, along, push, drag) == constrain(Fixed(), inward, along, push, drag)
