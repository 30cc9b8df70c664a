"""The stages of local average subdivision: weights of parents and of new variables, and the growth of one stage."""

from itertools import product

import numpy as np

from rfmpm.kernel_tools import kernel
from rfmpm.random_fields.correlation import Anisotropy

CHILDREN = ((0, 0), (0, 1), (1, 0), (1, 1))  # row, column within the parent; the last follows from the average
LACKS = ((0, 1, 2), (1, 2), (0, 1), (1,))  # parents along an axis: all, without the lower, without the upper, alone
SMALLEST_SHARE = 1e-12  # of the largest eigenvalue of the parents' covariance: smaller ones carry no information


def stage_tables(
    correlation: Anisotropy, spacings: np.ndarray, first_shape: np.ndarray, stages: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Covariance of the first stage and the weights of the following ones.

    Args:
        correlation: correlation of the cells of the last stage.
        spacings: of the cells of the last stage along y and x [m].
        first_shape: rows and columns of the first stage.
        stages: number of subdivisions.

    Returns:
        covariance, shape (cells, cells); estimate, shape (stages, 4, 4, 3, 9); spread, shape (stages, 4, 4, 3, 3) [-],
        the first subdivision first.
    """
    lags = _AverageCovariance(correlation, spacings, np.maximum(first_shape, 3), stages)
    row, column = np.divmod(np.arange(np.prod(first_shape)), first_shape[1])
    first = lags.at(stages, np.subtract.outer(row, row), np.subtract.outer(column, column))
    estimate, spread = np.zeros((stages, 4, 4, 3, 9)), np.zeros((stages, 4, 4, 3, 3))
    for stage, up, across in product(range(stages), range(4), range(4)):
        estimate[stage, up, across], spread[stage, up, across] = _weights(lags, stages - 1 - stage, up, across)
    return first, estimate, spread


class _AverageCovariance:
    """Covariance between averages over blocks of 2^level x 2^level cells, for every level."""

    def __init__(self, correlation: Anisotropy, spacings: np.ndarray, first_shape: np.ndarray, levels: int):
        rows, columns = (first_shape + 1) * 2**levels
        lag_y, lag_x = np.arange(-rows, rows + 1), np.arange(-columns, columns + 1)
        y, x = np.meshgrid(lag_y * spacings[0], lag_x * spacings[1], indexing="ij")
        self.levels = [correlation.rho(x, y)]
        for _ in range(levels):
            self.levels.append(_halved(_halved(self.levels[-1]).T).T)

    def at(self, level: int, lag_y: np.ndarray, lag_x: np.ndarray) -> np.ndarray:
        """Covariance at lags counted in blocks of the level."""
        values = self.levels[level]
        return values[lag_y + len(values) // 2, lag_x + values.shape[1] // 2]


def _halved(values: np.ndarray) -> np.ndarray:
    # Averages of two along the first axis: (C(2k - 1) + 2 C(2k) + C(2k + 1)) / 4, lag zero in the middle.
    middle, half = len(values) // 2, (len(values) // 2 - 1) // 2
    k = middle + 2 * np.arange(-half, half + 1)
    return 0.25 * (values[k - 1] + 2.0 * values[k] + values[k + 1])


def _weights(lags: _AverageCovariance, level: int, up: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    # Best linear estimate of three children, blocks of `level`, from the parents there are, and what it leaves open.
    parents = np.array(list(product(LACKS[up], LACKS[across])))
    children = np.array(CHILDREN[:3]) + 2  # in blocks of the level; the parent is (1, 1), from 2 to 3

    def between(first, second, at_level):
        return lags.at(at_level, *(np.subtract.outer(first[:, k], second[:, k]) for k in (0, 1)))

    among = between(parents, parents, level + 1)
    halves = [2 * parents + np.array(child) for child in CHILDREN]
    shared = np.mean([between(half, children, level) for half in halves], axis=0)
    values, vectors = np.linalg.eigh(among)
    kept = values > SMALLEST_SHARE * values[-1]
    estimate = (vectors[:, kept] / values[kept]) @ (vectors[:, kept].T @ shared)
    left, turns = np.linalg.eigh(between(children, children, level) - shared.T @ estimate)
    weights = np.zeros((3, 9))
    weights[:, 3 * parents[:, 0] + parents[:, 1]] = estimate.T
    return weights, turns * np.sqrt(np.maximum(left, 0.0))


@kernel
def grow(parents, new, estimate, spread):
    """Subdivide every cell into 2 x 2 whose average it is.

    Args:
        parents: shape (rows, columns) [-].
        new: standard-normal variables, shape (rows, columns, 3) [-].
        estimate, spread: weights of this stage, shapes (4, 4, 3, 9) and (4, 4, 3, 3) [-].

    Returns:
        the children, shape (2 rows, 2 columns) [-].
    """
    rows, columns = parents.shape
    children = np.empty((2 * rows, 2 * columns))
    for j in range(rows):
        up = (j == 0) + 2 * (j == rows - 1)
        for i in range(columns):
            across = (i == 0) + 2 * (i == columns - 1)
            last = 4.0 * parents[j, i]
            for child in range(3):
                value = 0.0
                for k in range(3):
                    value += spread[up, across, child, k] * new[j, i, k]
                for b in range(max(0, 1 - j), min(3, rows - j + 1)):
                    for a in range(max(0, 1 - i), min(3, columns - i + 1)):
                        value += estimate[up, across, child, 3 * b + a] * parents[j + b - 1, i + a - 1]
                children[2 * j + child // 2, 2 * i + child % 2] = value
                last -= value
            children[2 * j + 1, 2 * i + 1] = last
    return children
