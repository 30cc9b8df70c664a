"""Gaussian correlation, exp(-pi ((h / theta_h)^2 + (v / theta_v)^2)).

Vanmarcke (1983), Random Fields: Analysis and Synthesis. Separable and, for equal scales, isotropic; very smooth.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Separable


class Gaussian(Separable):
    def profile(self, lag: np.ndarray) -> np.ndarray:
        return np.exp(-np.pi * lag * lag)
