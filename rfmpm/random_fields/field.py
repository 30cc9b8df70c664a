"""A random field of a positive strength at a set of points: prepared once, realised for every vector `xi`.

The scales of fluctuation describe the standard-normal field from which the marginal distribution is made: for a
lognormal strength, its logarithm. A correlation rho measured on a lognormal strength itself, of coefficient of
variation V, is ln(1 + rho V^2) / ln(1 + V^2) in that space (Fenton and Griffiths 2008), which is larger by less than
one hundredth at V = 0.25.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from rfmpm.random_fields.correlation import CORRELATIONS, Anisotropy
from rfmpm.random_fields.marginals import MARGINALS, Marginal
from rfmpm.random_fields.methods import METHODS
from rfmpm.random_fields.store import find_or_prepare
from rfmpm.random_fields.trend import Trend

Entry = TypeVar("Entry")


@dataclass(frozen=True)
class PreparedField:
    """A field ready to be realised: its correlation, its marginal distribution, and what its method prepared."""

    correlation: Anisotropy
    marginal: Marginal
    method: str
    record: Any

    @property
    def n_variables(self) -> int:
        """Length of the vector `xi`."""
        return METHODS[self.method].n_variables(self.record)


def prepare(
    settings: Any,
    mean: float,
    points: np.ndarray,
    store: Path | None = None,
    trend: Trend | None = None,
    shared: Iterable[PreparedField] = (),
) -> PreparedField:
    """Prepare the field of one strength parameter.

    Args:
        settings: the `random_field` entry of a study.
        mean: mean of the field, at depth zero of a trend [Pa].
        points: positions, shape (n, 2) [m].
        store: folder in which what the method prepares is kept and found again; None keeps it in memory only.
        trend: how mean and standard deviation change with depth; None: not at all.
        shared: fields on the same points; what the method prepared for one of equal correlation serves this one too.

    Returns:
        the prepared field.

    Raises:
        ValueError: an unknown name, moments or scales out of range, points that are not finite positions.
        OSError: the store cannot be written.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) == 0 or not np.all(np.isfinite(points)):
        raise ValueError(f"points of shape {points.shape}: must be finite positions, shape (n, 2), n > 0")
    kernel = _choose(CORRELATIONS, settings.correlation, "correlation")
    method = _choose(METHODS, settings.method, "method")
    factory = _choose(MARGINALS, settings.distribution, "distribution").from_moments
    moments = mean, settings.coefficient_of_variation
    marginal = factory(*moments) if trend is None else trend.marginal(factory, *moments, points)
    correlation = kernel(
        theta_h=settings.scale_of_fluctuation_h_m,
        theta_v=settings.scale_of_fluctuation_v_m,
        rotation=radians(settings.rotation_deg),
    )
    alike = [other for other in shared if (other.correlation, other.method) == (correlation, settings.method)]
    if alike:
        record = alike[0].record
    elif store is None:
        record = method.prepare(correlation, points)
    else:
        record = find_or_prepare(settings.method, correlation, points, store)
    return PreparedField(correlation, marginal, settings.method, record)


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
    return METHODS[prepared.method].transform(prepared.record, xi)


def _choose(table: Mapping[str, Entry], name: str, key: str) -> Entry:
    if name not in table:
        raise ValueError(f"{key} = {name!r}: must be one of {', '.join(table)}")
    return table[name]
