"""What the frictional laws share: strength that softens with plastic strain, taken at the end of the step."""

from math import radians, sin, sqrt
from typing import NamedTuple, Protocol

import numpy as np

from rfmpm.kernel_tools import generic, inlined
from rfmpm.mpm.laws.elastic import lame_constants
from rfmpm.mpm.laws.von_mises import PlasticHistory

PASSES = 12  # of the secant method; three where cohesion alone softens, four or five where the angles do too
PRECISION = 1e-15  # of the plastic strain at the end of the step [-]
STEEPEST = -0.01  # the slope of the residual above which softening outruns unloading; the secant stays below it


class Angle(NamedTuple):
    """An angle of friction or dilation on its way from peak to residual, the same for all points."""

    peak: float  # [rad]
    residual: float  # [rad]
    sin_peak: float
    sin_residual: float


class FrictionalLaw(Protocol):
    """What `yielded` asks of a law: `softening` [-], one over the plastic strain at which the residual is reached."""

    def relax(self, trial, softened):
        """Return `trial`, a record of stress invariants, to the yield surface, and tell the growth of plastic strain.

        `softened` is the share of the way from peak to residual at which the strength stands.
        """


relax = generic(FrictionalLaw.relax)


@inlined
def softening_strain(history):
    """Plastic strain that the strength follows; the one place where a law reads it from the history."""
    return history.plastic_strain


@inlined
def sine(angle, softened):
    """Sine of an angle that falls linearly from peak to residual."""
    if softened <= 0.0:
        return angle.sin_peak
    if softened >= 1.0:
        return angle.sin_residual
    return sin(angle.peak + softened * (angle.residual - angle.peak))


@inlined
def cosine(sine):
    """Cosine of an angle in the first quadrant."""
    return sqrt(1.0 - sine * sine)


@inlined
def weakened(peak, residual, softened):
    """Cohesion that falls linearly from peak to residual."""
    return peak + min(softened, 1.0) * (residual - peak)


@inlined
def yielded(law, trial, history):
    """Relaxed invariants and growth of the plastic strain, the strength being that of the end of the step.

    The end's plastic strain k solves start + growth(k) - k = 0, by the secant method. The stress lies on the surface
    of the last k tried whether or not that has converged, which it does unless softening outruns unloading.
    """
    start = softening_strain(history)
    relaxed, growth = relax(law, trial, start * law.softening)
    if growth == 0.0 or law.softening == 0.0:
        return relaxed, growth
    before, before_excess, strain = start, growth, start + growth
    for _ in range(PASSES):
        relaxed, growth = relax(law, trial, strain * law.softening)
        excess = start + growth - strain
        if abs(excess) <= PRECISION * (1.0 + strain) or strain == before:
            break
        slope = min(STEEPEST, (excess - before_excess) / (strain - before))
        before, before_excess, strain = strain, excess, max(start, strain - excess / slope)
    return relaxed, growth


def angle(peak_deg: float, residual_deg: float) -> Angle:
    """Make an angle of friction or dilation from its peak and residual [degrees]."""
    peak, residual = radians(peak_deg), radians(residual_deg)
    return Angle(peak, residual, sin(peak), sin(residual))


def build_frictional(law, material, cell, count, cohesion):
    """Make a law of frictional soil and its history; arguments as for `VonMises.build`.

    The plastic strain at which the residual is reached is divided by cell over reference cell, where the material names
    one. The residual cohesion is proportional to the peak, point by point.

    Returns:
        The law, of class `law`, and a fresh history, with arrays of shape (count,).
    """
    lame, shear = lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)
    peak = np.full(count, material.cohesion_kpa * 1e3) if cohesion is None else np.asarray(cohesion)
    ratio = material.residual_cohesion_kpa / material.cohesion_kpa if material.cohesion_kpa > 0.0 else 1.0
    softening = 0.0
    if material.residual_plastic_strain is not None:
        softening = 1.0 / material.residual_plastic_strain
        if material.softening_reference_cell_m is not None:
            softening *= cell / material.softening_reference_cell_m
    made = law(
        lame,
        shear,
        peak,
        peak * ratio,
        angle(material.friction_angle_deg, material.residual_friction_angle_deg),
        angle(material.dilation_angle_deg, material.residual_dilation_angle_deg),
        np.inf if material.tension_cutoff_kpa is None else material.tension_cutoff_kpa * 1e3,
        softening,
    )
    return made, PlasticHistory(np.zeros(count))
