"""What the frictional laws share: strength that falls linearly with plastic strain, and the gap of soil that opened.

The strength of a step is that of the plastic strain at its start: it lags behind by what falls within one step, at most
the growth of plastic strain over the strain at the residual, as a share of the whole fall. The lag does not add up.

Soil pulled apart in the plane opens, and bears compression again only when it has closed: until then its mean stress in
the plane does not fall below zero and shearing does not dilate it (after Dunatunga and Kamrin 2015, who tell by the
density). Without this, soil that flew apart would be stiff on landing at whatever volume it then has.
"""

from math import radians, sqrt, tan
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor, inlined
from rfmpm.mpm.laws.elastic import hooke, lame_constants
from rfmpm.mpm.laws.strengths import cohesions

THIRD = 1.0 / 3.0
SMALLEST = 1e-300  # [Pa]; keeps the direction of a stress without direction finite
SINE_SERIES = tuple(-1.0 / (k * (k + 1.0)) for k in range(2, 18, 2))  # from one term to the next


class Angle(NamedTuple):
    """An angle of friction or dilation on its way from peak to residual, per point or uniform."""

    peak: float  # [rad]
    residual: float  # [rad]


class FrictionalHistory(NamedTuple):
    """What plastic flow leaves behind."""

    plastic_strain: float  # equivalent, of the deviator: integral of sqrt(2/3 de_p : de_p) [-]
    opening: float  # strain of the area by which the soil is open [-]


class Strength(NamedTuple):
    """Cohesion and angles of one point at one moment."""

    cohesion: float  # [Pa]
    sin_friction: float
    cos_friction: float
    sin_dilation: float


@inlined
def softening_strain(history):
    """Plastic strain that the strength follows; the one place where a law reads it from the history."""
    return history.plastic_strain


@inlined
def sine(angle):
    """Sine of an angle of at most 80 degrees to 1e-14, by its series.

    A call would keep the compiler from updating several points at once.
    """
    square, term, total = angle * angle, angle, angle
    for factor in SINE_SERIES:
        term *= factor * square
        total += term
    return total


@inlined
def fallen(falling, share):
    """Value after that share of the way from `peak` to `residual`."""
    return falling.peak + share * (falling.residual - falling.peak)


@inlined
def strength(law, history):
    """Strength of a law with `peak`, `residual`, `friction`, `dilation` and `softening`, after that history."""
    share = min(1.0, softening_strain(history) * law.softening)
    sin_friction = sine(fallen(law.friction, share))
    cos_friction = sqrt(1.0 - sin_friction * sin_friction)
    return Strength(fallen(law, share), sin_friction, cos_friction, sine(fallen(law.dilation, share)))


@inlined
def predict(law, stress, strain_increment, opening):
    """Elastic predictor; an opening closes before the mean stress in the plane falls below zero.

    Returns (trial stress, opening left).
    """
    trial = hooke(law.lame, law.shear, stress, strain_increment)
    plane = law.lame + law.shear
    closing = min(opening, max(0.0, -0.5 * (trial.xx + trial.yy) / plane))
    relief = plane * closing
    raised = Tensor(trial.xx + relief, trial.yy + relief, trial.zz + law.lame * closing, trial.xy)
    return raised, opening - closing


class FrictionalLaw(NamedTuple):
    """Parameters of a frictional law; the laws themselves add `update_stress`."""

    lame: float  # first Lame parameter [Pa]
    shear: float  # shear modulus [Pa]
    peak: float  # cohesion, per point or uniform [Pa]
    residual: float  # cohesion [Pa]
    friction: Angle
    dilation: Angle
    tension: float  # cut-off, in the law's own measure of tension; infinite for none [Pa]
    softening: float  # one over the plastic strain at which the residual is reached; 0 for no softening [-]

    def quasi_static(self, stiffer, factor):
        """As for `VonMises`; cohesion and the tangents of both angles are what is divided by `factor`."""
        peak = self.peak / factor
        friction, dilation = (
            Angle(*2 * (np.arctan(np.tan(angle.peak) / factor),)) for angle in (self.friction, self.dilation)
        )
        return self._replace(
            lame=self.lame * stiffer,
            shear=self.shear * stiffer,
            peak=peak,
            residual=peak,
            friction=friction,
            dilation=dilation,
            softening=0.0,
        )

    @classmethod
    def build(cls, material, cell, count, strengths):
        """Make the law and its history from a study's material; arguments and results as for `VonMises.build`.

        `strengths` may hold friction_angle [rad] too: the peak. The tangents of its residual and of the angles of
        dilation are proportional to its tangent, point by point, so that dilation stays below friction.

        The plastic strain at which the residual is reached is divided by cell over reference cell, where the material
        names one. The residual cohesion is proportional to the peak, point by point.
        """
        lame, shear = lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)
        peak, residual = cohesions(material, count, strengths)
        friction = material.friction_angle_deg, material.residual_friction_angle_deg
        dilation = material.dilation_angle_deg, material.residual_dilation_angle_deg
        scale = None
        if "friction_angle" in strengths:
            scale = np.tan(strengths["friction_angle"]) / tan(radians(material.friction_angle_deg))
        softening = 0.0
        if material.residual_plastic_strain is not None:
            softening = 1.0 / material.residual_plastic_strain
            if material.softening_reference_cell_m is not None:
                softening *= cell / material.softening_reference_cell_m
        law = cls(
            lame,
            shear,
            peak,
            residual,
            Angle(*(_angle(degrees, scale) for degrees in friction)),
            Angle(*(_angle(degrees, scale) for degrees in dilation)),
            np.inf if material.tension_cutoff_kpa is None else material.tension_cutoff_kpa * 1e3,
            softening,
        )
        return law, FrictionalHistory(np.zeros(count), np.zeros(count))


def _angle(degrees, scale):
    """An angle [rad], its tangent times `scale` point by point; None leaves it, and what is zero, uniform."""
    if scale is None or degrees == 0.0:
        return radians(degrees)
    return np.arctan(scale * tan(radians(degrees)))
