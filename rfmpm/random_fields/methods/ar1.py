"""Separable Markov field on an unrotated lattice by one recursion along each axis: exact, and linear in the points."""

from math import sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words
from rfmpm.random_fields.lattice import Lattice, require_lattice
from rfmpm.random_fields.methods.nodes import is_aligned, is_index_of, node_numbers, pick

IDENTITY = 1e-12  # rounding of a power of the correlation at one spacing


class Ar1Record(NamedTuple):
    """What two recursions need.

    `index`, shape (n,): node number of every point, or empty where the points are all nodes in order; `shape`: rows,
    columns; `weights`, shape (2, 2) [-]: along y and along x, the weights of the last value and of the new variable.
    """

    index: np.ndarray
    shape: np.ndarray
    weights: np.ndarray


class Ar1:
    """Field z[k] = a z[k-1] + sqrt(1 - a^2) xi[k] along both axes, a the correlation at one spacing.

    Box, Jenkins and Reinsel (1994), Time Series Analysis: a Markov process is a first-order autoregression.
    """

    Record = Ar1Record

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray) -> Ar1Record:
        """Find the lattice of the points and the weights of the recursions.

        Args:
            correlation: a separable correlation along x and y, whose factors fall by one ratio per spacing.
            points: positions on a lattice, shape (n, 2) [m].

        Returns:
            the record; it takes one variable per node, row after row.

        Raises:
            ValueError: the points are scattered, or the correlation is not of this kind.
        """
        lattice = require_lattice(points, "ar1")
        if not is_markov(correlation, lattice):
            raise ValueError(
                f"ar1: {in_words(correlation)} is not an unrotated separable Markov correlation; take method auto"
            )
        lags = np.array([[0.0, lattice.dy], [lattice.dx, 0.0]])
        ratios = correlation.rho(lags[:, 0], lags[:, 1])
        weights = np.array([[a, sqrt(-np.expm1(2.0 * np.log(a))) if a > 0.0 else 1.0] for a in ratios])
        return Ar1Record(node_numbers(lattice), np.array([lattice.rows, lattice.columns]), weights)

    @staticmethod
    def n_variables(record: Ar1Record) -> int:
        """Number of nodes of the lattice."""
        return int(np.prod(record.shape))

    @staticmethod
    def transform(record: Ar1Record, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-]."""
        field = np.empty(tuple(record.shape))
        _recur(np.ascontiguousarray(xi).reshape(field.shape), record.weights, field)
        return pick(field, record.index)

    @staticmethod
    def is_intact(record: Ar1Record, points: np.ndarray) -> bool:
        """Whether the node numbers and the unit variances fit these points."""
        index, shape, weights = record
        return (
            is_index_of(index, shape, points)
            and weights.shape == (2, 2)
            and weights.dtype == np.float64
            and bool(np.all(np.abs(np.sum(weights**2, axis=1) - 1.0) < IDENTITY))
        )

    @staticmethod
    def covariance_error(record: Ar1Record) -> float:
        """None [-]."""
        return 0.0


def is_markov(correlation: Anisotropy, lattice: Lattice) -> bool:
    """Whether the correlation on the lattice is the product of powers of its values at one spacing."""
    if not correlation.separable or not is_aligned(correlation):
        return False
    ends = correlation.rho(lattice.lags_x[-1:], lattice.lags_y[-1:])
    along = (
        (correlation.rho(lattice.lags_x, 0.0 * lattice.lags_x), lattice.columns),
        (correlation.rho(0.0 * lattice.lags_y, lattice.lags_y), lattice.rows),
    )
    powers = [values[min(1, count - 1)] ** np.arange(count) for values, count in along]
    near = all(np.all(np.abs(v - p) <= IDENTITY) for (v, _), p in zip(along, powers, strict=True))
    return bool(near and np.all(np.abs(ends - powers[0][-1] * powers[1][-1]) <= IDENTITY))


@kernel
def _recur(xi, weights, field):
    (a_y, s_y), (a_x, s_x) = weights
    rows, columns = xi.shape
    for j in range(rows):
        along = xi[j, 0]
        if j == 0:
            field[0, 0] = along
            for i in range(1, columns):
                along = a_x * along + s_x * xi[0, i]
                field[0, i] = along
        else:
            field[j, 0] = a_y * field[j - 1, 0] + s_y * along
            for i in range(1, columns):
                along = a_x * along + s_x * xi[j, i]
                field[j, i] = a_y * field[j - 1, i] + s_y * along
