"""Separable field on an unrotated lattice by the Cholesky factors of its two axes: exact for any separable kernel."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words
from rfmpm.random_fields.lattice import Lattice, require_lattice
from rfmpm.random_fields.methods.cholesky import factor
from rfmpm.random_fields.methods.nodes import is_aligned, is_index_of, node_numbers, pick


class KroneckerRecord(NamedTuple):
    """Lower factors along y, shape (rows, rows), and along x, shape (columns, columns) [-].

    `index`, shape (n,): node number of every point, or empty where the points are all nodes in order; `nuggets`,
    shape (2,) [-]: what was added to the diagonals along y and x.
    """

    index: np.ndarray
    lower_y: np.ndarray
    lower_x: np.ndarray
    nuggets: np.ndarray


class Kronecker:
    """Field L_y Xi L_x^T: the covariance is the Kronecker product of those along the axes."""

    Record = KroneckerRecord

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray) -> KroneckerRecord:
        """Find the lattice of the points and factor the correlations along its axes.

        Args:
            correlation: a separable correlation along x and y.
            points: positions on a lattice, shape (n, 2) [m].

        Returns:
            the record; it takes one variable per node, row after row.

        Raises:
            ValueError: the points are scattered, the correlation is not separable along x and y, or it is not positive
                definite along an axis even with the largest nugget of `cholesky.NUGGETS`.
        """
        lattice = require_lattice(points, "kronecker")
        if not is_product(correlation):
            raise ValueError(f"kronecker: {in_words(correlation)} is not separable along x and y; take method auto")
        (lower_y, nugget_y), (lower_x, nugget_x) = (
            factor(along.copy) for along in axis_correlations(correlation, lattice)
        )
        return KroneckerRecord(node_numbers(lattice), lower_y, lower_x, np.array([nugget_y, nugget_x]))

    @staticmethod
    def n_variables(record: KroneckerRecord) -> int:
        """Number of nodes of the lattice."""
        return len(record.lower_y) * len(record.lower_x)

    @staticmethod
    def transform(record: KroneckerRecord, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-]."""
        with single_blas_thread():
            field = record.lower_y @ xi.reshape(len(record.lower_y), -1) @ record.lower_x.T
        return pick(field, record.index)

    @staticmethod
    def is_intact(record: KroneckerRecord, points: np.ndarray) -> bool:
        """Whether node numbers, shapes and unit variances fit these points."""
        index, lower_y, lower_x, nuggets = record
        if lower_y.ndim != 2 or lower_x.ndim != 2 or nuggets.shape != (2,):
            return False
        for lower, nugget in ((lower_y, nuggets[0]), (lower_x, nuggets[1])):
            n = len(lower)
            if lower.shape != (n, n) or lower.dtype != np.float64 or not lower.flags.c_contiguous:
                return False
            if not np.all(np.abs(np.einsum("ij,ij->i", lower, lower) - 1.0 - nugget) < max(n, 10) * 1e-14):
                return False
        return is_index_of(index, np.array([len(lower_y), len(lower_x)]), points)

    @staticmethod
    def covariance_error(record: KroneckerRecord) -> float:
        """What the nuggets add to the variance [-]."""
        return float(np.prod(1.0 + record.nuggets) - 1.0)


def is_product(correlation: Anisotropy) -> bool:
    """Whether the correlation is a product of one along x and one along y."""
    return correlation.separable and is_aligned(correlation)


def axis_correlations(correlation: Anisotropy, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """Correlation matrices along y, shape (rows, rows), and along x, shape (columns, columns) [-]."""
    along_y = correlation.rho(np.zeros(lattice.rows), lattice.lags_y)
    along_x = correlation.rho(lattice.lags_x, np.zeros(lattice.columns))
    return tuple(
        values[np.abs(np.subtract.outer(np.arange(len(values)), np.arange(len(values))))]
        for values in (along_y, along_x)
    )
