"""A correlation of which a share of the variance, the nugget, differs from point to point without any correlation.

Webster and Oliver (2007), Geostatistics for Environmental Scientists, section 5.2. Variation over less than the
distance of the points looks like this. A lag of exactly zero means a point and itself, of correlation one; two points
at one place are two points, and in a realised field each has its own uncorrelated part.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from rfmpm.random_fields.correlation.protocol import Correlation


@dataclass(frozen=True)
class WithNugget:
    """(1 - nugget) times a correlation at every lag but zero; the scales are those of the correlated part."""

    correlated: Correlation
    nugget: float
    separable: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.nugget < 1.0:
            raise ValueError(f"nugget = {self.nugget}: must be at least 0 and less than 1")

    @property
    def theta_h(self) -> float:
        return self.correlated.theta_h

    @property
    def theta_v(self) -> float:
        return self.correlated.theta_v

    @property
    def rotation(self) -> float:
        return self.correlated.rotation

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        """Correlation at a lag; see `Anisotropy.rho`."""
        is_same = (np.asarray(lag_x) == 0.0) & (np.asarray(lag_y) == 0.0)
        return np.where(is_same, 1.0, (1.0 - self.nugget) * self.correlated.rho(lag_x, lag_y))
