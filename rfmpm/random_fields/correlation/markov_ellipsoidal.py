"""Ellipsoidal Markov correlation, exp(-2 sqrt((h / theta_h)^2 + (v / theta_v)^2)).

Fenton and Griffiths (2008), Risk Assessment in Geotechnical Engineering. Isotropic for equal scales.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Anisotropy


class MarkovEllipsoidal(Anisotropy):
    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        h, v = self.relative_lags(lag_x, lag_y)
        return np.exp(-2.0 * np.sqrt(h * h + v * v))
