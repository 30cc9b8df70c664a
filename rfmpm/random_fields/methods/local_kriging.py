"""Field at scattered points: a circulant embedding on a lattice around them, and from there one point after another.

Each point is its kriging mean from the block of lattice nodes around it and from points that came before it nearby,
plus a variable of its own times the kriging deviation. Everything further away is screened off by these (Vecchia 1988,
J. R. Stat. Soc. B 50(2), 297-312; Stein 2002, Ann. Stat. 30(1), 298-323).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words
from rfmpm.random_fields.lattice import Lattice
from rfmpm.random_fields.methods.circulant import Circulant, CirculantRecord, on_torus
from rfmpm.random_fields.methods.embedding import ACCURACY, Spectrum, embed
from rfmpm.random_fields.methods.kriging_weights import BLOCK, EARLIER, earlier_points, kriging_weights

NODES_PER_POINT = (1.0, 3.0, 9.0, 27.0)  # lattices that are tried
TORUS_NODES = 8  # at most, per node of the lattice
LARGEST_ERROR = 0.02  # a field with more is refused
COMPARED = 100  # points whose covariance with all points is formed
AT_A_TIME = 2000  # points, to keep temporaries small


class LocalKrigingRecord(NamedTuple):
    """What the lattice and the steps from it need.

    `first`, shape (n, 2): row and column of the first node of each point's block; `lattice`: rows and columns;
    `amplitudes`, shape (torus rows, torus columns / 2 + 1) [-]: of the circulant embedding; `earlier`, shape
    (n, EARLIER): points that come before each point; `weights`, shape (n, BLOCK^2 + EARLIER) [-]: of the nodes of the
    block, row after row, and of those points, zero where there are fewer; `deviations`, shape (n,) [-]: of what each
    point adds; `error`, shape () [-]: largest covariance error between up to 100 points and all points.
    """

    first: np.ndarray
    lattice: np.ndarray
    amplitudes: np.ndarray
    earlier: np.ndarray
    weights: np.ndarray
    deviations: np.ndarray
    error: np.ndarray


class LocalKriging:
    """Field by circulant embedding on a lattice and kriging from it to each point in turn."""

    Record = LocalKrigingRecord

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray) -> LocalKrigingRecord:
        """Refine the lattice until the covariance is accurate.

        Args:
            correlation: correlation of the standard-normal field.
            points: positions, shape (n, 2) [m].

        Returns:
            the record; it takes one variable per node of the torus and one per point. Where no lattice in reach is as
            accurate as asked, the most accurate one.

        Raises:
            ValueError: the covariance error is above 0.02, or no torus is accurate enough.
        """
        turned, places = _in_own_axes(correlation, np.asarray(points, dtype=float))
        best = None
        for share in NODES_PER_POINT:
            lattice = _lattice(turned, places, share)
            torus = embed(turned, lattice, ACCURACY, TORUS_NODES * lattice.rows * lattice.columns)
            if torus.error <= LARGEST_ERROR:
                record = _record(turned, places, lattice, torus)
                best = record if best is None or record.error < best.error else best
            if torus.error > ACCURACY or best.error <= ACCURACY:
                break  # a finer lattice would not have a better torus, or need not be
        if best is None or best.error > LARGEST_ERROR:
            found = "" if best is None else f"; the best has a covariance error of {float(best.error):.2g}"
            raise ValueError(
                f"local_kriging: {in_words(correlation)} on these {len(points)} points finds no accurate "
                f"lattice{found}: take smaller scales of fluctuation, or up to 5000 points with method cholesky"
            )
        return best

    @staticmethod
    def n_variables(record: LocalKrigingRecord) -> int:
        """Number of nodes of the torus and of points."""
        return Circulant.n_variables(_torus(record)) + len(record.deviations)

    @staticmethod
    def transform(record: LocalKrigingRecord, xi: np.ndarray) -> np.ndarray:
        """Standard-normal field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-]."""
        torus, count = _torus(record), len(record.deviations)
        nodes = Circulant.transform(torus, xi[:-count]).reshape(tuple(record.lattice))
        field = np.zeros(count)
        _krige(nodes, np.ascontiguousarray(xi[-count:]), *_steps(record), field)
        return field

    @staticmethod
    def is_intact(record: LocalKrigingRecord, points: np.ndarray) -> bool:
        """Whether the shapes fit these points, and blocks and earlier points are there."""
        count = len(points)
        shapes = [
            (count, 2),
            (2,),
            record.amplitudes.shape,
            (count, EARLIER),
            (count, BLOCK**2 + EARLIER),
            (count,),
            (),
        ]
        if [array.shape for array in record] != shapes or record.amplitudes.ndim != 2:
            return False
        if any(array.dtype.kind != kind for array, kind in zip(record, "iififff", strict=True)):
            return False
        blocks = record.first.min() >= 0 and np.all(record.first.max(axis=0) + BLOCK <= record.lattice)
        before = record.earlier.min() >= 0 and np.all(record.earlier <= np.arange(count)[:, None])
        nodes = np.zeros((int(np.prod(record.lattice)), 2))
        return bool(
            blocks
            and before
            and np.all(np.isfinite(record.weights))
            and np.all((record.deviations >= 0.0) & (record.deviations <= 1.0))
            and Circulant.is_intact(_torus(record), nodes)
        )

    @staticmethod
    def covariance_error(record: LocalKrigingRecord) -> float:
        """Largest difference from the asked covariance between up to 100 points and all points [-]."""
        return float(record.error)


@dataclass(frozen=True)
class _Turned:
    # A correlation seen along its own axes; `rotation` is zero where it is then even in both lags.
    seen: Anisotropy

    separable = False

    def __getattr__(self, name: str):
        return getattr(self.seen, name)

    @property
    def rotation(self) -> float:
        lag_x, lag_y = 0.3 * self.seen.theta_h, 0.3 * self.seen.theta_v
        there, opposite = self.rho(np.array([lag_x, lag_x]), np.array([lag_y, -lag_y]))
        return 0.0 if abs(there - opposite) < 1e-12 else self.seen.rotation

    def rho(self, lag_x: np.ndarray, lag_y: np.ndarray) -> np.ndarray:
        cosine, sine = np.cos(self.seen.rotation), np.sin(self.seen.rotation)
        return self.seen.rho(cosine * lag_x - sine * lag_y, sine * lag_x + cosine * lag_y)


def _in_own_axes(correlation: Anisotropy, points: np.ndarray) -> tuple[Anisotropy, np.ndarray]:
    if correlation.rotation == 0.0:
        return correlation, points
    cosine, sine = np.cos(correlation.rotation), np.sin(correlation.rotation)
    return _Turned(correlation), points @ np.array([[cosine, -sine], [sine, cosine]])


def _lattice(correlation: Anisotropy, points: np.ndarray, share: float) -> Lattice:
    # A lattice, as dense along each axis in scales of fluctuation, around the points with room for their blocks.
    scales = np.array([correlation.theta_h, correlation.theta_v])
    low, extent = points.min(axis=0), np.ptp(points, axis=0) / scales
    longest = max(extent.max(), 1e-9)
    area = max(_hull(points / scales), longest**2 / len(points))
    step = np.sqrt(area / (share * len(points)))
    dx, dy = step * scales
    columns, rows = (int(np.ceil(length / step)) + BLOCK for length in extent)
    margin = BLOCK // 2 - 1
    return Lattice(low[0] - margin * dx, low[1] - margin * dy, dx, dy, columns, rows, np.empty(0, dtype=np.int64))


def _hull(points: np.ndarray) -> float:
    from scipy.spatial import ConvexHull, QhullError  # late: commands that make no field do not pay for it

    try:
        return ConvexHull(points).volume
    except (QhullError, ValueError):  # too few points, or all on a line
        return 0.0


def _record(correlation: Anisotropy, points: np.ndarray, lattice: Lattice, torus: Spectrum) -> LocalKrigingRecord:
    amplitudes = on_torus(np.empty(0, dtype=np.int32), lattice, torus).amplitudes
    place = (points - [lattice.x0, lattice.y0]) / [lattice.dx, lattice.dy]
    first = np.clip(np.floor(place).astype(np.int32) - (BLOCK // 2 - 1), 0, [lattice.columns, lattice.rows])
    first = np.minimum(first, np.array([lattice.columns, lattice.rows]) - BLOCK)[:, ::-1].astype(np.int32)
    earlier, is_there = earlier_points(points / [correlation.theta_h, correlation.theta_v])
    weights, deviations = np.empty((len(points), BLOCK**2 + EARLIER)), np.empty(len(points))
    corner = [lattice.x0, lattice.y0] + first[:, ::-1] * [lattice.dx, lattice.dy]
    within = np.column_stack([axis.ravel() for axis in np.meshgrid(lattice.lags_x[:BLOCK], lattice.lags_y[:BLOCK])])
    for start in range(0, len(points), AT_A_TIME):
        some = slice(start, start + AT_A_TIME)
        targets = np.concatenate([points[earlier[some]], points[some][:, None]], axis=1) - corner[some][:, None]
        weights[some], deviations[some] = kriging_weights(correlation, within, targets, is_there[some])
    shape = np.array([lattice.rows, lattice.columns])
    record = LocalKrigingRecord(first, shape, amplitudes, earlier, weights, deviations, np.array(0.0))
    return record._replace(error=np.array(_largest_error(correlation, points, record)))


def _torus(record: LocalKrigingRecord) -> CirculantRecord:
    none = np.empty(0, dtype=np.int32)
    return CirculantRecord(none, record.lattice, record.amplitudes, np.array(0.0), np.array(0.0))


def _steps(record: LocalKrigingRecord) -> tuple[np.ndarray, ...]:
    return record.first, record.earlier, record.weights, record.deviations


def _largest_error(correlation: Anisotropy, points: np.ndarray, record: LocalKrigingRecord) -> float:
    # The linear map and its transpose, applied to unit vectors, give rows of the field's covariance.
    from scipy.fft import irfft2, rfft2

    half = record.amplitudes**2
    half[:, 1:-1] *= 2.0
    torus, (rows, columns) = (half.shape[0], 2 * (half.shape[1] - 1)), record.lattice
    worst, count = 0.0, len(points)
    for number in np.unique(np.linspace(0, count - 1, COMPARED).astype(int)):
        nodes, own, unit = np.zeros((rows, columns)), np.empty(count), np.zeros(count)
        unit[number] = 1.0
        _transpose(unit, *_steps(record), nodes, own)
        spectrum = rfft2(nodes, s=torus) * half
        nodes = irfft2(spectrum, s=torus, norm="forward")[:rows, :columns]
        covariance = np.zeros(count)
        _krige(np.ascontiguousarray(nodes), own, *_steps(record), covariance)
        lag = points - points[number]
        worst = max(worst, float(np.max(np.abs(covariance - correlation.rho(lag[:, 0], lag[:, 1])))))
    return worst


@kernel
def _krige(nodes, xi, first, earlier, weights, deviations, field):
    for k in range(len(field)):
        value = deviations[k] * xi[k]
        for j in range(BLOCK):
            for i in range(BLOCK):
                value += weights[k, BLOCK * j + i] * nodes[first[k, 0] + j, first[k, 1] + i]
        for j in range(EARLIER):
            value += weights[k, BLOCK * BLOCK + j] * field[earlier[k, j]]
        field[k] = value


@kernel
def _transpose(unit, first, earlier, weights, deviations, nodes, own):
    for k in range(len(unit) - 1, -1, -1):
        value = unit[k]
        own[k] = deviations[k] * value
        for j in range(BLOCK):
            for i in range(BLOCK):
                nodes[first[k, 0] + j, first[k, 1] + i] += weights[k, BLOCK * j + i] * value
        for j in range(EARLIER):
            unit[earlier[k, j]] += weights[k, BLOCK * BLOCK + j] * value
