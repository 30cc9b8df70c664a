"""Von Mises plasticity, sqrt(J2) = c, with cohesion falling linearly to a residual value."""

from math import sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor
from rfmpm.mpm.laws.elastic import hooke, lame_constants

THIRD = 1.0 / 3.0


class PlasticHistory(NamedTuple):
    """What plastic flow leaves behind."""

    plastic_strain: float  # equivalent: integral of sqrt(2/3 de_p : de_p) [-]


class VonMises(NamedTuple):
    """Undrained soil; `peak` and `residual` are cohesions in terms of sqrt(J2), one per point or uniform."""

    lame: float  # first Lame parameter [Pa]
    shear: float  # shear modulus [Pa]
    peak: float  # [Pa]
    residual: float  # [Pa]
    softening: float  # loss of cohesion per unit equivalent plastic strain [Pa]

    def update_stress(self, stress, strain_increment, history):
        """Elastic predictor and exact radial return.

        In terms of the plastic shear g (engineering), the equivalent plastic strain grows by g / sqrt(3), sqrt(J2)
        falls by G g and the cohesion by H g / sqrt(3): one linear equation on the softening branch, another one on the
        residual plateau (de Souza Neto et al. 2008, section 7.3).
        """
        trial = hooke(self.lame, self.shear, stress, strain_increment)
        mean = (trial.xx + trial.yy + trial.zz) * THIRD
        sxx, syy, szz = trial.xx - mean, trial.yy - mean, trial.zz - mean
        j2 = 0.5 * (sxx * sxx + syy * syy + szz * szz) + trial.xy * trial.xy
        cohesion = max(self.residual, self.peak - self.softening * history.plastic_strain)
        if j2 <= cohesion * cohesion:
            return trial, history
        tau = sqrt(j2)
        per_strain = sqrt(THIRD)
        # Reciprocals of what is the same at every point: a loop over points divides once.
        g = (tau - cohesion) * (1.0 / (self.shear - self.softening * per_strain))
        cohesion -= self.softening * per_strain * g
        if cohesion < self.residual:
            cohesion = self.residual
            g = (tau - cohesion) * (1.0 / self.shear)
        scale = cohesion / tau
        relaxed = Tensor(mean + scale * sxx, mean + scale * syy, mean + scale * szz, scale * trial.xy)
        return relaxed, PlasticHistory(history.plastic_strain + g * per_strain)

    @classmethod
    def build(cls, material, cell, count, cohesion):
        """Make the law and its history from a study's material.

        Args:
            material: the study's material.
            cell: side of a cell [m]; the softening modulus is scaled with it where the material names a reference.
            count: number of points.
            cohesion: peak cohesion of each point, shape (count,) [Pa]; None for the material's own.

        Returns:
            The law and a fresh history, with arrays of shape (count,).
        """
        lame, shear = lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)
        peak = np.full(count, material.cohesion_kpa * 1e3) if cohesion is None else np.asarray(cohesion)
        residual = peak * (material.residual_cohesion_kpa / material.cohesion_kpa)
        softening = material.softening_modulus_kpa * 1e3
        if material.softening_reference_cell_m is not None:
            softening *= cell / material.softening_reference_cell_m
        unit = 1.0 if material.strength_convention == "sqrt_j2" else sqrt(THIRD)
        return cls(lame, shear, peak * unit, residual * unit, softening * unit), PlasticHistory(np.zeros(count))
