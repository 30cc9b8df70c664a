"""A random field of a positive strength at a set of points: prepared once, realised for every vector `xi`.

What the settings mean for the distribution and the correlation of the values is composed in `law`.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.random_fields.conditioning import Conditioning, condition, update
from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.gaussian_space import InGaussianSpace
from rfmpm.random_fields.law import Box, Law, choose, law_of
from rfmpm.random_fields.marginals import Marginal
from rfmpm.random_fields.measurements import Measurements, distinct, standard_normal_data
from rfmpm.random_fields.methods import AUTO, METHODS, OPTIONS
from rfmpm.random_fields.methods import choose as fastest_method
from rfmpm.random_fields.store import find_or_prepare
from rfmpm.random_fields.trend import Trend

# Not every correlation is that of a physical variable with the asked distribution, least of all a very smooth one.
NO_SUCH_FIELD = (
    "no standard-normal field has physical values with exactly this distribution and this correlation; take "
    'correlation_space = "gaussian" with averaging = "point", a rougher correlation or a lower coefficient_of_variation'
)


@dataclass(frozen=True)
class PreparedField:
    """A field ready to be realised.

    Attributes:
        correlation: of the standard-normal field, its nugget included.
        marginal: distribution of the values.
        method: name in `METHODS`; where a study says auto, the method that was chosen.
        options: what the method was given beside correlation and points, by name.
        record: what the method prepared for the correlated part of the standard-normal field.
        nugget: share of the variance of the standard-normal field that differs from point to point [-].
        count: number of points.
        variance_factor: variance of the values over that at a point in the soil [-]; 1 unless they are averages.
        data: the measured values; None without any.
        conditioning: what makes realisations agree with them; None without any.
    """

    correlation: Correlation
    marginal: Marginal
    method: str
    options: Mapping[str, float]
    record: Any
    nugget: float
    count: int
    variance_factor: float
    data: Measurements | None = None
    conditioning: Conditioning | None = None

    @property
    def parts_of_xi(self) -> tuple[int, int]:
        """Where in `xi` the variables of the method end, and those of the nugget (one per point); data's follow."""
        n_method = METHODS[self.method].n_variables(self.record)
        return n_method, n_method + (self.count if self.nugget else 0)

    @property
    def n_variables(self) -> int:
        """Length of the vector `xi`."""
        return self.parts_of_xi[1] + (self.conditioning.n_variables if self.conditioning else 0)


def prepare(
    settings: Any,
    mean: float,
    points: np.ndarray,
    store: Path | None = None,
    box: Box | None = None,
    trend: Trend | None = None,
    data: Measurements | None = None,
    shared: Iterable[PreparedField] = (),
) -> PreparedField:
    """Prepare the field of one strength parameter.

    Args:
        settings: the `random_field` entry of a study.
        mean: mean of the field, at depth zero of a trend [Pa].
        points: positions, shape (n, 2) [m].
        store: folder in which what the method prepares is kept and found again; None keeps it in memory only.
        box: width and height of the volume of each point [m]; needed where `averaging` is volume.
        trend: how mean and standard deviation change with depth; None: not at all.
        data: measured values that every realisation agrees with; None, or none of them, for an unconditional field.
        shared: fields on the same points; what the method prepared for one of equal correlation serves this one too.

    Returns:
        the prepared field.

    Raises:
        ValueError: as for `law_of`; points that are not finite positions; a correlation that is none on them; data
            that contradict each other, the distribution or the correlation; settings that exclude each other.
        OSError: the store cannot be written.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) == 0 or not np.all(np.isfinite(points)):
        raise ValueError(f"points of shape {points.shape}: must be finite positions, shape (n, 2), n > 0")
    law = law_of(settings, box)
    has_data = data is not None and len(data.values) > 0
    marginal = _marginal(law, mean, settings, trend, points)
    method = _method(law, settings, points)
    fixed = (
        law.correlation,
        marginal,
        *method,
        _record(law, *method, points, store, shared),
        law.nugget,
        len(points),
        law.variance_factor,
    )
    if not has_data:
        return PreparedField(*fixed)
    data = distinct(data)
    known = standard_normal_data(_marginal(law, mean, settings, trend, data.places), data)
    return PreparedField(*fixed, data, condition(law.correlation, points, known))


def realise(prepared: PreparedField, xi: np.ndarray) -> np.ndarray:
    """One realisation of the field.

    Args:
        prepared: the prepared field.
        xi: standard-normal vector, shape (n_variables,) [-].

    Returns:
        the field at the points, shape (n,) [Pa].

    Raises:
        ValueError: `xi` has another shape.
    """
    return prepared.marginal.transform(realise_standard_normal(prepared, xi))


def realise_standard_normal(prepared: PreparedField, xi: np.ndarray) -> np.ndarray:
    """One realisation of the standard-normal field below the marginal, shape (n,) [-]; arguments as for `realise`."""
    xi = np.ascontiguousarray(xi, dtype=np.float64)
    if xi.shape != (prepared.n_variables,):
        raise ValueError(f"xi of shape {xi.shape}: must be ({prepared.n_variables},)")
    of_method, of_nugget = prepared.parts_of_xi
    z = METHODS[prepared.method].transform(prepared.record, xi[:of_method])
    if prepared.nugget:
        z = sqrt(1.0 - prepared.nugget) * z + sqrt(prepared.nugget) * xi[of_method:of_nugget]
    return z if prepared.conditioning is None else update(prepared.conditioning, z, xi[of_nugget:])


def _marginal(law: Law, mean: float, settings: Any, trend: Trend | None, places: np.ndarray) -> Marginal:
    moments = mean, settings.coefficient_of_variation
    return law.marginal(*moments) if trend is None else trend.marginal(law.marginal, *moments, places)


def _method(law: Law, settings: Any, points: np.ndarray) -> tuple[str, dict[str, float]]:
    """Name of the method, and what the settings give it beside correlation and points."""
    name = fastest_method(law.correlated, points) if settings.method == AUTO else settings.method
    choose(METHODS, name, "method")
    given = {key: getattr(settings, key, None) for key in OPTIONS.get(name, ())}
    return name, {key: value for key, value in given.items() if value is not None}


def _record(
    law: Law,
    name: str,
    options: Mapping[str, float],
    points: np.ndarray,
    store: Path | None,
    shared: Iterable[PreparedField],
) -> Any:
    """What the method prepared, or what it prepared for a field of equal correlation."""
    for other in shared:
        if (other.correlation, other.method, other.options) == (law.correlation, name, options):
            return other.record
    try:
        if store is None:
            return METHODS[name].prepare(law.correlated, points, **options)
        return find_or_prepare(name, law.correlated, points, options, store)
    except ValueError as error:
        if isinstance(law.correlated, InGaussianSpace):
            raise ValueError(f"{error}: {NO_SUCH_FIELD}") from error
        raise
