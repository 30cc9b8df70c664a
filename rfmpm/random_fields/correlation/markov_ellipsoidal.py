"""Ellipsoidal Markov correlation, exp(-2 sqrt((h / theta_h)^2 + (v / theta_v)^2)).

Fenton and Griffiths (2008), Risk Assessment in Geotechnical Engineering. Isotropic for equal scales.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Ellipsoidal


class MarkovEllipsoidal(Ellipsoidal):
    def profile(self, lag: np.ndarray) -> np.ndarray:
        return np.exp(-2.0 * lag)
