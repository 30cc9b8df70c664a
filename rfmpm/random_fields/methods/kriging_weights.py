"""Kriging weights of scattered points, from the lattice nodes around each and from points that come before it.

The block of nodes comes first: what it leaves of the covariance of the points is what the earlier points share in, so
that only a small system is solved for each point.
"""

import numpy as np

from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.methods.cholesky import factor

BLOCK = 6  # lattice nodes a side
EARLIER = 16  # points before a point, at most; of the nearest SEARCHED
SEARCHED = 64
NUGGET = 1e-11  # on the variances of earlier points, some of which may coincide


def earlier_points(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the nearest of the points that come before each point.

    Args:
        places: positions over the scales of fluctuation, shape (n, 2) [-].

    Returns:
        their numbers, shape (n, EARLIER), and whether there is one, same shape.
    """
    from scipy.spatial import cKDTree  # late: commands that make no field do not pay for it

    count = len(places)
    _, near = cKDTree(places).query(places, k=min(SEARCHED, count))
    near = near.reshape(count, -1)
    is_before = near < np.arange(count)[:, None]
    rank = np.cumsum(is_before, axis=1) - 1
    row, column = np.nonzero(is_before & (rank < EARLIER))
    earlier, is_there = np.zeros((count, EARLIER), dtype=np.int32), np.zeros((count, EARLIER), dtype=bool)
    earlier[row, rank[row, column]] = near[row, column]
    is_there[row, rank[row, column]] = True
    return earlier, is_there


def kriging_weights(
    correlation: Anisotropy, block: np.ndarray, targets: np.ndarray, is_there: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Kriging weights and deviation of each point, from the nodes of its block and the points before it.

    Args:
        correlation: of the field.
        block: nodes from the first one of a block, shape (BLOCK^2, 2) [m].
        targets: the earlier points and, last, the point itself, from there, shape (m, EARLIER + 1, 2) [m].
        is_there: whether there is such an earlier point, shape (m, EARLIER).

    Returns:
        weights, shape (m, BLOCK^2 + EARLIER) [-], and deviations, shape (m,) [-].
    """
    lag = block[:, None] - block
    lower, _ = factor(lambda: correlation.rho(lag[..., 0], lag[..., 1]))
    to_parts = np.linalg.inv(lower)  # from values at the nodes of a block to independent ones
    lag_x, lag_y = np.moveaxis(targets[:, :, None] - block, -1, 0)
    shares = correlation.rho(lag_x, lag_y) @ to_parts.T
    lag_x, lag_y = np.moveaxis(targets[:, :, None] - targets[:, None], -1, 0)
    left = correlation.rho(lag_x, lag_y) - shares @ shares.transpose(0, 2, 1)
    is_known = np.concatenate([is_there, np.ones((len(targets), 1), dtype=bool)], axis=1)
    left *= is_known[:, :, None] & is_known[:, None]
    among, with_point = left[:, :-1, :-1], left[:, :-1, -1]
    diagonal = np.arange(EARLIER)
    among[:, diagonal, diagonal] = np.where(is_there, among[:, diagonal, diagonal] + NUGGET, 1.0)
    of_points = np.linalg.solve(among, with_point[..., None])[..., 0]
    of_nodes = (shares[:, -1] - np.einsum("mk,mkb->mb", of_points, shares[:, :-1])) @ to_parts
    variance = left[:, -1, -1] - np.einsum("mk,mk->m", of_points, with_point)
    return np.concatenate([of_nodes, of_points], axis=1), np.sqrt(np.clip(variance, 0.0, 1.0))
