"""Von Mises plasticity, sqrt(J2) = c, with cohesion falling linearly to a residual value."""

from math import sqrt
from typing import NamedTuple

from rfmpm.kernel_tools import Tensor
from rfmpm.mpm.laws.elastic import hooke


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
        mean = (trial.xx + trial.yy + trial.zz) / 3.0
        sxx, syy, szz = trial.xx - mean, trial.yy - mean, trial.zz - mean
        j2 = 0.5 * (sxx * sxx + syy * syy + szz * szz) + trial.xy * trial.xy
        cohesion = max(self.residual, self.peak - self.softening * history.plastic_strain)
        if j2 <= cohesion * cohesion:
            return trial, history
        tau = sqrt(j2)
        per_strain = sqrt(1.0 / 3.0)
        g = (tau - cohesion) / (self.shear - self.softening * per_strain)
        cohesion -= self.softening * per_strain * g
        if cohesion < self.residual:
            cohesion = self.residual
            g = (tau - cohesion) / self.shear
        scale = cohesion / tau
        relaxed = Tensor(mean + scale * sxx, mean + scale * syy, mean + scale * szz, scale * trial.xy)
        return relaxed, PlasticHistory(history.plastic_strain + g * per_strain)
