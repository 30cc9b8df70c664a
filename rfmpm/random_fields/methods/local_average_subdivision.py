"""Local average subdivision: cells are halved stage by stage, each time with the average of the parent preserved.

Fenton and Vanmarcke (1990), J. Eng. Mech. 116(8), 1733-1749. The averages here are those of the lattice's own nodes,
so that the last stage aims at the asked correlation itself. The method is kept for comparison: it leaves a pattern in
the variance and bands along the borders of the parents, and it cannot by itself make an anisotropic field.
"""

from math import ceil
from typing import NamedTuple

import numpy as np

from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.correlation.protocol import in_words
from rfmpm.random_fields.lattice import Lattice, require_lattice
from rfmpm.random_fields.methods.cholesky import factor
from rfmpm.random_fields.methods.nodes import is_index_of
from rfmpm.random_fields.methods.subdivision import grow, stage_tables

MOST_FIRST_CELLS = 256  # of the first stage, which is made by Cholesky
WIDEST_WINDOW = 16  # cells that the window can shift along each axis, as far as a parent of the first stage is wide
MOST_CELLS = 2**24
COMPARED_CELLS = 3000  # of the part for which the covariance error is computed from the linear map
COMPARED_POINTS, COMPARED_WINDOWS = 24, 64


class LasRecord(NamedTuple):
    """What the stages need.

    `index`, shape (n,): node number of every point; `shape`: rows, columns of the lattice; `stretch`: cells per node
    along y and x; `windows`: places of the window along y and x; `first`, shape (cells, cells) [-]: lower factor of the
    first stage; `first_shape`: its rows, columns; `estimate`, shape (stages, 4, 4, 3, 9), and `spread`, shape (stages,
    4, 4, 3, 3) [-]: weights of the 3 x 3 parents and of new variables for three of four children, by whether a parent
    lacks its lower, its upper or both neighbours along y, and along x; `variance_range`, shape (2,), and `error`,
    shape () [-]: extremes of the variance with the window fixed, and the largest covariance error with it free.
    """

    index: np.ndarray
    shape: np.ndarray
    stretch: np.ndarray
    windows: np.ndarray
    first: np.ndarray
    first_shape: np.ndarray
    estimate: np.ndarray
    spread: np.ndarray
    variance_range: np.ndarray
    error: np.ndarray


class LocalAverageSubdivision:
    """Field by 2 x 2 subdivision from 3 x 3 parents, stretched to isotropy, seen through a random window."""

    Record = LasRecord

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray, is_stretched: bool = True) -> LasRecord:
        """Find the lattice of the points and the weights of every stage.

        Args:
            correlation: correlation of the standard-normal field.
            points: positions on a lattice, shape (n, 2) [m].
            is_stretched: take more cells than nodes along the axis on which the correlation falls faster, such that it
                falls equally fast in cells; without it, an anisotropic field has a covariance error of some tenths.

        Returns:
            the record; it takes one variable per cell, and two for the place of the window.

        Raises:
            ValueError: the points are scattered, there are too many cells, or the correlation is not positive definite.
        """
        lattice = require_lattice(points, "local_average_subdivision")
        stretch = _stretch(correlation, lattice) if is_stretched else np.ones(2, dtype=np.int64)
        record = _record(correlation, lattice, stretch)
        if LocalAverageSubdivision.n_variables(record) > MOST_CELLS:
            raise ValueError(
                f"local_average_subdivision: {LocalAverageSubdivision.n_variables(record):,} cells of equal scales, at "
                f"most {MOST_CELLS:,}; take method auto, or scales of fluctuation that differ less"
            )
        part = _record(correlation, _part(lattice, stretch), stretch)
        least, most, error = _compare(correlation, part, lattice.dx, lattice.dy)
        return record._replace(variance_range=np.array([least, most]), error=np.array(error))

    @staticmethod
    def n_variables(record: LasRecord) -> int:
        """Number of cells of the last stage, and two."""
        return int(np.prod(record.first_shape)) * 4 ** len(record.estimate) + 2

    @staticmethod
    def transform(record: LasRecord, xi: np.ndarray) -> np.ndarray:
        """Field at the points, shape (n,) [-], from `xi`, shape (n_variables,) [-]: stage by stage, then the window.

        Linear in all but the last two variables.
        """
        cells = _cells(record, xi)
        first = [min(int(u * count), count - 1) for u, count in zip(_uniform(xi[-2:]), record.windows, strict=True)]
        return _through(record, cells, *first)

    @staticmethod
    def is_intact(record: LasRecord, points: np.ndarray) -> bool:
        """Whether the arrays fit each other and these points."""
        stages, count = len(record.estimate), int(np.prod(record.first_shape))
        shapes = record.first.shape, record.estimate.shape, record.spread.shape, record.variance_range.shape
        if shapes != ((count, count), (stages, 4, 4, 3, 9), (stages, 4, 4, 3, 3), (2,)) or record.error.shape != ():
            return False
        if (record.stretch.shape, record.windows.shape) != ((2,), (2,)) or not np.all(np.isfinite(record.estimate)):
            return False
        need = (record.shape - 1) * record.stretch + record.windows
        if not len(record.index) or np.any(need > record.first_shape * 2**stages):
            return False
        return is_index_of(record.index, record.shape, points) and bool(np.all(np.isfinite(record.spread)))

    @staticmethod
    def covariance_error(record: LasRecord) -> float:
        """Largest difference from the asked covariance in the part compared, the window free [-]."""
        return float(record.error)


def _stretch(correlation: Anisotropy, lattice: Lattice) -> np.ndarray:
    # Whole numbers of cells per node along y and x that make the lags of equal correlation as equal as they can be.
    reach_y, reach_x = (
        np.sum(correlation.rho(*lags))
        for lags in ((np.zeros(4096), _lags(lattice.dy)), (_lags(lattice.dx), np.zeros(4096)))
    )
    ratio = float((reach_x - 0.5) / (reach_y - 0.5))
    most = max(1.0, MOST_CELLS / (4.0 * lattice.rows * lattice.columns))
    up, across = min(ratio, most), min(1.0 / ratio, most)
    return np.array([max(1, round(up)), max(1, round(across))])


def _lags(spacing: float) -> np.ndarray:
    return spacing * np.arange(4096)


def _record(correlation: Anisotropy, lattice: Lattice, stretch: np.ndarray) -> LasRecord:
    counts = np.array([lattice.rows, lattice.columns])
    cells = (counts - 1) * stretch + 1
    stages = 0
    while np.prod(-(-cells // 2**stages)) > MOST_FIRST_CELLS:
        stages += 1
    room = np.where(counts > 1, min(2**stages, WIDEST_WINDOW) - 1, 0)
    first_shape = np.array([ceil(count / 2**stages) for count in cells + room])
    windows = np.minimum(first_shape * 2**stages - cells + 1, WIDEST_WINDOW)
    spacings = np.array([lattice.dy, lattice.dx]) / stretch
    first_covariance, estimate, spread = stage_tables(correlation, spacings, first_shape, stages)
    try:
        lower, _ = factor(first_covariance.copy)
    except ValueError as error:
        raise ValueError(f"local_average_subdivision: {in_words(correlation)}, first stage: {error}") from error
    nothing = np.zeros(2), np.array(0.0)
    return LasRecord(lattice.index, counts, stretch, windows, lower, first_shape, estimate, spread, *nothing)


def _part(lattice: Lattice, stretch: np.ndarray) -> Lattice:
    # As much of the lattice, in its proportions in cells, as the linear map is computed for.
    rows, columns = lattice.rows, lattice.columns
    while rows * columns * np.prod(stretch) > COMPARED_CELLS and max(rows, columns) > 2:
        if rows * stretch[0] >= columns * stretch[1] and rows > 2:
            rows -= max(1, rows // 10)
        elif columns > 2:
            columns -= max(1, columns // 10)
        else:
            break
    return Lattice(lattice.x0, lattice.y0, lattice.dx, lattice.dy, columns, rows, np.arange(rows * columns))


def _cells(record: LasRecord, xi: np.ndarray) -> np.ndarray:
    # All cells of the last stage, shape (rows, columns).
    used = int(np.prod(record.first_shape))
    field = (record.first @ xi[:used]).reshape(tuple(record.first_shape))
    for estimate, spread in zip(record.estimate, record.spread, strict=True):
        new = xi[used : used + 3 * field.size].reshape(*field.shape, 3)
        used += 3 * field.size
        field = grow(field, np.ascontiguousarray(new), estimate, spread)
    return field


def _through(record: LasRecord, cells: np.ndarray, row: int, column: int) -> np.ndarray:
    # Values at the points when the window begins at this row and column of cells.
    seen = cells[row :: record.stretch[0], column :: record.stretch[1]][: record.shape[0], : record.shape[1]]
    return np.take(seen.ravel(), record.index)


def _uniform(z: np.ndarray) -> np.ndarray:
    from scipy.special import ndtr

    return ndtr(z)


def _compare(correlation: Anisotropy, record: LasRecord, dx: float, dy: float) -> tuple[float, float, float]:
    # Extremes of the variance of a cell, and the largest covariance error with the window free, from the linear map.
    count = LocalAverageSubdivision.n_variables(record) - 2
    padded, factor_rows = np.zeros(count + 2), []
    for k in range(count):
        padded[k] = 1.0
        factor_rows.append(_cells(record, padded))
        padded[k] = 0.0
    maps = np.array(factor_rows)  # (variables, rows, columns)
    nodes = len(record.index)
    some = np.unique(np.linspace(0, nodes - 1, COMPARED_POINTS).astype(int))
    places = np.unravel_index(
        np.unique(np.linspace(0, np.prod(record.windows) - 1, COMPARED_WINDOWS).astype(int)), tuple(record.windows)
    )
    covariance, variances = np.zeros((len(some), nodes)), []
    for row, column in zip(*places, strict=True):
        seen = maps[:, row :: record.stretch[0], column :: record.stretch[1]]
        seen = seen[:, : record.shape[0], : record.shape[1]].reshape(count, nodes)
        covariance += seen[:, some].T @ seen / len(places[0])
        variances.append(np.einsum("ij,ij->j", seen, seen))
    y, x = np.divmod(np.arange(nodes), record.shape[1])
    asked = correlation.rho(dx * np.subtract.outer(x[some], x), dy * np.subtract.outer(y[some], y))
    error = max(np.max(np.abs(covariance - asked)), np.max(np.abs(np.mean(variances, axis=0) - 1.0)))
    return float(np.min(variances)), float(np.max(variances)), float(error)
