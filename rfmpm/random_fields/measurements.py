"""Measured values of a variable at places, and what they are in the standard-normal space below its distribution."""

from collections.abc import Callable, Sequence
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm.random_fields.marginals import Marginal

FARTHEST = 8.0  # standard deviations; the probability beyond is 1e-15, and no sample of a soil ever decides about it
SAME_PLACE = 1e-9  # [m]
SAME_VALUE = 1e-9  # relative


class Measurements(NamedTuple):
    """Measured values.

    Attributes:
        places: shape (d, 2) [m].
        values: shape (d,), in the unit of the field.
        errors: coefficient of variation of the error of measurement, shape (d,) [-]; 0 for an exact value. The ratio
            of measured to true value is lognormal with median 1.
        labels: what an error calls each of them, array of text of shape (d,).
        in_words: a value of the field in the study's unit, with the unit.
    """

    places: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    labels: np.ndarray
    in_words: Callable[[float], str]

    def some(self, which: Any) -> "Measurements":
        """Those that an index array picks."""
        columns = {name: getattr(self, name)[which] for name in ("places", "values", "errors", "labels")}
        return self._replace(**columns)


class StandardNormalData(NamedTuple):
    """Measurements in standard-normal space: places, shape (d, 2) [m], values and error variances, shape (d,) [-]."""

    places: np.ndarray
    values: np.ndarray
    error_variances: np.ndarray


def measurements(
    data: Sequence[Any],
    measurement_error: float | None,
    to_field: Callable[[float], float],
    in_words: Callable[[float], str],
) -> Measurements:
    """The data of a study in the unit of the field.

    Args:
        data: entries with x_m, y_m, value, and measurement_error (None: the common one).
        measurement_error: the common coefficient of variation of the error [-]; None: exact.
        to_field: the number of the field that a value of the study stands for.
        in_words: a value of the field in the study's unit, with the unit.
    """
    common = measurement_error or 0.0
    table = np.array(
        [
            (d.x_m, d.y_m, to_field(d.value), common if d.measurement_error is None else d.measurement_error)
            for d in data
        ],
        dtype=float,
    ).reshape(-1, 4)
    labels = [f"data.{k} (x_m = {d.x_m:g}, y_m = {d.y_m:g}, value = {d.value:g})" for k, d in enumerate(data)]
    columns = table[:, :2].copy(), table[:, 2].copy(), table[:, 3].copy()
    return Measurements(*columns, np.array(labels, dtype=object), in_words)


def to_standard_normal(marginal: Marginal, values: np.ndarray) -> np.ndarray:
    """Standard-normal values with the same probability of non-exceedance, by bisection: for any increasing transform.

    Args:
        marginal: the distribution, or one for each value.
        values: physical values, shape (d,).

    Returns:
        shape (d,) [-]; NaN where the probability of a value, or that of exceeding it, is below 1e-15.
    """
    values = np.asarray(values, dtype=float)
    low, high = np.full(values.shape, -FARTHEST), np.full(values.shape, FARTHEST)
    outside = ~((marginal.transform(low) <= values) & (values <= marginal.transform(high)))
    for _ in range(64):  # halves 16 to below the spacing of floating-point numbers near 1
        middle = 0.5 * (low + high)
        below = marginal.transform(middle) < values
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(outside, np.nan, 0.5 * (low + high))


def standard_normal_data(marginal: Marginal, data: Measurements) -> StandardNormalData:
    """Measurements in standard-normal space.

    An error of coefficient of variation V becomes an error of variance ln(1 + V^2) / (d ln x / dz)^2: for a lognormal
    variable exactly, otherwise to first order in the error.

    Raises:
        ValueError: a value outside the range of the distribution; it names the datum.
    """
    z = to_standard_normal(marginal, data.values)
    if np.any(np.isnan(z)):
        k = int(np.flatnonzero(np.isnan(z))[0])
        low, high = (marginal.transform(np.full(len(z), end))[k] for end in (-FARTHEST, FARTHEST))
        raise ValueError(
            f"{data.labels[k]} lies outside what the distribution allows, {data.in_words(low)} to "
            f"{data.in_words(high)} there (probability 1e-15 beyond); are the unit and the mean right?"
        )
    step = 1e-4
    upper, lower = marginal.transform(z + step), marginal.transform(z - step)
    slope = (upper - lower) / (2.0 * step * data.values)
    with np.errstate(divide="ignore"):
        variance = np.where(data.errors > 0.0, np.log1p(data.errors**2) / slope**2, 0.0)
    return StandardNormalData(data.places, z, variance)


def distinct(data: Measurements) -> Measurements:
    """Keep exact measurements that say the same at the same place once, at the front; those with errors all stay.

    Raises:
        ValueError: two exact values that differ at one place; it names them.
    """
    kept: list[int] = []
    for k in np.flatnonzero(data.errors == 0.0):
        distance = np.hypot(*(data.places[kept] - data.places[k]).T) if kept else np.array([np.inf])
        if distance.min() > SAME_PLACE:
            kept.append(int(k))
            continue
        other = kept[int(np.argmin(distance))]
        if abs(data.values[k] - data.values[other]) > SAME_VALUE * abs(data.values[other]):
            raise ValueError(
                f"{data.labels[other]} and {data.labels[k]} contradict each other, both exact; give them a "
                "measurement_error, or keep one"
            )
    kept += map(int, np.flatnonzero(data.errors > 0.0))
    return data.some(kept)


def conditional_moments(marginal: Marginal, mean: np.ndarray, deviation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation of the physical variable where its standard-normal one is normal with these.

    Args:
        marginal: the distribution.
        mean: of the standard-normal variable, shape (n,) [-].
        deviation: its standard deviation, shape (n,) [-].

    Returns:
        both of shape (n,), in the unit of the field; Gauss-Hermite quadrature with 64 nodes.
    """
    nodes, weights = np.polynomial.hermite_e.hermegauss(64)
    weights = weights / sqrt(2.0 * np.pi)
    first, second = np.zeros_like(mean), np.zeros_like(mean)
    centre = marginal.transform(mean)
    for node, weight in zip(nodes, weights, strict=True):
        excess = marginal.transform(mean + node * deviation) - centre
        first += weight * excess
        second += weight * excess**2
    return centre + first, np.sqrt(np.maximum(second - first**2, 0.0))
