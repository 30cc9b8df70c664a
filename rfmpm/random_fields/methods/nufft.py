"""Field at scattered points: a Fourier series on a torus around them, summed by a non-uniform fast transform.

The series has the eigenvalues of a circulant embedding on an auxiliary lattice (see `embedding`), so its covariance is
the asked one at the lags of that lattice; between them it is the trigonometric interpolation, which rounds off the
cusp of a Markov correlation. The transform is that of Barnett, Magland and af Klinteberg (2019), SIAM J. Sci. Comput.
41(5), C479-C504.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words
from rfmpm.random_fields.lattice import Lattice
from rfmpm.random_fields.methods.embedding import ACCURACY, Spectrum, embed

LARGEST_ERROR = 0.02  # a field with more is refused
MOST_TERMS = 2**22  # of the torus: some tens of milliseconds for one field
DROPS = tuple(0.4 * 0.5**k for k in range(14))  # of the correlation over one spacing, from coarse to fine
TRANSFORM = {"eps": 1e-5, "upsampfac": 1.25, "isign": 1, "nthreads": 1}  # eps: relative error
COMPARED = 150  # points between which, beside short lags, the covariance error is taken
SHORT_LAGS = 25  # a side of the block of lags within three spacings


class NufftRecord(NamedTuple):
    """What the series needs.

    `phases`, shape (2, n) [rad]: place of every point on the torus along y and x; `turns`, shape (n,), complex [-]:
    what turns a sum over x from minus a half of the frequencies into one from zero; `amplitudes`, shape (terms along
    y, terms along x) [-], y from the lowest frequency to the highest, x from zero up; `error`, shape () [-]: largest
    covariance error over the lags between up to 150 points, and over 625 lags within three spacings of the lattice.
    """

    phases: np.ndarray
    turns: np.ndarray
    amplitudes: np.ndarray
    error: np.ndarray


class Nufft:
    """Field Re sum A (u + i v) exp(i (k_x x + k_y y)), with one pair of variables u, v for each term."""

    Record = NufftRecord

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray, most_terms: int = MOST_TERMS) -> NufftRecord:
        """Refine the auxiliary lattice until the covariance is accurate, or the series as long as it may be.

        Args:
            correlation: correlation of the standard-normal field.
            points: positions, shape (n, 2) [m].
            most_terms: frequencies on the torus, at most.

        Returns:
            the record; it takes two variables per term.

        Raises:
            ValueError: the covariance error is above 0.02 with the longest series.
        """
        best = None
        for drop in DROPS:
            lattice = _auxiliary(correlation, points, drop)
            if 2 * lattice.rows * lattice.columns > most_terms:
                break
            spectrum = embed(correlation, lattice, ACCURACY, most_terms)
            if np.prod(spectrum.shape) > most_terms:
                break
            record = _record(correlation, points, lattice, spectrum)
            best = record if best is None or record.error < best.error else best
            if best.error <= ACCURACY:
                break
        if best is None or best.error > LARGEST_ERROR:
            found = "" if best is None else f"; the best has a covariance error of {float(best.error):.2g}"
            raise ValueError(
                f"nufft: {in_words(correlation)} on these {len(points)} points needs more than {most_terms} terms"
                f"{found}: take method auto, larger scales of fluctuation, or up to 5000 points with method cholesky"
            )
        return best

    @staticmethod
    def n_variables(record: NufftRecord) -> int:
        """Two per term of the series."""
        return 2 * record.amplitudes.size

    @staticmethod
    def transform(record: NufftRecord, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-]."""
        terms = np.empty(record.amplitudes.shape, dtype=complex)
        _fill(np.ascontiguousarray(xi), record.amplitudes, terms)
        return _sum(record.phases, record.turns, terms)

    @staticmethod
    def is_intact(record: NufftRecord, points: np.ndarray) -> bool:
        """Whether shapes and unit variance fit these points."""
        phases, turns, amplitudes, error = record
        if (
            phases.shape != (2, len(points))
            or turns.shape != (len(points),)
            or amplitudes.ndim != 2
            or error.shape != ()
        ):
            return False
        if phases.dtype != np.float64 or amplitudes.dtype != np.float64 or not np.all(np.isfinite(phases)):
            return False
        return abs(float(np.sum(amplitudes**2)) - 1.0) < 1e-9 and 0.0 <= error <= LARGEST_ERROR

    @staticmethod
    def covariance_error(record: NufftRecord) -> float:
        """Largest difference from the asked covariance over the lags compared [-]."""
        return float(record.error)


def _auxiliary(correlation: Anisotropy, points: np.ndarray, drop: float) -> Lattice:
    # A lattice over the points, the correlation over one spacing of which is 1 - drop along either axis.
    low, extent = points.min(axis=0), np.ptp(points, axis=0)
    spacings = []
    for axis in range(2):
        near, far = 0.0, 1e3 * (correlation.theta_h + correlation.theta_v)
        for _ in range(60):
            middle = 0.5 * (near + far)
            lag = [np.zeros(1), np.zeros(1)]
            lag[axis] += middle
            near, far = (middle, far) if correlation.rho(*lag)[0] > 1.0 - drop else (near, middle)
        spacings.append(min(near, max(extent[axis], 1e-9 * near) / 4.0) if extent[axis] > 0.0 else near)
    columns, rows = (int(np.ceil(extent[k] / spacings[k])) + 2 for k in range(2))
    return Lattice(low[0], low[1], spacings[0], spacings[1], columns, rows, np.empty(0, dtype=np.int64))


def _record(correlation: Anisotropy, points: np.ndarray, lattice: Lattice, spectrum: Spectrum) -> NufftRecord:
    rows, columns = spectrum.shape
    twice = np.full(spectrum.eigenvalues.shape[1], 2.0)
    twice[[0, -1]] = 1.0
    squares = np.fft.fftshift(spectrum.eigenvalues * twice, axes=0)
    per_metre = 2.0 * np.pi / np.array([rows * lattice.dy, columns * lattice.dx])
    place = points[:, ::-1] - np.array([lattice.y0, lattice.x0])
    short = np.linspace(-3.0, 3.0, SHORT_LAGS)
    some = points[np.unique(np.linspace(0, len(points) - 1, COMPARED).astype(int))]
    lag_x = np.concatenate([np.subtract.outer(some[:, 0], some[:, 0]).ravel(), lattice.dx * np.tile(short, SHORT_LAGS)])
    lag_y = np.concatenate(
        [np.subtract.outer(some[:, 1], some[:, 1]).ravel(), lattice.dy * np.repeat(short, SHORT_LAGS)]
    )
    squares = squares.astype(complex)
    covariance = _sum(*_places(lag_y * per_metre[0], lag_x * per_metre[1], squares.shape[1]), squares)
    error = float(np.max(np.abs(covariance - correlation.rho(lag_x, lag_y))))
    phases, turns = _places(*(place * per_metre).T, squares.shape[1])
    return NufftRecord(phases, turns, np.sqrt(squares.real), np.array(error))


def _places(y: np.ndarray, x: np.ndarray, terms: int) -> tuple[np.ndarray, np.ndarray]:
    # Phases between minus and plus pi, and what turns back a sum whose frequencies along x begin at minus a half.
    phases = np.remainder(np.array([y, x]) + np.pi, 2.0 * np.pi) - np.pi
    return phases, np.exp(1j * (terms // 2) * phases[1])


def _sum(phases: np.ndarray, turns: np.ndarray, terms: np.ndarray) -> np.ndarray:
    # Real part of the series, shape (n,).
    import finufft  # late: commands that make no field do not pay for it

    shifted = finufft.nufft2d2(*phases, terms, **TRANSFORM)
    return shifted.real * turns.real - shifted.imag * turns.imag


@kernel
def _fill(xi, amplitudes, terms):
    rows, columns = amplitudes.shape
    for j in range(rows):
        for i in range(columns):
            k = 2 * (j * columns + i)
            terms[j, i] = complex(amplitudes[j, i] * xi[k], amplitudes[j, i] * xi[k + 1])
