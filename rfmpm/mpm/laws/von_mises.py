"""Von Mises plasticity, sqrt(J2) = c, with cohesion falling linearly to a residual value and rising with the rate."""

from math import sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor
from rfmpm.mpm.laws.elastic import hooke, lame_constants
from rfmpm.mpm.laws.history import NonlocalHistory, PlasticHistory
from rfmpm.mpm.laws.strengths import cohesions
from rfmpm.mpm.protocols import grown, local_share, softening_strain

THIRD = 1.0 / 3.0
PER_STRAIN = sqrt(THIRD)  # equivalent plastic strain per plastic shear
SMALLEST = 1e-300  # keeps a stress without shear, and a step of no time, out of the divisions


class VonMises(NamedTuple):
    """Undrained soil; `peak` and `residual` are cohesions in terms of sqrt(J2), one per point or uniform."""

    lame: float  # first Lame parameter [Pa]
    shear: float  # shear modulus [Pa]
    viscosity: float  # strength gained per rate of plastic shear [Pa s]
    peak: float  # [Pa]
    residual: float  # [Pa]
    softening: float  # loss of cohesion per unit equivalent plastic strain [Pa]

    def update_stress(self, stress, strain_increment, history, dt):
        """Elastic predictor and exact radial return.

        In terms of the plastic shear g (engineering), the equivalent plastic strain grows by g / sqrt(3), sqrt(J2)
        falls by G g, the cohesion falls by H g / sqrt(3) and the strength gains eta g / dt: one linear equation on the
        softening branch, another one on the residual plateau (de Souza Neto et al. 2008, sections 7.3 and 11.2).
        """
        trial = hooke(self.lame, self.shear, stress, strain_increment)
        mean = (trial.xx + trial.yy + trial.zz) * THIRD
        sxx, syy, szz = trial.xx - mean, trial.yy - mean, trial.zz - mean
        tau = sqrt(0.5 * (sxx * sxx + syy * syy + szz * szz) + trial.xy * trial.xy)
        cohesion = max(self.residual, self.peak - self.softening * softening_strain(history))
        fall = self.softening * PER_STRAIN * local_share(history)
        stiffness = self.shear + self.viscosity / max(dt, SMALLEST)
        g = 0.0 if tau <= cohesion else (tau - cohesion) / (stiffness - fall)  # what is not a number stays so
        if cohesion - fall * g < self.residual:
            g = (tau - self.residual) / stiffness
        scale = 1.0 - self.shear * g / max(tau, SMALLEST)
        relaxed = Tensor(mean + scale * sxx, mean + scale * syy, mean + scale * szz, scale * trial.xy)
        return relaxed, grown(history, g * PER_STRAIN)

    def quasi_static(self, stiffer, factor):
        """The law of slow loading: stiffness times `stiffer`, peak strength over `factor`, no softening, no rate."""
        peak = self.peak / factor
        return VonMises(self.lame * stiffer, self.shear * stiffer, 0.0, peak, peak, 0.0)

    @classmethod
    def build(cls, material, cell, count, strengths):
        """Make the law and its history from a study's material.

        Args:
            material: the study's material.
            cell: side of a cell [m]; the softening modulus is scaled with it where the material names a reference.
            count: number of points.
            strengths: what varies from point to point, by name, arrays of shape (count,): cohesion and
                residual_cohesion [Pa]. The rest is the material's own; a residual that is not given is proportional to
                the peak, and one that is given counts as far as it is below the peak.

        Returns:
            The law and a fresh history, with arrays of shape (count,).
        """
        lame, shear = lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)
        peak, residual = cohesions(material, count, strengths)
        softening = material.softening_modulus_kpa * 1e3
        if material.softening_reference_cell_m is not None:
            softening *= cell / material.softening_reference_cell_m
        unit = 1.0 if material.strength_convention == "sqrt_j2" else PER_STRAIN
        law = cls(lame, shear, material.viscosity_kpa_s * 1e3, peak * unit, residual * unit, softening * unit)
        if material.softening_length_m is None:
            return law, PlasticHistory(np.zeros(count))
        return law, NonlocalHistory(np.zeros(count), np.zeros(count))
