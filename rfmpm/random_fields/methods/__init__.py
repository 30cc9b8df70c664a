"""The methods that turn a standard-normal vector into a correlated field. A new one is a file here and a line below."""

from typing import Any

import numpy as np

from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.lattice import find_lattice
from rfmpm.random_fields.methods.ar1 import Ar1, is_markov
from rfmpm.random_fields.methods.cholesky import Cholesky
from rfmpm.random_fields.methods.circulant import Circulant
from rfmpm.random_fields.methods.embedding import is_accurate
from rfmpm.random_fields.methods.karhunen_loeve import KarhunenLoeve
from rfmpm.random_fields.methods.kronecker import Kronecker, is_product
from rfmpm.random_fields.methods.local_average_subdivision import LocalAverageSubdivision
from rfmpm.random_fields.methods.local_kriging import LocalKriging
from rfmpm.random_fields.methods.protocol import FieldMethod

METHODS: dict[str, type[FieldMethod]] = {
    "cholesky": Cholesky,
    "kronecker": Kronecker,
    "ar1": Ar1,
    "circulant": Circulant,
    "karhunen_loeve": KarhunenLoeve,
    "local_average_subdivision": LocalAverageSubdivision,
    "local_kriging": LocalKriging,
}
# Keys of a study that a method's `prepare` takes by name, where they are given.
OPTIONS: dict[str, tuple[str, ...]] = {"karhunen_loeve": ("karhunen_loeve_variance_share",)}
AUTO = "auto"
FEW_POINTS = 500  # so few that the dense factor costs no more than the rest
MOST_DENSE_POINTS = 5000  # 0.2 GB for the factor
MOST_KRONECKER_NODES = 2500  # beyond, the circulant embedding is faster


def choose(correlation: Anisotropy, points: np.ndarray) -> str:
    """The fastest method that is exact, or as accurate as the default asks, on these points.

    Args:
        correlation: correlation of the standard-normal field.
        points: positions, shape (n, 2) [m].

    Returns:
        a name in `METHODS`: the recursions or the factors of the axes for a separable correlation on a lattice, the
        dense factor for few points, the circulant embedding on a lattice where it is accurate, the dense factor for
        some more points, the factors of the axes again, and kriging from a lattice for many scattered points.
    """
    lattice = find_lattice(points)
    if lattice is not None and is_markov(correlation, lattice):
        return "ar1"
    nodes = 0 if lattice is None else lattice.rows * lattice.columns
    factors = nodes > 0 and is_product(correlation)
    if factors and nodes <= MOST_KRONECKER_NODES:
        return "kronecker"
    if len(points) <= FEW_POINTS:
        return "cholesky"
    if lattice is not None and is_accurate(correlation, lattice):
        return "circulant"
    if len(points) <= MOST_DENSE_POINTS:
        return "cholesky"
    if factors:
        return "kronecker"
    return "local_kriging" if lattice is None else "circulant"


def covariance_error(method: str, record: Any) -> float:
    """Largest difference [-] between the covariance of a field and the asked one; each method says over which lags."""
    return METHODS[method].covariance_error(record)
