"""What a correlation offers to methods and to what is built on it."""

from math import degrees
from typing import Protocol

import numpy as np


class Correlation(Protocol):
    """A correlation: an `Anisotropy`, or one made from another; its repr determines it.

    Attributes:
        theta_h: scale of fluctuation along the h axis [m]; of one made from another: that of the other.
        theta_v: scale of fluctuation across the h axis [m]; the same holds.
        rotation: angle of the h axis from the x axis, counter-clockwise [rad].
        separable: whether it is the product of one along its h axis and one along its v axis.
    """

    theta_h: float
    theta_v: float
    rotation: float
    separable: bool

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation [-] at lags of any shape [m], same shape."""


def in_words(correlation: Correlation) -> str:
    """A correlation by the keys of a study that set its lengths and its direction, for a message."""
    lengths = f"scale_of_fluctuation_h_m = {correlation.theta_h:g}, scale_of_fluctuation_v_m = {correlation.theta_v:g}"
    turned = f", rotation_deg = {degrees(correlation.rotation):g}" if correlation.rotation else ""
    return f"the correlation with {lengths}{turned}"
