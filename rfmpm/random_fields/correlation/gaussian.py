"""Gaussian correlation, exp(-pi ((h / theta_h)^2 + (v / theta_v)^2)).

Vanmarcke (1983), Random Fields: Analysis and Synthesis. Separable and, for equal scales, isotropic; very smooth.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Anisotropy


class Gaussian(Anisotropy):
    separable = True

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        h, v = self.relative_lags(lag_x, lag_y)
        return np.exp(-np.pi * (h * h + v * v))
