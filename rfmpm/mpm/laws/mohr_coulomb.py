"""Mohr-Coulomb plasticity with a tension cut-off; cohesion, friction and dilation soften linearly to residuals."""

from math import sqrt
from typing import NamedTuple

from rfmpm.kernel_tools import Tensor, inlined
from rfmpm.mpm.laws.frictional import SMALLEST, THIRD, FrictionalHistory, FrictionalLaw, predict, strength


class Principal(NamedTuple):
    """Principal stresses, tension positive: major >= middle >= minor [Pa]."""

    major: float
    middle: float
    minor: float


@inlined
def return_to_shear(trial, limit, s, p, lame, shear):
    """Return a trial stress beyond the Mohr-Coulomb pyramid to its plane, edge or apex.

    `limit` is 2 c cos(phi), `s` sin(phi), `p` sin(psi). De Souza Neto et al. (2008), section 8.2, with both multipliers
    of an edge solved at once; edge and apex are told by the order of the returned stresses (Clausen et al. 2007).
    """
    major, middle, minor = trial.major, trial.middle, trial.minor
    bulge, up, down = 2.0 * lame * p, 2.0 * shear * (1.0 + p), 2.0 * shear * (1.0 - p)
    plane = 4.0 * (lame * s * p + shear * (1.0 + s * p))
    # Plane: one multiplier.
    g = ((1.0 + s) * major - (1.0 - s) * minor - limit) / plane
    a, b, c = major - g * (bulge + up), middle - g * bulge, minor - g * (bulge - down)
    if a < b or b < c:
        pair = (major - middle) * (1.0 - p) < (middle - minor) * (1.0 + p)  # which of them meet first
        if pair:
            mean = 0.5 * (major + middle)
            g = 2.0 * ((1.0 + s) * mean - (1.0 - s) * minor - limit)
            g /= plane + 4.0 * lame * s * p + 2.0 * shear * (1.0 - s) * (1.0 - p)
            a, c = mean - g * (bulge + 0.5 * up), minor - g * (bulge - down)
            b = a
        else:
            mean = 0.5 * (middle + minor)
            g = 2.0 * ((1.0 + s) * major - (1.0 - s) * mean - limit)
            g /= plane + 4.0 * lame * s * p + 2.0 * shear * (1.0 + s) * (1.0 + p)
            a, c = major - g * (bulge + up), mean - g * (bulge - 0.5 * down)
            b = c
        if a < c and s > 0.0:  # beyond the apex c cot(phi), where both edges end
            a = b = c = 0.5 * limit / s
    return Principal(a, b, c)


@inlined
def return_to_tension(trial, tension, lame, shear):
    """Return a trial stress beyond the Rankine cut-off, associated: to its plane, edge or apex."""
    excess = (trial.major - tension) * lame / (lame + 2.0 * shear)
    middle, minor = trial.middle - excess, trial.minor - excess
    if middle > tension:
        middle = tension
        minor = trial.minor - 0.5 * lame / (lame + shear) * (trial.major + trial.middle - 2.0 * tension)
    return Principal(tension, middle, min(minor, tension))


@inlined
def return_to_both(trial, tension, limit, s, p, lame, shear):
    """Return a trial stress to the line where the pyramid's plane and the cut-off meet, or to an end of it."""
    minor = ((1.0 + s) * tension - limit) / (1.0 - s)
    first, third = trial.major - tension, trial.minor - minor
    along = lame + 2.0 * shear
    major_flow = 2.0 * lame * p + 2.0 * shear * (1.0 + p)
    minor_flow = 2.0 * lame * p - 2.0 * shear * (1.0 - p)
    scale = 0.25 / (shear * (lame + shear) * (1.0 - p))
    sliding, opening = (lame * first - along * third) * scale, (major_flow * third - minor_flow * first) * scale
    middle = trial.middle - lame * (2.0 * p * sliding + opening)
    return Principal(tension, min(tension, max(minor, middle)), minor)


@inlined
def is_within(stress, limit, s):
    """Whether principal stresses are on or within the Mohr-Coulomb pyramid."""
    return (1.0 + s) * stress.major - (1.0 - s) * stress.minor <= limit


@inlined
def relax(trial, tension, limit, s, p, lame, shear):
    """Return principal stresses to pyramid and cut-off.

    Returns (them, growth of the plastic strain, volumetric plastic strain).
    """
    relaxed = trial
    if not is_within(trial, limit, s):
        relaxed = return_to_shear(trial, limit, s, p, lame, shear)
    if relaxed.major > tension:
        relaxed = return_to_tension(trial, tension, lame, shear)
        if not is_within(relaxed, limit, s):
            relaxed = return_to_both(trial, tension, limit, s, p, lame, shear)
    a, b, c = trial.major - relaxed.major, trial.middle - relaxed.middle, trial.minor - relaxed.minor
    mean = (a + b + c) * THIRD
    a, b, c = a - mean, b - mean, c - mean
    growth = sqrt(2.0 * THIRD * (a * a + b * b + c * c)) / (2.0 * shear)
    return relaxed, growth, mean / (lame + 2.0 * THIRD * shear)


class MohrCoulomb(FrictionalLaw):
    """Drained soil: (s1 - s3) + (s1 + s3) sin(phi) <= 2 c cos(phi), and s1 <= the tension cut-off.

    Plastic flow: the same with the dilation angle in shear, associated in tension. Where each surface alone would leave
    the other violated, both are active and the stress returns to where they meet. A cut-off beyond the apex never acts.
    The cut-off itself does not soften. With phi = 0 this is Tresca, with neither apex nor cut-off of its own.

    The plastic strain is that of the deviator, so that soil which opens without shear keeps its strength.
    """

    def update_stress(self, stress, strain_increment, history, dt):
        """Elastic predictor and exact return in principal stresses, two of which lie in the plane."""
        trial, opening = predict(self, stress, strain_increment, history.opening)
        mean, half = 0.5 * (trial.xx + trial.yy), 0.5 * (trial.xx - trial.yy)
        radius = sqrt(half * half + trial.xy * trial.xy)
        high, low = mean + radius, mean - radius
        principal = Principal(max(high, trial.zz), max(low, min(high, trial.zz)), min(low, trial.zz))
        cohesion, s, cosine, p = strength(self, history)
        limit = 2.0 * cohesion * cosine
        if is_within(principal, limit, s) and principal.major <= self.tension:
            return trial, FrictionalHistory(history.plastic_strain, opening)
        relaxed, growth, swelling = relax(
            principal, self.tension, limit, s, 0.0 if opening > 0.0 else p, self.lame, self.shear
        )
        high_after = relaxed.middle if trial.zz >= high else relaxed.major
        low_after = relaxed.middle if trial.zz <= low else relaxed.minor
        if high_after == low_after and (high_after == self.tension or relaxed.major == relaxed.minor):
            opening += max(0.0, swelling)
        across = relaxed.major + relaxed.middle + relaxed.minor - high_after - low_after
        mean = 0.5 * (high_after + low_after)
        scale = 0.5 * (high_after - low_after) / max(radius, SMALLEST)
        updated = Tensor(mean + scale * half, mean - scale * half, across, scale * trial.xy)
        return updated, FrictionalHistory(history.plastic_strain + growth, opening)
