"""Truncated Karhunen-Loeve expansion: few variables, the most important first, and a stated error."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.lattice import find_lattice
from rfmpm.random_fields.methods.kronecker import axis_correlations, is_product

KEY = "karhunen_loeve_variance_share"
DEFAULT_SHARE = 0.95
LEAST_SHARE_OF_A_POINT = 0.5  # of its variance: with less, more modes are kept than asked
MOST_POINTS = 5000  # without a lattice and a separable correlation: the eigenvectors of a dense matrix
MOST_MODES = 20_000
COMPARED = 1500  # points between which the covariance error is taken


class KarhunenLoeveRecord(NamedTuple):
    """The modes kept, by falling eigenvalue.

    Mode m at (row, column) is modes_y[row, pairs[m, 0]] modes_x[column, pairs[m, 1]] amplitudes[m] scale[row, column];
    for points without a lattice there is one row, and a column per point. `index`, shape (n,): node number of every
    point; `modes_y`, shape (rows, -), `modes_x`, shape (columns, -), `amplitudes`, shape (modes,), `scale`, shape
    (rows, columns) [-]; `lost`, shape () [-]: share of the variance that the modes left out had; `error`, shape () [-]:
    largest covariance error over the pairs of up to 1500 points.
    """

    index: np.ndarray
    modes_y: np.ndarray
    modes_x: np.ndarray
    pairs: np.ndarray
    amplitudes: np.ndarray
    scale: np.ndarray
    lost: np.ndarray
    error: np.ndarray


class KarhunenLoeve:
    """Field of the eigenvectors of the covariance between the points, or between the nodes of their lattice.

    The field is scaled back to unit variance point by point: the strength then has the asked mean and coefficient of
    variation everywhere, and what the truncation costs is left in the correlation alone, which comes out too high.
    Ghanem and Spanos (1991), Stochastic Finite Elements: A Spectral Approach, section 2.3.
    """

    Record = KarhunenLoeveRecord

    @staticmethod
    def prepare(
        correlation: Anisotropy, points: np.ndarray, karhunen_loeve_variance_share: float = DEFAULT_SHARE
    ) -> KarhunenLoeveRecord:
        """Find the fewest modes that hold a share of the variance, and at least half of it at every point.

        Args:
            correlation: correlation of the standard-normal field.
            points: positions, shape (n, 2) [m].
            karhunen_loeve_variance_share: mean share of the variance that the modes hold before scaling, above 0, at
                most 1 [-].

        Returns:
            the record; it takes one variable per mode.

        Raises:
            ValueError: the share is out of range, or there are too many points or modes.
        """
        share = karhunen_loeve_variance_share
        if not 0.0 < share <= 1.0:
            raise ValueError(f"{KEY} = {share:g}: must be above 0 and at most 1")
        lattice = find_lattice(points) if is_product(correlation) else None
        if lattice is not None:
            (values_y, modes_y), (values_x, modes_x) = (
                _eigenpairs(matrix) for matrix in axis_correlations(correlation, lattice)
            )
            index = lattice.index.astype(np.int64)
        elif len(points) <= MOST_POINTS:
            lag = points[:, None, :] - points[None, :, :]
            values_x, modes_x = _eigenpairs(correlation.rho(lag[..., 0], lag[..., 1]))
            values_y, modes_y, index = np.ones(1), np.ones((1, 1)), np.arange(len(points))
        else:
            raise ValueError(
                f"karhunen_loeve: {len(points)} points, at most {MOST_POINTS} unless they are on a lattice and the "
                "correlation is separable along x and y; take method auto"
            )
        variance = np.zeros(1)
        while variance.min() < LEAST_SHARE_OF_A_POINT:
            pairs, kept, lost = _largest(values_y, values_x, share)
            used_y, used_x = pairs.max(axis=0) + 1
            variance = modes_y[:, :used_y] ** 2 @ _core(pairs, kept, used_y, used_x) @ (modes_x[:, :used_x] ** 2).T
            share = 0.5 * (1.0 + share)
        modes_y, modes_x = np.ascontiguousarray(modes_y[:, :used_y]), np.ascontiguousarray(modes_x[:, :used_x])
        record = KarhunenLoeveRecord(
            index, modes_y, modes_x, pairs, np.sqrt(kept), 1.0 / np.sqrt(variance), np.array(lost), np.array(0.0)
        )
        return record._replace(error=np.array(_largest_error(correlation, points, record)))

    @staticmethod
    def n_variables(record: KarhunenLoeveRecord) -> int:
        """Number of modes."""
        return len(record.amplitudes)

    @staticmethod
    def transform(record: KarhunenLoeveRecord, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-]."""
        core = _core(record.pairs, record.amplitudes * xi, record.modes_y.shape[1], record.modes_x.shape[1])
        with single_blas_thread():
            field = record.modes_y @ core @ record.modes_x.T
        return (field * record.scale).ravel()[record.index]

    @staticmethod
    def is_intact(record: KarhunenLoeveRecord, points: np.ndarray) -> bool:
        """Whether the arrays fit each other and these points."""
        rows, columns, modes = len(record.modes_y), len(record.modes_x), len(record.amplitudes)
        shapes = record.index.shape, record.pairs.shape, record.scale.shape, record.lost.shape, record.error.shape
        if shapes != ((len(points),), (modes, 2), (rows, columns), (), ()) or record.index.dtype.kind != "i":
            return False
        if not np.all((record.index >= 0) & (record.index < rows * columns)) or modes == 0:
            return False
        variance = record.scale**2 * (
            record.modes_y**2
            @ _core(record.pairs, record.amplitudes**2, record.modes_y.shape[1], record.modes_x.shape[1])
            @ (record.modes_x**2).T
        )
        return bool(np.all(np.abs(variance - 1.0) < 1e-9))

    @staticmethod
    def covariance_error(record: KarhunenLoeveRecord) -> float:
        """Largest difference from the asked covariance between the points compared [-]."""
        return float(record.error)


def _eigenpairs(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    # By falling eigenvalue; the sign of each vector such that its largest part is positive.
    import scipy.linalg  # late: commands that make no field do not pay for it

    with single_blas_thread():
        values, vectors = scipy.linalg.eigh(matrix, check_finite=False)
    values, vectors = np.maximum(values[::-1], 0.0), vectors[:, ::-1]
    largest = np.argmax(np.abs(vectors), axis=0)
    return values, vectors * np.sign(vectors[largest, np.arange(len(values))])


def _largest(values_y: np.ndarray, values_x: np.ndarray, share: float) -> tuple[np.ndarray, np.ndarray, float]:
    # Pairs of modes, shape (modes, 2), their eigenvalues, and the share of the variance left out.
    values = np.multiply.outer(values_y, values_x).ravel()
    order = np.argsort(-values, kind="stable")
    held = np.cumsum(values[order]) / values.sum()
    count = min(int(np.searchsorted(held, share * (1.0 - 1e-12))) + 1, int(np.count_nonzero(values)))
    if count > MOST_MODES:
        raise ValueError(
            f"karhunen_loeve: {count} modes hold {share:g} of the variance, at most {MOST_MODES}; take method auto, or "
            f"a smaller {KEY}"
        )
    pairs = np.column_stack(np.divmod(order[:count], len(values_x)))
    return pairs, values[order[:count]], max(0.0, float(1.0 - held[count - 1]))


def _core(pairs: np.ndarray, values: np.ndarray, rows: int, columns: int) -> np.ndarray:
    core = np.zeros((rows, columns))
    core[pairs[:, 0], pairs[:, 1]] = values
    return core


def _largest_error(correlation: Anisotropy, points: np.ndarray, record: KarhunenLoeveRecord) -> float:
    some = np.unique(np.linspace(0, len(points) - 1, COMPARED).astype(int))
    row, column = np.divmod(record.index[some], len(record.modes_x))
    modes = record.modes_y[row][:, record.pairs[:, 0]] * record.modes_x[column][:, record.pairs[:, 1]]
    modes *= record.amplitudes * record.scale[row, column][:, None]
    lag = points[some, None, :] - points[None, some, :]
    with single_blas_thread():
        return float(np.max(np.abs(modes @ modes.T - correlation.rho(lag[..., 0], lag[..., 1]))))
