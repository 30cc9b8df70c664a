"""Sample statistics of a field over realisations, beside the asked ones."""

from collections.abc import Iterable, Iterator
from math import cos, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm.random_fields.conditioning import conditional_covariance
from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.field import PreparedField, realise_standard_normal
from rfmpm.random_fields.measurements import conditional_moments

MOST_PAIRS = 400


class Statistic(NamedTuple):
    """One statistic: what was asked, what was found, and the standard error of the finding.

    `name` is mean, standard_deviation (of the strength), correlation_h or correlation_v (of the standard-normal field,
    or with data covariance_h and covariance_v, of its departure from the conditional mean); `lag` [m] is zero for the
    first two.
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
    points = np.asarray(points, dtype=float)
    pairs = list(point_pairs(prepared.correlation, points))
    centre, means, deviation = 0.0, mean, mean * settings.coefficient_of_variation * sqrt(prepared.variance_factor)
    if conditioning := prepared.conditioning:
        pairs = [_conditional(pair, prepared, points) for pair in pairs]
        centre = conditioning.mean
        means, deviations = conditional_moments(prepared.marginal, centre, conditioning.deviation)
        deviation = float(np.sqrt(np.mean(deviations**2)))
    samples = []
    for xi in xis:
        z = realise_standard_normal(prepared, xi)
        strength = prepared.marginal.transform(z)
        z = z - centre
        products = [np.mean(z[pair.first] * z[pair.second]) for pair in pairs]
        samples.append([np.mean(strength), np.mean((strength - means) ** 2), *products])
    if len(samples) < 2:
        raise ValueError(f"{len(samples)} realisations: statistics need two or more")
    found = np.mean(samples, axis=0)
    error = np.std(samples, axis=0, ddof=1) / np.sqrt(len(samples))
    root = np.sqrt(found[1])
    return [
        Statistic("mean", 0.0, float(np.mean(means)), float(found[0]), float(error[0])),
        Statistic("standard_deviation", 0.0, deviation, float(root), float(error[1] / (2.0 * root))),
        *(
            Statistic(pair.name, pair.lag, pair.asked, float(found[k]), float(error[k]))
            for k, pair in enumerate(pairs, start=2)
        ),
    ]


def _conditional(pair: PointPairs, prepared: PreparedField, points: np.ndarray) -> PointPairs:
    asked = conditional_covariance(prepared.correlation, prepared.conditioning, points, pair.first, pair.second)
    return pair._replace(name=pair.name.replace("correlation", "covariance"), asked=float(np.mean(asked)))


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
    base = np.unique(np.linspace(0, len(points) - 1, MOST_PAIRS).astype(int))
    spacing = _spacing(points, base)
    for name, (theta, direction) in directions.items():
        for k in range(1, lags + 1):
            lag = 0.25 * k * theta
            partner, miss = _nearest(points, points[base] + lag * direction)
            kept = (miss <= 0.75 * spacing) & (partner != base)
            if np.any(kept):
                first, second = base[kept], partner[kept]
                true_lag = points[second] - points[first]
                asked = np.mean(correlation.rho(true_lag[:, 0], true_lag[:, 1]))
                yield PointPairs(name, lag, first, second, float(asked))


def _nearest(points: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    # Index of the point nearest to each place, and how far it is.
    distances = [np.hypot(*(points - place).T) for place in places]
    return np.array([np.argmin(row) for row in distances]), np.array([np.min(row) for row in distances])


def _spacing(points: np.ndarray, base: np.ndarray) -> float:
    # Median distance from a point to the nearest one elsewhere.
    distances = [np.hypot(*(points - points[index]).T) for index in base]
    return float(np.median([np.min(row[row > 0], initial=np.inf) for row in distances]))
