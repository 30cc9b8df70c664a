"""Separable Markov correlation, exp(-2 |h| / theta_h - 2 |v| / theta_v).

Vanmarcke (1983), Random Fields: Analysis and Synthesis. Not isotropic even for equal scales.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Separable


class MarkovSeparable(Separable):
    def profile(self, lag: np.ndarray) -> np.ndarray:
        return np.exp(-2.0 * np.abs(lag))
