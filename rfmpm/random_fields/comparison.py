"""All random properties of a study compared with what was asked: soil by soil, and with each other.

The fields are those that enter the simulation, after correlated properties have been mixed. Where a soil has a trend
its values are compared as if its distribution were everywhere that at the crest: a trend changes what the standard-
normal field stands for, not how it varies.
"""

from collections.abc import Iterable, Sequence
from math import nan, sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.random_fields.common import take
from rfmpm.random_fields.properties import standard_normal
from rfmpm.random_fields.property import Part, Properties, Property
from rfmpm.random_fields.statistics import (
    Asked,
    Share,
    Statistic,
    ask,
    averages,
    compare,
    found_means,
    is_conditional,
    standard_deviation,
    variance_of_mean,
)

MOST_SHOWN = 2000  # points of a soil whose values are kept for a picture; material points whose means are compared


class Soil(NamedTuple):
    """One soil of a property, compared.

    Attributes:
        part: its field.
        shares: of its standard-normal field.
        statistics: of the points that carry it.
        of_means: mean and standard deviation of the means that material points take, of those within this soil; empty
            where they take single values.
        sample: values at up to 2000 points, as at the crest, shape (realisations, -) [unit of the field].
        misfit: largest relative difference from exact data on points, over all realisations; NaN without such data.
    """

    part: Part
    shares: tuple[Share, ...]
    statistics: list[Statistic]
    of_means: list[Statistic]
    sample: np.ndarray
    misfit: float


class Cross(NamedTuple):
    """Correlation of the standard-normal fields of two properties at one point; with data, conditional covariance."""

    between: tuple[str, str]
    statistic: Statistic


class Comparison(NamedTuple):
    """The soils of each property by name, the correlated pairs, and standard-normal fields of the first two."""

    soils: dict[str, list[Soil]]
    cross: list[Cross]
    first_two: list[dict[str, np.ndarray]]


def compare_properties(
    properties: Properties, correlated: Sequence[tuple[str, str]], xis: Iterable[np.ndarray]
) -> Comparison:
    """Compare random properties over many realisations with what was asked.

    Args:
        properties: the prepared properties.
        correlated: pairs of their names whose correlation is wanted.
        xis: standard-normal vectors, each of shape (n_variables,) [-]; at least two.

    Returns:
        the comparison.

    Raises:
        ValueError: fewer than two realisations.
    """
    watched = {
        name: [_Watched(entry, part, shares_of(properties, name, number)) for number, part in enumerate(entry.parts)]
        for name, entry in properties.entries.items()
    }
    first_two, products = [], []
    for xi in xis:
        fields = standard_normal(properties, xi)
        for name, soils in watched.items():
            for soil in soils:
                soil.see(fields[name])
        products.append([_product(watched, fields, pair) for pair in correlated])
        if len(first_two) < 2:
            first_two.append(fields)
    found = found_means(products) if correlated else []
    cross = [
        Cross(pair, Statistic(_cross_name(watched, pair), 0.0, _asked_cross(properties, watched, pair), *own))
        for pair, own in zip(correlated, found, strict=True)
    ]
    return Comparison({name: [soil.compared() for soil in soils] for name, soils in watched.items()}, cross, first_two)


def shares_of(properties: Properties, name: str, number: int) -> tuple[Share, ...]:
    """What the standard-normal field of a property is a mixture of, in the soil of its part of this number."""
    names = list(properties.entries)
    if properties.mixing is None:
        return (Share(1.0, properties.entries[name].parts[number].field.conditioning),)
    row = properties.mixing[names.index(name)]
    return tuple(
        Share(float(weight), properties.entries[other].parts[number].field.conditioning)
        for other, weight in zip(names, row, strict=True)
        if weight != 0.0
    )


class _Watched:
    """A soil of which one realisation after the other is seen."""

    def __init__(self, entry: Property, part: Part, shares: tuple[Share, ...]) -> None:
        self.part, self.shares = part, shares
        self.asked = ask(part.at_crest, part.settings, part.mean, part.points, shares)
        self.shown = _some(np.arange(len(part.points)))
        self.taken = _taken_within(entry, part)
        self.asked_means = _asked_means(self.asked, part, shares, self.taken)
        self.averages, self.sample, self.of_means, self.misfit = [], [], [], nan

    def see(self, z: np.ndarray) -> None:
        z = z[self.part.members]
        self.averages.append(averages(self.asked, z))
        marginal = self.part.at_crest.marginal
        self.sample.append(marginal.transform(z[self.shown]))
        if len(self.taken):
            means = take(marginal.transform(z), self.taken)
            self.of_means.append([np.mean(means), np.mean((means - self.asked_means[0]) ** 2)])
        held, measured = exact_data(self.part)
        if len(held):
            misfit = np.abs(self.part.field.marginal.transform(z)[held] / measured - 1.0).max()
            self.misfit = float(np.fmax(self.misfit, misfit))

    def compared(self) -> Soil:
        of_means = []
        if len(self.taken):
            (mean, error), variance = found_means(self.of_means)
            of_means = [
                Statistic("mean", 0.0, float(np.mean(self.asked_means[0])), mean, error),
                standard_deviation(self.asked_means[1], *variance),
            ]
        statistics = compare(self.asked, self.averages)
        return Soil(self.part, self.shares, statistics, of_means, np.array(self.sample), self.misfit)


def exact_data(part: Part) -> tuple[np.ndarray, np.ndarray]:
    """Points on which exact data lie, and the data [unit of the field], both of shape (k,)."""
    if part.field.conditioning is None:
        return np.empty(0, dtype=int), np.empty(0)
    on_points = part.field.conditioning.on_points
    held = (part.field.conditioning.data.error_variances == 0.0) & (on_points >= 0)
    return on_points[held], part.field.data.values[held]


def _some(items: np.ndarray) -> np.ndarray:
    return items[np.unique(np.linspace(0, len(items) - 1, min(MOST_SHOWN, len(items))).astype(int))]


def _taken_within(entry: Property, part: Part) -> np.ndarray:
    """Which points of a soil the material points take that lie in it as a whole, shape (k, taken); k = 0: no means."""
    if entry.taken is None or entry.taken.shape[1] == 1:
        return np.empty((0, 1), dtype=int)
    place = np.full(entry.count, -1)
    place[part.members] = np.arange(len(part.points))
    taken = place[entry.taken]
    within = taken[np.all(taken >= 0, axis=1)]
    return _some(within) if len(within) else within


def _asked_means(
    asked: Asked, part: Part, shares: Sequence[Share], taken: np.ndarray
) -> tuple[np.ndarray | float, float]:
    """Mean, at each material point or everywhere, and standard deviation of the means over points that they take."""
    if len(taken) == 0:
        return nan, nan
    if is_conditional(shares):
        return take(asked.means, taken), nan
    return asked.means, asked.deviation * sqrt(variance_of_mean(part.at_crest, part.points[taken[0]]))


def _cross_name(watched: dict, pair: tuple[str, str]) -> str:
    with_data = any(is_conditional(soil.shares) for name in pair for soil in watched[name])
    return "cross_covariance" if with_data else "cross_correlation"


def _product(watched: dict, fields: dict, pair: tuple[str, str]) -> float:
    """Mean over all points of the product of two fields, each less its mean."""
    total = 0.0
    for soils in zip(*(watched[name] for name in pair), strict=True):
        first, second = (
            fields[name][soil.part.members] - soil.asked.centre for name, soil in zip(pair, soils, strict=True)
        )
        total += float(first @ second)
    return total / len(fields[pair[0]])


def _asked_cross(properties: Properties, watched: dict, pair: tuple[str, str]) -> float:
    """The coefficient of the study; with data, the mean of the conditional covariance."""
    names = list(properties.entries)
    rows = [properties.mixing[names.index(name)] for name in pair]
    total = 0.0
    for number, soil in enumerate(watched[pair[0]]):
        parts = [properties.entries[name].parts for name in names]
        for weight, own in zip(rows[0] * rows[1], parts, strict=True):
            if weight != 0.0:
                known = own[number].field.conditioning
                variance = 1.0 if known is None else float(np.mean(known.deviation**2))
                total += weight * variance * len(soil.part.points)
    return total / sum(len(soil.part.points) for soil in watched[pair[0]])
