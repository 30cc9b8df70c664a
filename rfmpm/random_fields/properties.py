"""The random properties of a soil: their fields in all layers, on the points or a reference lattice, realised together.

A material point has the field's value in the middle of its square, where the method needs a lattice to be fast: but for
points whose squares the ground surface cuts, that is where they are. `ANYWHERE` else it has the value at the point.

The vector `xi` of a realisation holds the parts of the properties in the order of the study; the part of a property
those of its soils, from above all layers down; the part of a soil is what its method takes.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.random_fields import field
from rfmpm.random_fields.common import reference, take
from rfmpm.random_fields.cross_correlation import mix, mixing_matrix
from rfmpm.random_fields.kinds import KINDS
from rfmpm.random_fields.layers import settings_of_soils, soil_of_points
from rfmpm.random_fields.measurements import measurements
from rfmpm.random_fields.property import Part, Properties, Property
from rfmpm.random_fields.site import Site, places_of
from rfmpm.random_fields.trend import Trend

ANYWHERE = ("cholesky", "local_kriging")  # methods for which points need no lattice
NO_POINTS = "no point lies in this soil, which its borders make too thin for these cells, or hide behind each other"


def prepare(study: Any, site: Site, store: Path | None = None, known: Properties | None = None) -> Properties:
    """Prepare the random properties of a study.

    Args:
        study: `fields`, `field_correlations` and `material` are read.
        site: where they are needed.
        store: as for `field.prepare`.
        known: properties of another study; what a method prepared there for equal correlation and points serves here.

    Returns:
        the prepared properties; those with one correlation on the same points share what a method prepared.

    Raises:
        ValueError: as for `field.prepare`; a trend that reaches zero; properties that cannot be correlated.
        OSError: the store cannot be written.
    """
    entries: dict[str, Property] = {}
    earlier = known.entries.values() if known is not None else ()
    for one in study.fields:
        before = [part for entry in (*earlier, *entries.values()) for part in entry.parts]
        own_site, material = site.of_materials(one.materials), study.material[one.materials[0]]
        try:
            own = _prepare_property(one.variable, one.settings, material, own_site, store, before)
        except ValueError as error:
            raise ValueError(f"{one.path}: {error}") from None
        entries[one.name] = own if len(site.counts) < 2 else _placed(own, study.material, site.counts, one.materials)
    if not study.field_correlations:
        return Properties(entries, None)
    _check_that_they_share(entries, study.field_correlations)
    return Properties(entries, mixing_matrix(list(entries), study.field_correlations))


def realise(properties: Properties, xi: np.ndarray) -> dict[str, np.ndarray]:
    """One realisation of all properties.

    Args:
        properties: the prepared properties.
        xi: standard-normal vector, shape (n_variables,) [-].

    Returns:
        values at the material points by name of what varies, all materials together, shape (n,) each: cohesions [Pa],
        angles [rad].

    Raises:
        ValueError: `xi` has another shape.
    """
    found: dict[str, np.ndarray] = {}
    for name, z in standard_normal(properties, xi).items():
        entry = properties.entries[name]
        found[entry.name] = _values(entry, z, found.get(entry.name))
    return found


def standard_normal(properties: Properties, xi: np.ndarray) -> dict[str, np.ndarray]:
    """One realisation of the standard-normal fields below the distributions, mixed where properties are correlated.

    Args:
        properties: as for `realise`.
        xi: as for `realise`.

    Returns:
        fields by name at the points that carry them, shape (count of the property,) each [-].

    Raises:
        ValueError: `xi` has another shape.
    """
    xi = np.asarray(xi, dtype=float)
    if xi.shape != (properties.n_variables,):
        raise ValueError(f"xi of shape {xi.shape}: must be ({properties.n_variables},), as this study's fields take")
    entries = properties.entries.values()
    fields = [_standard_normal(entry, part) for entry, part in zip(entries, _split(xi, entries), strict=True)]
    if properties.mixing is not None:
        fields = mix(properties.mixing, fields)
    return dict(zip(properties.entries, fields, strict=True))


def means(properties: Properties, count: int) -> dict[str, np.ndarray]:
    """Mean of each property in its uppermost soil at the crest, shape (count,) each: what a kernel compiles for."""
    return {
        entry.name: np.full(count, KINDS[entry.name].value(np.array(entry.parts[0].mean)))
        if entry.elsewhere is None
        else entry.elsewhere.copy()
        for entry in properties.entries.values()
    }


def _prepare_property(
    name: str, settings: Any, material: Any, site: Site, store: Path | None, before: list[Part]
) -> Property:
    points, taken, side = site.points if settings.method in ANYWHERE else site.middles, None, site.square
    if settings.reference_cell_m is not None:
        ratio = round(site.cell / settings.reference_cell_m)
        points, taken = reference(site.points, site.square, ratio, site.extent, settings.reference_value or "mean")
        side /= ratio
    soil = soil_of_points(settings.layer or (), points)
    kind, parts = KINDS[name], []
    data = measurements(settings.data or (), settings.measurement_error, kind.field_mean, kind.in_words)
    soil_of_data = soil_of_points(settings.layer or (), data.places)
    own_mean = getattr(material, kind.mean_key)
    numbers = [own_mean, *(getattr(layer, kind.layer_key) or own_mean for layer in settings.layer or ())]
    for number, (own, mean) in enumerate(zip(settings_of_soils(settings), numbers, strict=True)):
        members = slice(None) if not settings.layer else np.flatnonzero(soil == number)
        places, value = points[members], kind.field_mean(mean)
        path = f"layer.{number - 1}: " if number else ""
        if len(places) == 0:
            raise ValueError(f"{path or 'layer: '}{NO_POINTS}")
        shared = [part.field for part in before if np.array_equal(part.points, places)]
        known = data.some(soil_of_data == number)
        try:
            prepared = field.prepare(own, value, places, store, (side, side), _trend(own, site.crest), known, shared)
        except ValueError as error:
            raise ValueError(f"{path}{error}") from error
        parts.append(Part(number, own, value, places, members, prepared))
    return Property(name, tuple(parts), len(points), taken)


def _placed(entry: Property, materials: Any, counts: tuple[int, ...], own: Sequence[int]) -> Property:
    """The property of some of several materials, with what the others have in its stead."""
    kind = KINDS[entry.name]
    means = [kind.field_mean(getattr(material, kind.mean_key, float("nan"))) for material in materials]
    values = np.repeat([float(kind.value(np.array(mean))) for mean in means], counts)
    ratio = None
    if len(own) > 1:
        ratio = np.repeat([means[number] / means[own[0]] for number in own], [counts[number] for number in own])
    return replace(entry, elsewhere=values, places=places_of(counts, own), ratio=ratio)


def _trend(settings: Any, crest: float) -> Trend | None:
    mean_gain, deviation_gain = settings.trend_kpa_per_m, settings.standard_deviation_trend_kpa_per_m
    if mean_gain is None and deviation_gain is None:
        return None
    return Trend(crest, (mean_gain or 0.0) * 1e3, None if deviation_gain is None else deviation_gain * 1e3)


def _check_that_they_share(entries: Mapping[str, Property], correlations: Any) -> None:
    for entry in correlations:
        first, second = (entries[name] for name in entry.between)
        same = len(first.parts) == len(second.parts) and all(
            a.field.correlation == b.field.correlation and np.array_equal(a.points, b.points)
            for a, b in zip(first.parts, second.parts, strict=True)
        )
        if not same:
            raise ValueError(
                f"{' and '.join(entry.between)} are correlated, but not with one correlation in space on the same "
                "points: give both fields the same correlation, scales of fluctuation, rotation and layers; with "
                'correlation_space = "physical" or averaging = "volume" the same distribution and variation too'
            )


def _split(xi: np.ndarray, entries: Any) -> Iterator[np.ndarray]:
    start = 0
    for entry in entries:
        yield xi[start : start + entry.n_variables]
        start += entry.n_variables


def _standard_normal(entry: Property, xi: np.ndarray) -> np.ndarray:
    z = np.empty(entry.count)
    fields = [part.field for part in entry.parts]
    for part, own in zip(entry.parts, _split(xi, fields), strict=True):
        z[part.members] = field.realise_standard_normal(part.field, own)
    return z


def _values(entry: Property, z: np.ndarray, of_others: np.ndarray | None) -> np.ndarray:
    """Values of a property at all material points [SI], put into those that fields of other materials gave it."""
    values = np.empty(entry.count)
    for part in entry.parts:
        values[part.members] = part.field.marginal.transform(z[part.members])
    values = values if entry.taken is None else take(values, entry.taken)
    own = KINDS[entry.name].value(values if entry.ratio is None else values * entry.ratio)
    if entry.elsewhere is None:
        return own
    everywhere = entry.elsewhere.copy() if of_others is None else of_others
    everywhere[entry.where] = own
    return everywhere
