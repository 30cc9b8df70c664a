"""Field by the Cholesky factor of the covariance between all points: exact on any set of up to about 5000 points."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words

# Added to the unit diagonal, in this order, until the factor exists. Rounding leaves eigenvalues of about -1e-13 in
# the matrix of a smooth correlation or of coincident points; one that needs more than the last is not a covariance.
NUGGETS = (0.0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10)
ROWS_AT_ONCE = 64


class CholeskyRecord(NamedTuple):
    """The lower factor, shape (n, n), C order [-], and the nugget on the diagonal it was made from, shape () [-]."""

    lower: np.ndarray
    nugget: np.ndarray


class Cholesky:
    """Field L xi with L L^T = C + nugget I, C the correlation between the points."""

    Record = CholeskyRecord

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray) -> CholeskyRecord:
        """Factor the correlation between the points, with the smallest nugget of `NUGGETS` that allows it.

        Coincident points are allowed: their values differ by no more than about the square root of the nugget.

        Args:
            correlation: correlation of the standard-normal field.
            points: positions, shape (n, 2) [m].

        Returns:
            the factor and its nugget; it takes n variables.

        Raises:
            ValueError: the matrix is not positive definite even with the largest nugget.
        """
        try:
            lower, nugget = factor(lambda: _lower_covariance(correlation, points))
        except ValueError as error:
            raise ValueError(f"cholesky: {in_words(correlation)} on these {len(points)} points: {error}") from error
        return CholeskyRecord(lower, np.array(nugget))

    @staticmethod
    def n_variables(record: CholeskyRecord) -> int:
        """Number of points."""
        return record.lower.shape[1]

    @staticmethod
    def transform(record: CholeskyRecord, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field L xi at the points, shape (n,) [-], from `xi`, shape (n,) [-]."""
        with single_blas_thread():
            return record.lower @ xi

    @staticmethod
    def is_intact(record: CholeskyRecord, points: np.ndarray) -> bool:
        """Whether the factor has the shape, the order and the unit variances that these points ask for."""
        lower, nugget = record
        n = len(points)
        if (lower.shape, nugget.shape) != ((n, n), ()) or not lower.flags.c_contiguous:
            return False
        if lower.dtype != np.float64 or nugget.dtype != np.float64:
            return False
        variance = np.einsum("ij,ij->i", lower, lower)
        return bool(np.all(np.abs(variance - 1.0 - nugget) < n * 1e-14))

    @staticmethod
    def covariance_error(record: CholeskyRecord) -> float:
        """The nugget [-]: nothing else is added."""
        return float(record.nugget)


def factor(make_covariance: Callable[[], np.ndarray]) -> tuple[np.ndarray, float]:
    """Lower Cholesky factor of a covariance with the smallest nugget of `NUGGETS` on its diagonal that allows it.

    Args:
        make_covariance: makes the matrix, shape (n, n), of which only the lower triangle is read; it is overwritten.

    Returns:
        the factor, shape (n, n), C order, and the nugget.

    Raises:
        ValueError: the matrix is not positive definite even with the largest nugget.
    """
    import scipy.linalg  # late: commands that make no field do not pay for it

    for nugget in NUGGETS:
        covariance = make_covariance()
        covariance[np.diag_indices(len(covariance))] += nugget
        try:
            with single_blas_thread():
                # The upper triangle of the transposed view, factored in place, is the lower factor in C order.
                upper = scipy.linalg.cholesky(covariance.T, lower=False, overwrite_a=True, check_finite=False)
        except scipy.linalg.LinAlgError:
            continue
        return np.ascontiguousarray(upper.T), nugget
    raise ValueError(f"not positive definite, even with a nugget of {NUGGETS[-1]}; take another correlation or scale")


def _lower_covariance(correlation: Anisotropy, points: np.ndarray) -> np.ndarray:
    # Block rows up to the diagonal alone: the temporaries stay small and the factorisation reads nothing above it.
    n = len(points)
    covariance = np.empty((n, n))
    for start in range(0, n, ROWS_AT_ONCE):
        stop = min(start + ROWS_AT_ONCE, n)
        lag = points[start:stop, None, :] - points[None, :stop, :]
        covariance[start:stop, :stop] = correlation.rho(lag[..., 0], lag[..., 1])
    return covariance
