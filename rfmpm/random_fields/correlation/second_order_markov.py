"""Second-order Markov correlation, (1 + 4 |h| / theta_h) exp(-4 |h| / theta_h), times the same in v.

Vanmarcke (1983), Random Fields: Analysis and Synthesis; Phoon, Quek and An (2003), J. Geotech. Geoenviron. Eng. 129(8),
for soundings. Its fields have a slope everywhere. Separable here, as fitted to soundings one line at a time; the
isotropic field with this correlation on every line is `matern` with nu = 1.5.
"""

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Separable


class SecondOrderMarkov(Separable):
    def profile(self, lag: np.ndarray) -> np.ndarray:
        s = 4.0 * np.abs(lag)
        return (1.0 + s) * np.exp(-s)
