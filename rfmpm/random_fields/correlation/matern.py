"""Matern correlation, 2^(1 - nu) / Gamma(nu) s^nu K_nu(s) with s = c sqrt((h / theta_h)^2 + (v / theta_v)^2).

Matern (1960), Spatial Variation; Abramowitz and Stegun (1964), 11.4.22, for c = 2 sqrt(pi) Gamma(nu + 1/2) / Gamma(nu),
which makes theta the integral along each axis. Ellipsoidal, positive definite in any dimension. The larger nu, the
smoother: 0.5 is `markov_ellipsoidal`, and from 20 on it is hardly told from `gaussian`.
"""

from dataclasses import dataclass
from math import exp, factorial, lgamma, log, pi, sqrt

import numpy as np

from rfmpm.random_fields.correlation.anisotropy import Ellipsoidal

LOWEST_NU, HIGHEST_NU = 0.05, 20.0


@dataclass(frozen=True)
class Matern(Ellipsoidal):
    """Matern correlation.

    Attributes:
        nu: smoothness, 0.05 to 20 [-].
    """

    nu: float = 1.5

    def __post_init__(self) -> None:
        super().__post_init__()
        if not LOWEST_NU <= self.nu <= HIGHEST_NU:
            raise ValueError(f"nu = {self.nu}: must lie between {LOWEST_NU:g} and {HIGHEST_NU:g}")

    def profile(self, lag: np.ndarray) -> np.ndarray:
        s = 2.0 * sqrt(pi) * exp(lgamma(self.nu + 0.5) - lgamma(self.nu)) * lag
        p = self.nu - 0.5
        return _half_integer(int(p), s) if p == int(p) else _by_bessel_function(self.nu, s)


def _half_integer(p: int, s: np.ndarray) -> np.ndarray:
    # exp(-s) times a polynomial of degree p (Rasmussen and Williams 2006, Gaussian Processes, eq. 4.16): no K_nu.
    scale = factorial(p) / factorial(2 * p)
    polynomial = 0.0
    for i in range(p + 1):  # from the highest power down
        polynomial = polynomial * s + scale * factorial(p + i) / (factorial(i) * factorial(p - i)) * 2.0 ** (p - i)
    return polynomial * np.exp(-s)


def _by_bessel_function(nu: float, s: np.ndarray) -> np.ndarray:
    from scipy.special import kve  # late: scipy only where a study asks for this correlation

    s = np.asarray(s, dtype=float)
    near = s < 1e-300  # the logarithm of zero
    safe = np.where(near, 1.0, s)
    with np.errstate(divide="ignore", over="ignore"):
        logarithm = (1.0 - nu) * log(2.0) - lgamma(nu) + nu * np.log(safe) + np.log(kve(nu, safe)) - safe
    # Where K_nu itself has overflowed the lag is so small that the correlation is one to the last digit.
    return np.where(near | ~np.isfinite(logarithm) & (safe < 1.0), 1.0, np.exp(np.minimum(logarithm, 0.0)))
