"""Drucker-Prager plasticity with a tension cut-off, matched to Mohr-Coulomb in plane strain."""

from math import inf, sqrt

from rfmpm.kernel_tools import Tensor
from rfmpm.mpm.laws.frictional import SMALLEST, THIRD, FrictionalHistory, FrictionalLaw, predict, strength


class DruckerPrager(FrictionalLaw):
    """Drained soil: sqrt(J2) + a p <= k, and p <= the tension cut-off.

    The engine is plane strain, so the cone is the one that flows there at the strength c, phi and with the dilation psi
    of Mohr-Coulomb: with b = sin(psi) / sqrt(1 + sin2(psi) / 3) for the flow, a = w sin(phi) and k = w c cos(phi) with
    w = sqrt(1 + sin2(psi) / 3) / (1 + sin(phi) sin(psi) / 3). For psi = phi that is the usual plane-strain match (de
    Souza Neto et al. 2008, section 6.4), for psi = 0 it is a = sin(phi). A compression cone would be 30 % too strong at
    phi = 20 degrees, so there is no other match.

    Flow: b in shear, associated on the cut-off, which is a bound of the mean stress here; both where they meet. A
    cut-off beyond the apex c cot(phi) never acts, and it does not soften. The plastic strain is that of the deviator.
    """

    def update_stress(self, stress, strain_increment, history, dt):
        """Elastic predictor and exact return to cone, cut-off, their corner or the apex."""
        trial, opening = predict(self, stress, strain_increment, history.opening)
        mean = (trial.xx + trial.yy + trial.zz) * THIRD
        sxx, syy, szz = trial.xx - mean, trial.yy - mean, trial.zz - mean
        tau = sqrt(0.5 * (sxx * sxx + syy * syy + szz * szz) + trial.xy * trial.xy)
        cohesion, s, cosine, p = strength(self, history)
        root = sqrt(1.0 + THIRD * p * p)
        match = root / (1.0 + THIRD * s * p)
        slope, limit = match * s, match * cohesion * cosine
        flow = 0.0 if opening > 0.0 else p / root
        beyond = tau + slope * mean - limit
        if beyond <= 0.0 and mean <= self.tension:
            return trial, FrictionalHistory(history.plastic_strain, opening)
        bulk = self.lame + 2.0 * THIRD * self.shear
        g = max(0.0, beyond) / (self.shear + bulk * slope * flow)
        highest = min(self.tension, limit / slope if slope > 0.0 else inf)
        after, relaxed, opened = mean - g * bulk * flow, tau - g * self.shear, 0.0
        if after > highest:
            after, relaxed, opened = highest, min(tau, max(0.0, limit - slope * highest)), (mean - highest) / bulk
        scale = relaxed / max(tau, SMALLEST)
        updated = Tensor(after + scale * sxx, after + scale * syy, after + scale * szz, scale * trial.xy)
        growth = (tau - relaxed) * sqrt(THIRD) / self.shear
        return updated, FrictionalHistory(history.plastic_strain + growth, opening + opened)
