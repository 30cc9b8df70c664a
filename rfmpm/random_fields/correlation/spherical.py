"""Spherical correlation, 1 - 1.5 s + 0.5 s^3 with s = 0.75 sqrt((h / theta_h)^2 + (v / theta_v)^2); zero from s = 1.

Webster and Oliver (2007), Geostatistics for Environmental Scientists, section 5.2. Ellipsoidal, positive definite in up
to three dimensions; values further apart than 4/3 of the scale of fluctuation are independent.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Ellipsoidal


class Spherical(Ellipsoidal):
    def profile(self, lag: np.ndarray) -> np.ndarray:
        s = np.minimum(0.75 * lag, 1.0)
        return 1.0 - s * (1.5 - 0.5 * s * s)
