"""Fields conditioned on data, on top of any method: unconditional field plus kriged residual (Matheron's update).

    z | data = z + W (data - z_d - e),    W = C_pd (C_dd + E)^-1,

with z at the points from the method, z_d the same realisation at the places of the data, C the correlation, E the
variances of the errors of measurement and e an error drawn from them. Mean and covariance are then the conditional ones
exactly (Journel and Huijbregts 1978, Mining Geostatistics, VII.A.1), if z_d has its right covariance with z.

A datum on a point takes the value of the point. Elsewhere z_d is drawn given the values at nearby points: kriged from
them, plus a residual with the covariance that is left, correlated between the data. Neighbours are added until the
largest error of the conditional covariance is below `COVARIANCE_ERROR_SOUGHT`, or there are `MOST_NEIGHBOURS` of them;
the error left is in the record. Up to `MOST_NEIGHBOURS` points all of them are neighbours if need be: then it is exact.
"""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.measurements import SAME_PLACE, StandardNormalData

COVARIANCE_ERROR_SOUGHT = 1e-4  # a fifth of what the methods that are not exact are allowed
MOST_NEIGHBOURS = 5000
MOST_CHECKED = 1500  # points between which the error of the conditional covariance is evaluated
LARGEST_MISFIT = 8.0  # root mean square of the data in units of what the field allows
NUGGETS = (0.0, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10)  # of the diagonal, in this order, until a factor exists
VALUES_AT_ONCE = 1_000_000


@dataclass(frozen=True)
class Conditioning:
    """What turns realisations at n points into conditional ones, for d data.

    Attributes:
        data: the data in standard-normal space.
        weights: W, shape (n, d) [-].
        neighbours: indices of the u points from which the field at the data is drawn, shape (u,).
        from_neighbours: weights of the neighbours, shape (d, u) [-].
        residual: factor of the covariance of what the neighbours leave open and of the errors, shape (d, r) [-].
        on_points: index of the point that a datum is on, shape (d,); -1 for none.
        mean: conditional mean, shape (n,) [-].
        deviation: conditional standard deviation, shape (n,) [-].
        covariance_error: largest error of the conditional covariance between points, beyond that of the method [-].
    """

    data: StandardNormalData
    weights: np.ndarray
    neighbours: np.ndarray
    from_neighbours: np.ndarray
    residual: np.ndarray
    on_points: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray
    covariance_error: float

    @property
    def n_variables(self) -> int:
        """Standard-normal variables it takes: one for each datum that has an error or is not on a point."""
        return self.residual.shape[1]


def condition(correlation: Anisotropy, points: np.ndarray, data: StandardNormalData) -> Conditioning:
    """Prepare the conditioning of a field.

    Args:
        correlation: of the standard-normal field.
        points: positions, shape (n, 2) [m].
        data: at least one; inside or outside the domain, coincident ones only if they have errors.

    Returns:
        the conditioning; it holds n x d numbers.

    Raises:
        ValueError: the data are not compatible with the correlation: it would have to be stretched to reach them.
    """
    nearest, on_point = _points_of_data(points, data.places)
    data = data._replace(places=np.where(on_point[:, None], points[nearest], data.places))
    among = _covariance(correlation, data.places, data.places)
    solve = _solver(among + np.diag(data.error_variances))
    _check_misfit(float(np.sqrt(data.values @ solve(data.values) / len(data.values))))
    weights, deviation = _weights(correlation, points, data, solve)
    exact = on_point & (data.error_variances == 0.0)
    weights[nearest[exact]] = np.eye(len(exact))[exact]
    deviation[nearest[exact]] = 0.0
    neighbours, from_neighbours, error = _neighbours(correlation, points, data.places, weights, nearest, on_point)
    left = among - from_neighbours @ _covariance(correlation, points[neighbours], data.places)
    residual = _residual_factor(0.5 * (left + left.T) + np.diag(data.error_variances), ~exact)
    on_points = np.where(on_point, nearest, -1)
    mean = weights @ data.values
    return Conditioning(data, weights, neighbours, from_neighbours, residual, on_points, mean, deviation, error)


def update(conditioning: Conditioning, z: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Condition a realisation.

    Args:
        conditioning: the conditioning.
        z: the unconditional field at the points, shape (n,) [-].
        xi: standard-normal vector, shape (n_variables,) [-].

    Returns:
        the conditional field, shape (n,) [-].
    """
    with single_blas_thread():
        return z + conditioning.weights @ (conditioning.data.values - _measured(conditioning, z, xi))


def _measured(conditioning: Conditioning, z: np.ndarray, xi: np.ndarray) -> np.ndarray:
    # What the measurements would have given in the unconditional field, errors included.
    return conditioning.from_neighbours @ z[conditioning.neighbours] + conditioning.residual @ xi


def conditional_covariance(
    correlation: Anisotropy, conditioning: Conditioning, points: np.ndarray, first: np.ndarray, second: np.ndarray
) -> np.ndarray:
    """Conditional covariance between points `first` and `second`, indices of shape (k,); shape (k,) [-]."""
    lag = points[first] - points[second]
    known = _covariance(correlation, points[second], conditioning.data.places)
    return correlation.rho(lag[:, 0], lag[:, 1]) - np.einsum("kd,kd->k", conditioning.weights[first], known)


def _covariance(correlation: Anisotropy, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    lag = first[:, None, :] - second[None, :, :]
    return correlation.rho(lag[..., 0], lag[..., 1])


def _solver(matrix: np.ndarray):
    from scipy.linalg import LinAlgError, cho_factor, cho_solve  # late: commands that make no field do not pay for it

    for nugget in NUGGETS:
        try:
            with single_blas_thread():
                factor = cho_factor(matrix + nugget * np.eye(len(matrix)), lower=True, check_finite=False)
        except LinAlgError:
            continue
        return lambda right: cho_solve(factor, right, check_finite=False)
    raise ValueError(
        f"data: the correlation is not positive definite on {len(matrix)} places of data and points around; "
        "give the data a measurement_error, or take fewer of them, or a rougher correlation"
    )


def _check_misfit(misfit: float) -> None:
    if misfit > LARGEST_MISFIT:
        raise ValueError(
            f"data: they are on average {misfit:.3g} standard deviations from what mean, variation and correlation "
            f"allow, at most {LARGEST_MISFIT:g}: exact values that differ much over a small distance need a "
            "measurement_error, a shorter scale of fluctuation or a nugget"
        )


def _points_of_data(points: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    # The nearest point of each datum, and whether the datum is on it.
    from scipy.spatial import cKDTree

    distance, nearest = cKDTree(points).query(places)
    return nearest, distance <= 0.5 * SAME_PLACE


def _weights(correlation, points: np.ndarray, data: StandardNormalData, solve) -> tuple[np.ndarray, np.ndarray]:
    weights = np.empty((len(points), len(data.places)))
    variance = np.empty(len(points))
    rows = max(VALUES_AT_ONCE // len(data.places), 1)
    for start in range(0, len(points), rows):
        known = _covariance(correlation, points[start : start + rows], data.places)
        part = weights[start : start + rows]
        part[:] = solve(known.T).T
        variance[start : start + rows] = -np.einsum("pd,pd->p", part, known)
    prior = float(correlation.rho(np.zeros(1), np.zeros(1))[0])
    return weights, np.sqrt(np.maximum(prior + variance, 0.0))


def _neighbours(correlation, points, places, weights, nearest, on_point) -> tuple[np.ndarray, np.ndarray, float]:
    """Neighbours of the data, their weights, and the error of the conditional covariance that is left."""
    if np.all(on_point):
        neighbours, column = np.unique(nearest, return_inverse=True)
        return neighbours, np.eye(len(neighbours))[column], 0.0
    order = np.argsort(-np.abs(weights).max(axis=1), kind="stable")
    checked = np.union1d(order[: MOST_CHECKED // 2], order[:: 2 * len(points) // MOST_CHECKED + 1])
    for count in (8, 32, 128, MOST_NEIGHBOURS):
        neighbours = _nearest_points(correlation, points, places[~on_point], nearest[on_point], count)
        towards = _covariance(correlation, points[neighbours], np.vstack([places, points[checked]]))
        solve = _solver(_covariance(correlation, points[neighbours], points[neighbours]))
        from_neighbours = solve(towards[:, : len(places)]).T
        from_neighbours[on_point] = neighbours[None, :] == nearest[on_point, None]
        missed = _covariance(correlation, places, points[checked]) - from_neighbours @ towards[:, len(places) :]
        half = weights[checked] @ missed
        error = float(np.abs(half + half.T).max())
        if error < COVARIANCE_ERROR_SOUGHT or len(neighbours) == len(points):
            break
    return neighbours, from_neighbours, error


def _nearest_points(correlation, points, places, always: np.ndarray, count: int) -> np.ndarray:
    # Half of them by distance, for the cell around a datum, and half by distance over theta, for a long correlation.
    from scipy.spatial import cKDTree

    count = max(min(count, MOST_NEIGHBOURS // (2 * len(places))), 1)
    if len(points) <= min(MOST_NEIGHBOURS, 2 * count * len(places)):
        return np.arange(len(points))
    axes = np.array([[cos(correlation.rotation), sin(correlation.rotation)], [0.0, 0.0]])
    axes[1] = -axes[0, 1], axes[0, 0]
    found = [always]
    for metric in (axes, axes / np.array([[correlation.theta_h], [correlation.theta_v]])):
        found.append(cKDTree(points @ metric.T).query(places @ metric.T, np.arange(1, count + 1))[1].ravel())
    return np.unique(np.concatenate(found))


def _residual_factor(covariance: np.ndarray, is_random: np.ndarray) -> np.ndarray:
    """Factor of a covariance that is zero but between the random ones, shape (d, number of random ones)."""
    factor = np.zeros((len(covariance), int(is_random.sum())))
    if factor.shape[1]:
        values, vectors = np.linalg.eigh(covariance[np.ix_(is_random, is_random)])
        factor[is_random] = vectors * np.sqrt(np.maximum(values, 0.0))
    return factor
