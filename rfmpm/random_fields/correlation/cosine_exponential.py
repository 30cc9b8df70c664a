"""Cosine exponential correlation, exp(-|h| / theta_h) cos(h / theta_h), times the same in v.

Vanmarcke (1983), Random Fields: Analysis and Synthesis; Phoon, Quek and An (2003), J. Geotech. Geoenviron. Eng. 129(8),
for soundings. It falls to -0.067 at a lag of 2.4 theta: weak follows strong, as in a layered deposit. Separable, so
that it is positive definite whatever the ratio of scales.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Separable


class CosineExponential(Separable):
    def profile(self, lag: np.ndarray) -> np.ndarray:
        return np.exp(-np.abs(lag)) * np.cos(lag)
