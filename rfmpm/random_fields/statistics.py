"""Sample statistics of a field over realisations, beside the asked ones."""

from collections.abc import Iterable, Iterator, Sequence
from math import cos, nan, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm.random_fields.conditioning import Conditioning, conditional_covariance
from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.field import PreparedField, realise_standard_normal
from rfmpm.random_fields.gaussian_space import space_map
from rfmpm.random_fields.marginals import Marginal
from rfmpm.random_fields.measurements import conditional_moments

MOST_PAIRS = 400


class Statistic(NamedTuple):
    """One statistic: what was asked, what was found, and the standard error of the finding.

    `name` is mean, standard_deviation (of the strength), correlation_h or correlation_v (of the standard-normal field,
    or with data covariance_h and covariance_v, of its departure from the conditional mean); `lag` [m] is zero for the
    first two. `asked` is NaN where it is not known exactly.
    """

    name: str
    lag: float
    asked: float
    found: float
    standard_error: float


class PointPairs(NamedTuple):
    """Pairs of points about one lag apart along one axis, and the mean of the asked correlation over them."""

    name: str
    lag: float
    first: np.ndarray
    second: np.ndarray
    asked: float


class Share(NamedTuple):
    """Share of a standard-normal field that is a mixture of independent ones of one correlation.

    Attributes:
        weight: what the independent field is multiplied by [-]; the squares of the weights add up to one.
        conditioning: what makes that field agree with data; None without any.
    """

    weight: float
    conditioning: Conditioning | None


class Asked(NamedTuple):
    """What is asked of a field, to be compared with its realisations.

    Attributes:
        marginal: distribution of the values.
        pairs: of points.
        centre: mean of the standard-normal field, shape (n,), or zero without data [-].
        means: of the values, shape (n,), or one number without data [unit of the field].
        deviation: standard deviation of the values, root of its mean square over the points [the same].
    """

    marginal: Marginal
    pairs: tuple[PointPairs, ...]
    centre: np.ndarray | float
    means: np.ndarray | float
    deviation: float


def statistics(
    prepared: PreparedField, settings: Any, mean: float, points: np.ndarray, xis: Iterable[np.ndarray]
) -> list[Statistic]:
    """Compare the field over many realisations with what was asked.

    Each realisation gives one average over the points, or over pairs of points; the realisations are independent, and
    the standard error comes from the scatter between them. With data, what is asked is the conditional distribution of
    each point, averaged in the same way.

    Args:
        prepared: the prepared field.
        settings: the `random_field` entry of a study.
        mean: mean of the field [Pa].
        points: positions the field was prepared for, shape (n, 2) [m].
        xis: standard-normal vectors, each of shape (n_variables,) [-]; at least two.

    Returns:
        mean and standard deviation [Pa], and the correlation or covariance [-] at lags k theta / 4, k = 1 to 8, along
        the h axis and across it, as far as there are points that far apart.

    Raises:
        ValueError: fewer than two realisations.
    """
    asked = ask(prepared, settings, mean, points, [Share(1.0, prepared.conditioning)])
    return compare(asked, [averages(asked, realise_standard_normal(prepared, xi)) for xi in xis])


def ask(prepared: PreparedField, settings: Any, mean: float, points: np.ndarray, shares: Sequence[Share]) -> Asked:
    """What is asked of a field.

    Args:
        prepared, settings, mean, points: as for `statistics`.
        shares: of the standard-normal field.
    """
    points = np.asarray(points, dtype=float)
    pairs = tuple(point_pairs(prepared.correlation, points))
    deviation = mean * settings.coefficient_of_variation * sqrt(prepared.variance_factor)
    if not is_conditional(shares):
        return Asked(prepared.marginal, pairs, 0.0, mean, deviation)
    pairs = tuple(_conditional(pair, prepared.correlation, points, shares) for pair in pairs)
    centre, spread = conditional_normal(shares)
    means, deviations = conditional_moments(prepared.marginal, centre, spread)
    return Asked(prepared.marginal, pairs, centre, means, float(np.sqrt(np.mean(deviations**2))))


def is_conditional(shares: Iterable[Share]) -> bool:
    """Whether data have a say in a field."""
    return any(share.conditioning is not None for share in shares)


def conditional_normal(shares: Sequence[Share]) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation of a standard-normal field with data in a share of it, shape (n,) each [-]."""
    known = [share for share in shares if share.conditioning is not None]
    free = 1.0 - sum(share.weight**2 for share in known)
    variance = sum(share.weight**2 * share.conditioning.deviation**2 for share in known) + free
    return sum(share.weight * share.conditioning.mean for share in known), np.sqrt(variance)


def averages(asked: Asked, z: np.ndarray) -> np.ndarray:
    """What one realisation of the standard-normal field, shape (n,), gives: averages over points and pairs of them."""
    values = asked.marginal.transform(z)
    z = z - asked.centre
    products = [np.mean(z[pair.first] * z[pair.second]) for pair in asked.pairs]
    return np.array([np.mean(values), np.mean((values - asked.means) ** 2), *products])


def compare(asked: Asked, samples: Sequence[np.ndarray]) -> list[Statistic]:
    """Statistics from the averages of two or more realisations; as `statistics` returns and raises."""
    means, deviations, *products = found_means(samples)
    return [
        Statistic("mean", 0.0, float(np.mean(asked.means)), *means),
        standard_deviation(asked.deviation, *deviations),
        *(Statistic(pair.name, pair.lag, pair.asked, *own) for pair, own in zip(asked.pairs, products, strict=True)),
    ]


def found_means(samples: Sequence[np.ndarray]) -> list[tuple[float, float]]:
    """Mean over independent realisations and its standard error, for each of the numbers that a realisation gives."""
    if len(samples) < 2:
        raise ValueError(f"{len(samples)} realisations: statistics need two or more")
    errors = np.std(samples, axis=0, ddof=1) / np.sqrt(len(samples))
    return list(zip(np.mean(samples, axis=0).tolist(), errors.tolist(), strict=True))


def standard_deviation(asked: float, variance: float, error: float) -> Statistic:
    """The statistic of a standard deviation from the variance found and the standard error of that."""
    root = sqrt(variance)
    return Statistic("standard_deviation", 0.0, asked, root, error / (2.0 * root) if root > 0.0 else nan)


def variance_of_mean(prepared: PreparedField, points: np.ndarray) -> float:
    """Variance of the arithmetic mean over a block of a lattice, over the variance of one of its values.

    It is the mean of the correlation of the values over all pairs of points of the block. In a block of c columns and
    r rows the lag of i columns and j rows occurs (c - |i|) (r - |j|) times.

    Args:
        prepared: a field with one distribution everywhere and no data.
        points: of the block, shape (c r, 2) [m].

    Returns:
        share of the variance that is left [-].
    """
    axes = [np.unique(np.round(points[:, axis], 9)) for axis in (0, 1)]
    lags = [np.concatenate([axis - axis[-1], axis[1:] - axis[0]]) for axis in axes]
    times = [len(axis) - np.abs(np.arange(1 - len(axis), len(axis))) for axis in axes]
    lag_x, lag_y = np.meshgrid(*lags)
    lag_x[np.abs(lag_x) < 1e-9], lag_y[np.abs(lag_y) < 1e-9] = 0.0, 0.0  # the nugget knows lag zero from others
    correlation = space_map(prepared.marginal).to_physical(prepared.correlation.rho(lag_x, lag_y))
    return float(times[1] @ correlation @ times[0]) / len(points) ** 2


def _conditional(pair: PointPairs, correlation: Correlation, points: np.ndarray, shares: Sequence[Share]) -> PointPairs:
    asked = sum(
        share.weight**2 * conditional_covariance(correlation, share.conditioning, points, pair.first, pair.second)
        for share in shares
        if share.conditioning is not None
    )
    free = sum(share.weight**2 for share in shares if share.conditioning is None)
    name = pair.name.replace("correlation", "covariance")
    return pair._replace(name=name, asked=float(np.mean(asked)) + free * pair.asked)


def point_pairs(correlation: Correlation, points: np.ndarray, lags: int = 8) -> Iterator[PointPairs]:
    """Pairs of points about k theta / 4 apart, k = 1 to `lags`, along the h axis and across it.

    The partner of a point is the one nearest to the place a lag away, if that is within three quarters of a point
    spacing; the correlation asked is the one at the lags that the pairs really have. A lag without pairs is left out.
    """
    cosine, sine = cos(correlation.rotation), sin(correlation.rotation)
    directions = {
        "correlation_h": (correlation.theta_h, np.array([cosine, sine])),
        "correlation_v": (correlation.theta_v, np.array([-sine, cosine])),
    }
    from scipy.spatial import cKDTree  # late: commands that make no field do not pay for it

    base = np.unique(np.linspace(0, len(points) - 1, MOST_PAIRS).astype(int))
    spacing, nearest = _spacing(points, base), cKDTree(points)
    for name, (theta, direction) in directions.items():
        for k in range(1, lags + 1):
            lag = 0.25 * k * theta
            miss, partner = nearest.query(points[base] + (1.0 - 1e-9) * lag * direction)  # of two as near: the closer
            kept = (miss <= 0.75 * spacing) & (partner != base)
            if np.any(kept):
                first, second = base[kept], partner[kept]
                true_lag = points[second] - points[first]
                asked = np.mean(correlation.rho(true_lag[:, 0], true_lag[:, 1]))
                yield PointPairs(name, lag, first, second, float(asked))


def _spacing(points: np.ndarray, base: np.ndarray) -> float:
    # Median distance from a point to the nearest one elsewhere.
    from scipy.spatial import cKDTree

    places = np.unique(points, axis=0)
    return float(np.median(cKDTree(places).query(points[base], [2])[0]))  # the nearest place of all is the point's own
