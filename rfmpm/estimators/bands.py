"""Bands that hold a whole curve at once, from the contributions of independent units."""

import numpy as np
from scipy.special import stdtrit

from rfmpm.estimators.contributions import Contributions

DRAWS = 1000
LARGEST = 2**22  # numbers drawn at a time


def simultaneous_factor(found: Contributions, confidence: float) -> float:
    """Return by how much pointwise intervals have to be widened to hold all k expectations at once.

    The units' deviations are multiplied by independent standard normals, which gives the largest studentised error over
    the curve its distribution; their common standard error is as uncertain as Student's t has it, which matters where
    units are few. The seed is fixed, so the same rows give the same band.

    Args:
        found: contributions, shape (n, k).
        confidence: level [-].

    Returns:
        Factor, at least 1 [-]; 1 where nothing varies.

    Source: Chernozhukov, Chetverikov and Kato (2013), Annals of Statistics 41, 2786-2819, doi:10.1214/13-AOS1161.
    """
    if len(found.unit) < 2:
        return 1.0
    error = found.standard_error()
    varies = np.isfinite(error) & (error > 0.0)
    if not varies.any():
        return 1.0
    scaled = found.deviations()[:, varies] / error[varies]
    generator = np.random.default_rng(0)
    batch = max(1, min(DRAWS, LARGEST // len(scaled)))
    largest = [
        np.abs(generator.standard_normal((min(batch, DRAWS - start), len(scaled))) @ scaled).max(axis=1)
        for start in range(0, DRAWS, batch)
    ]
    freedom = float(np.min(found.degrees_of_freedom()[varies]))
    scatter = np.sqrt(generator.chisquare(freedom, DRAWS) / freedom)
    sup = np.quantile(np.concatenate(largest) / scatter, confidence)
    return max(1.0, float(sup / stdtrit(freedom, 0.5 + confidence / 2.0)))
