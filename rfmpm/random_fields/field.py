"""A random field of a positive strength at a set of points: prepared once, realised for every vector `xi`.

What the settings mean for the distribution and the correlation of the values is composed in `law`.
"""

from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.gaussian_space import InGaussianSpace
from rfmpm.random_fields.law import Box, choose, law_of
from rfmpm.random_fields.marginals import Marginal
from rfmpm.random_fields.methods import METHODS
from rfmpm.random_fields.store import find_or_prepare

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
        method: name in `METHODS`.
        record: what the method prepared for the correlated part of the standard-normal field.
        nugget: share of the variance of the standard-normal field that differs from point to point [-].
        count: number of points.
        variance_factor: variance of the values over that at a point in the soil [-]; 1 unless they are averages.
    """

    correlation: Correlation
    marginal: Marginal
    method: str
    record: Any
    nugget: float = 0.0
    count: int = 0
    variance_factor: float = 1.0

    @property
    def n_variables(self) -> int:
        """Length of the vector `xi`: what the method takes, then one for each point where there is a nugget."""
        return METHODS[self.method].n_variables(self.record) + (self.count if self.nugget else 0)


def prepare(
    settings: Any, mean: float, points: np.ndarray, store: Path | None = None, box: Box | None = None
) -> PreparedField:
    """Prepare the field of one strength parameter.

    Args:
        settings: the `random_field` entry of a study.
        mean: mean of the field [Pa].
        points: positions, shape (n, 2) [m].
        store: folder in which what the method prepares is kept and found again; None keeps it in memory only.
        box: width and height of the volume of each point [m]; needed where `averaging` is volume.

    Returns:
        the prepared field.

    Raises:
        ValueError: as for `law_of`; points that are not finite positions; a correlation that is none on them.
        OSError: the store cannot be written.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) == 0 or not np.all(np.isfinite(points)):
        raise ValueError(f"points of shape {points.shape}: must be finite positions, shape (n, 2), n > 0")
    method = choose(METHODS, settings.method, "method")
    law = law_of(settings, box)
    marginal = law.marginal(mean, settings.coefficient_of_variation)
    try:
        if store is None:
            record = method.prepare(law.correlated, points)
        else:
            record = find_or_prepare(settings.method, law.correlated, points, store)
    except ValueError as error:
        if isinstance(law.correlated, InGaussianSpace):
            raise ValueError(f"{error}: {NO_SUCH_FIELD}") from error
        raise
    return PreparedField(
        law.correlation, marginal, settings.method, record, law.nugget, len(points), law.variance_factor
    )


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
    method = METHODS[prepared.method]
    n_method = method.n_variables(prepared.record)
    z = method.transform(prepared.record, xi[:n_method])
    if not prepared.nugget:
        return z
    return sqrt(1.0 - prepared.nugget) * z + sqrt(prepared.nugget) * xi[n_method:]
