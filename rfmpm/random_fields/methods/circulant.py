"""Field on a lattice by the fast Fourier transform of a torus around it: any stationary correlation, turned or not."""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words
from rfmpm.random_fields.lattice import Lattice, require_lattice
from rfmpm.random_fields.methods.embedding import ACCURACY, Spectrum, embed
from rfmpm.random_fields.methods.nodes import is_index_of, node_numbers, pick

LARGEST_ERROR = 0.02  # a field with more is refused


class CirculantRecord(NamedTuple):
    """What a transform on the torus needs.

    `index`, shape (n,): node number of every point, or empty where the points are all nodes in order; `shape`: rows,
    columns of the lattice; `amplitudes`, shape (torus rows, torus columns / 2 + 1) [-]: of the frequencies; `clipped`,
    shape () [-]: share of negative eigenvalues, set to zero; `error`, shape () [-]: the largest difference between the
    covariance of the field and the asked one over all lags of the lattice.
    """

    index: np.ndarray
    shape: np.ndarray
    amplitudes: np.ndarray
    clipped: np.ndarray
    error: np.ndarray


class Circulant:
    """Field by circulant embedding (Dietrich and Newsam 1997; Wood and Chan 1994), one real field per `xi`."""

    Record = CirculantRecord

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray, accuracy: float = ACCURACY) -> CirculantRecord:
        """Find the lattice of the points and the smallest torus that is accurate enough.

        Args:
            correlation: correlation of the standard-normal field.
            points: positions on a lattice, shape (n, 2) [m].
            accuracy: largest covariance error that needs no larger torus [-]; 1e-10 for an exact field.

        Returns:
            the record; it takes one variable per node of the torus. Where no torus in reach is as accurate as asked,
            the most accurate one, its error in the record.

        Raises:
            ValueError: the points are scattered, or the covariance error of the best torus is above 0.02.
        """
        lattice = require_lattice(points, "circulant")
        spectrum = embed(correlation, lattice, accuracy)
        if spectrum.error > LARGEST_ERROR:
            raise ValueError(
                f"circulant: {in_words(correlation)} on a lattice of {lattice.columns} x {lattice.rows} nodes needs a "
                f"torus that is too large; the best has a covariance error of {spectrum.error:.2g}: take method "
                "cholesky, or smaller scales of fluctuation"
            )
        return on_torus(node_numbers(lattice), lattice, spectrum)

    @staticmethod
    def n_variables(record: CirculantRecord) -> int:
        """Number of nodes of the torus."""
        rows, columns = record.amplitudes.shape
        return rows * 2 * (columns - 1)

    @staticmethod
    def transform(record: CirculantRecord, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-].

        Taken row after row and two by two, `xi` holds the real and imaginary parts of the frequencies; the first pair
        of a row serves the two frequencies along x, zero and the highest, whose parts are those of a real transform.
        """
        from scipy.fft import ifft, irfft  # late: commands that make no field do not pay for it

        torus, (rows, columns) = record.amplitudes.shape, record.shape
        half = np.empty(torus, dtype=complex)
        _fill(np.ascontiguousarray(xi).reshape(torus[0], -1), record.amplitudes, half)
        along_y = ifft(half, axis=0, overwrite_x=True, norm="forward")[:rows]
        field = irfft(along_y, n=2 * (torus[1] - 1), axis=1, norm="forward")
        return pick(field[:, :columns], record.index)

    @staticmethod
    def is_intact(record: CirculantRecord, points: np.ndarray) -> bool:
        """Whether node numbers, shapes and unit variance fit these points."""
        index, shape, amplitudes, clipped, error = record
        if amplitudes.ndim != 2 or amplitudes.dtype != np.float64 or (clipped.shape, error.shape) != ((), ()):
            return False
        if not (0.0 <= clipped < 1.0 and 0.0 <= error <= LARGEST_ERROR):
            return False
        variance = float(np.sum(amplitudes[:, [0, -1]] ** 2) + 4.0 * np.sum(amplitudes[:, 1:-1] ** 2))
        return is_index_of(index, shape, points) and abs(variance - 1.0) < 1e-9

    @staticmethod
    def covariance_error(record: CirculantRecord) -> float:
        """Largest difference from the asked covariance over all lags of the lattice [-]."""
        return float(record.error)


def on_torus(index: np.ndarray, lattice: Lattice, spectrum: Spectrum) -> CirculantRecord:
    """The record of an embedding for the nodes `index` of the lattice, all of them where it is empty."""
    amplitudes = np.sqrt(spectrum.eigenvalues)
    amplitudes[:, 1:-1] *= np.sqrt(0.5)
    shape = np.array([lattice.rows, lattice.columns])
    return CirculantRecord(index, shape, amplitudes, np.array(spectrum.clipped), np.array(spectrum.error))


@kernel
def _fill(xi, amplitudes, half):
    rows, columns = half.shape
    for j in range(rows):
        for i in range(1, columns - 1):
            a = amplitudes[j, i]
            half[j, i] = complex(a * xi[j, 2 * i], a * xi[j, 2 * i + 1])
    middle = rows // 2
    for part in range(2):
        i = part * (columns - 1)
        for j in range(rows):
            if j == 0 or j == middle:
                half[j, i] = complex(amplitudes[j, i] * xi[j, part], 0.0)
            else:
                real, imaginary = (j, rows - j) if j < middle else (rows - j, j)
                a, sign = np.sqrt(0.5) * amplitudes[j, i], 1.0 if j < middle else -1.0
                half[j, i] = complex(a * xi[real, part], sign * a * xi[imaginary, part])
