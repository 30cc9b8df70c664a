"""Factor of safety of a body of slices: what each method of slices demands of the forces between them.

The factor divides the whole strength along the surface, cohesion and tangent of the angle of friction alike; but not
the friction of a base along which it runs, as in strength reduction: that is no property of the soil.
"""

import numpy as np

from rfmpm.kernel_tools import kernel

BISHOP, SPENCER, MORGENSTERN_PRICE = 0, 1, 2  # no shear, shear in proportion, shear in proportion to a half sine
CLOSE = 1e-6  # two factors that no longer differ, relatively
CLOSE_RATIO = 1e-5
ROUNDS = 200
LEAST_ROTATION = 0.2  # below, Bishop's normal force on a rising base has no meaning (Whitman and Bailey 1967)
LARGEST_PULL = 0.02  # of the resistance, what pull on the base may take of it: a strength that nobody knows
STEEPEST_THRUST = 2.0  # shear over normal force between slices, beyond which a solution is none


@kernel
def factor(slices, count, method):
    """Factor of safety by a method; infinite where it has no solution or nothing drives."""
    if method == BISHOP:
        return bishop(slices, count)
    return general(slices, count, method)


@kernel
def strength(cohesion, friction, weight, limit):
    """Force of the cohesion and tangent of the friction on a slice: of the soil, or of the base below it.

    The base decides where its friction, times the factor that does not divide it, under the weight of the slice is less
    than the strength of the soil; it has none, limit infinite, but where it is the slice's.
    """
    if limit < np.inf and limit * weight < cohesion + friction * weight:
        return 0.0, limit
    return cohesion, friction


@kernel
def ordinary(slices, count):
    """Factor without forces between the slices (Fellenius 1936): where the others start."""
    resisting, driving = 0.0, 0.0
    for i in range(count):
        resisting += slices.cohesion[i] + slices.weight[i] * slices.cosine[i] * slices.friction[i]
        driving += slices.weight[i] * slices.sine[i]
    return resisting / driving if driving > 0.0 and resisting > 0.0 else np.inf


@kernel
def bishop(slices, count):
    """Moments about a circle's centre and vertical forces on each slice (Bishop 1955, Géotechnique 5)."""
    found = ordinary(slices, count)
    if found == np.inf:
        return found
    driving = 0.0
    for i in range(count):
        driving += slices.weight[i] * slices.sine[i]
    for _ in range(ROUNDS):
        resisting = 0.0
        for i in range(count):
            limit, weight = slices.limit[i] * found, slices.weight[i]
            cohesion, friction = strength(slices.cohesion[i], slices.friction[i], weight, limit)
            rotation = slices.cosine[i] + slices.sine[i] * friction / found
            if slices.sine[i] < 0.0 and friction > 0.0 and rotation < LEAST_ROTATION:
                return np.inf
            force = cohesion * slices.cosine[i] + weight * friction
            resisting += force / rotation * slices.lever[i]
        better = resisting / driving
        if abs(better - found) < CLOSE * found:
            return better if pull(slices, count, better) < LARGEST_PULL else np.inf
        if not better > 0.0:
            return np.inf
        found = better
    return np.inf


@kernel
def pull(slices, count, found):
    """What is lost of the friction where Bishop's normal force pulls on a steep base, over the whole resistance.

    Cohesion holds up the upper end of a steep surface; Bishop's vertical forces alone then pull on its base, the more
    the steeper it is, and the factor comes out too low (with 60 degrees and a friction of 10 degrees by 2.4 %).
    """
    lost, whole = 0.0, 0.0
    for i in range(count):
        s, c, weight = slices.sine[i], slices.cosine[i], slices.weight[i]
        cohesion, t = strength(slices.cohesion[i], slices.friction[i], weight, slices.limit[i] * found)
        force = t * (weight - cohesion * s / found) / (c + s * t / found)
        lost -= min(force, 0.0)
        whole += cohesion + force
    return lost / whole


@kernel
def share_shear(slices, count, method):
    """Shear between slices over the normal force there and the unknown ratio, on both sides of each slice."""
    whole, way = 0.0, 0.0
    for i in range(count):
        whole += slices.width[i]
    slices.share[0] = 1.0 if method == SPENCER else 0.0
    for i in range(count):
        way += slices.width[i]
        slices.share[i + 1] = 1.0 if method == SPENCER else np.sin(np.pi * way / whole)


@kernel
def general(slices, count, method):
    """All forces and moments: Spencer (1967) or Morgenstern and Price (1965) with a half sine.

    Solved as Zhu, Lee, Qian and Chen (2005), Canadian Geotechnical Journal 42, equations 9 to 17: the forces on all
    slices give the factor at a known ratio of shear to thrust, their moments the ratio at known thrusts.
    """
    found = ordinary(slices, count)
    if found == np.inf:
        return found
    share_shear(slices, count, method)
    ratio = 0.0
    for _ in range(ROUNDS):
        resisting, driving, before = 0.0, 0.0, 1.0
        for i in range(count):
            s, c, weight = slices.sine[i], slices.cosine[i], slices.weight[i]
            cohesion, t = strength(slices.cohesion[i], slices.friction[i], weight, slices.limit[i] * found)
            a, b = c * found + s * t, s * found - c * t
            passed = (a + ratio * slices.share[i] * b) / before
            before = a + ratio * slices.share[i + 1] * b
            if not (passed > 0.0 and before > 0.0):
                return np.inf
            resisting = passed * resisting + cohesion + weight * c * t
            driving = passed * driving + weight * s
            slices.held[i], slices.pushed[i] = resisting / before, driving / before
        if not (driving > 0.0 and resisting > 0.0):
            return np.inf
        better = resisting / driving
        turning, shear, thrust = 0.0, 0.0, 0.0
        for i in range(count):
            after = better * slices.pushed[i] - slices.held[i] if i < count - 1 else 0.0
            turning += slices.width[i] * (thrust + after) * slices.sine[i] / slices.cosine[i]
            shear += slices.width[i] * (slices.share[i] * thrust + slices.share[i + 1] * after)
            thrust = after
        if shear == 0.0:
            return np.inf
        steeper = turning / shear
        if abs(better - found) < CLOSE * found and abs(steeper - ratio) < CLOSE_RATIO:
            # A ratio below 0 would let a slice pull down the one above it: a root of the equations, no slide.
            return better if steeper >= 0.0 else np.inf
        if abs(steeper) > STEEPEST_THRUST:
            return np.inf
        found, ratio = better, steeper
    return np.inf
