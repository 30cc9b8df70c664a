"""Separable Markov correlation, exp(-2 |h| / theta_h - 2 |v| / theta_v).

Vanmarcke (1983), Random Fields: Analysis and Synthesis. Not isotropic even for equal scales.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Anisotropy


class MarkovSeparable(Anisotropy):
    separable = True

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        h, v = self.relative_lags(lag_x, lag_y)
        return np.exp(-2.0 * (np.abs(h) + np.abs(v)))
