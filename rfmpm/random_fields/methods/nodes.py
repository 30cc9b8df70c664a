"""What every method on a lattice shares: from nodes to points, and whether a correlation lies along the lattice."""

import numpy as np

from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.lattice import Lattice


def node_numbers(lattice: Lattice) -> np.ndarray:
    """Node number of every point, shape (n,), or an empty array where the points are all nodes in order."""
    count = lattice.columns * lattice.rows
    if len(lattice.index) == count and np.array_equal(lattice.index, np.arange(count)):
        return np.empty(0, dtype=np.int32)
    return lattice.index.astype(np.int32 if count < 2**31 else np.int64)


def pick(field: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Values at the points, shape (n,), of a field on the nodes, shape (rows, columns), C order."""
    return np.take(field.ravel(), index) if len(index) else field.ravel()


def is_index_of(index: np.ndarray, shape: np.ndarray, points: np.ndarray) -> bool:
    """Whether node numbers on a lattice of `shape` (rows, columns) can be those of these points."""
    if index.ndim != 1 or index.dtype.kind != "i" or shape.shape != (2,) or shape.dtype.kind != "i" or shape.min() < 1:
        return False
    count = int(np.prod(shape))
    if len(index) == 0:
        return count == len(points)
    return len(index) == len(points) and int(index.min()) >= 0 and int(index.max()) < count


def is_aligned(correlation: Anisotropy) -> bool:
    """Whether the axes of the correlation are those of the lattice: turned by no or by a whole number of right angles.

    A right angle in radians is itself rounded; what that turns is less than a rounding of the lags.
    """
    turns = correlation.rotation / (0.5 * np.pi)
    return abs(turns - round(turns)) < 1e-15 * max(1.0, abs(turns))
