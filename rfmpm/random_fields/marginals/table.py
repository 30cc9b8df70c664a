"""A quantile function that takes microseconds a value, replaced by a spline that takes a thirtieth of one."""

from collections.abc import Callable
from functools import partial

import numpy as np

FARTHEST = 13.0  # a standard-normal value is farther from zero with a probability of 1e-38
NODES = np.linspace(-FARTHEST, FARTHEST, 5201)


def tabulate(function: Callable[[np.ndarray], np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    """Cubic spline through a smooth function of a standard-normal value, constant beyond 13 on either side.

    Args:
        function: takes and returns arrays of one shape; its fourth derivative is about one or less.

    Returns:
        the spline, off by the fourth derivative times 2e-12 (step 0.005: h^4 / 384).
    """
    from scipy.interpolate import CubicSpline

    return partial(_look_up, CubicSpline(NODES, function(NODES)))


def _look_up(spline: Callable[[np.ndarray], np.ndarray], z: np.ndarray) -> np.ndarray:
    return spline(np.clip(z, -FARTHEST, FARTHEST))
