"""The law of a field, from the settings of a study: distribution and correlation of the values at the points.

The correlation of the settings belongs to the standard-normal field below the marginal (`correlation_space` gaussian)
or to the physical variable itself (physical). With `averaging` volume, a value is the average of the physical variable
over the box around a point: its mean is kept, its variance falls by the factor gamma, and the covariance between two
such averages is exact (see `averaging`). The distribution of an average has no closed form; it is taken from the family
of the point values, with the smaller coefficient of variation, in which it has the right first two moments.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import radians, sqrt
from typing import Any, TypeVar

from rfmpm.random_fields.averaging import VolumeAveraged
from rfmpm.random_fields.correlation import CORRELATIONS, Anisotropy
from rfmpm.random_fields.correlation.nugget import WithNugget
from rfmpm.random_fields.correlation.protocol import Correlation
from rfmpm.random_fields.gaussian_space import InGaussianSpace, InPhysicalSpace, space_map
from rfmpm.random_fields.marginals import MARGINALS, Marginal

Entry = TypeVar("Entry")
Box = tuple[float, float]
DEFAULTS = {"lower_over_mean": 0.0}
SPACES = {"gaussian": False, "physical": True}  # whether the correlation is that of the physical variable
AVERAGINGS = {"point": False, "volume": True}  # whether values are averages


@dataclass(frozen=True)
class Law:
    """The law of a field.

    Attributes:
        correlated: correlation of that part of the standard-normal field that is correlated.
        nugget: share of the variance of the standard-normal field that differs from point to point [-].
        point_marginal: makes the distribution at a point from a mean and a coefficient of variation [-].
        variance_factor: variance of the values at the points over that at a point in the soil, gamma [-].
    """

    correlated: Correlation
    nugget: float
    point_marginal: Callable[[float, float], Marginal]
    variance_factor: float = 1.0

    @property
    def correlation(self) -> Correlation:
        """Correlation of the whole standard-normal field."""
        return WithNugget(self.correlated, self.nugget) if self.nugget else self.correlated

    def marginal(self, mean: float, coefficient_of_variation: float) -> Marginal:
        """Distribution of the values at the points, whose moments at a point in the soil these are; see `Distribution`.

        Raises:
            ValueError: moments that the distribution cannot have.
        """
        return self.point_marginal(mean, coefficient_of_variation * sqrt(self.variance_factor))


def law_of(settings: Any, box: Box | None = None) -> Law:
    """Compose the law of a field.

    Args:
        settings: the `random_field` entry of a study; an optional key that it lacks has its default.
        box: width and height of the volume of each point [m]; needed where `averaging` is volume.

    Returns:
        the law.

    Raises:
        ValueError: an unknown name; moments, scales or other settings out of range or at odds with each other; no box.
    """
    base = _base_correlation(settings)
    family = choose(MARGINALS, settings.distribution, "distribution")
    own = {name: _setting(settings, name, DEFAULTS.get(name)) for name in family.needs}
    if missing := [name for name, value in own.items() if value is None]:
        raise ValueError(f'{missing[0]}: missing; distribution = "{settings.distribution}" needs it')
    law = Law(base, _setting(settings, "nugget", 0.0), partial(family.from_moments, **own))
    WithNugget(base, law.nugget)  # refuses a share out of range
    # Correlations do not depend on the mean: the families are families of scale.
    point = law.marginal(1.0, settings.coefficient_of_variation)
    is_physical = choose(SPACES, _setting(settings, "correlation_space", "gaussian"), "correlation_space")
    if choose(AVERAGINGS, settings.averaging, "averaging"):
        return _averaged(law, point, settings.coefficient_of_variation, is_physical, box)
    if not is_physical:
        return law
    mapped = InGaussianSpace(base, space_map(point), 1.0 - law.nugget)
    return Law(mapped, 1.0 - mapped.gaussian_share if law.nugget else 0.0, law.point_marginal)


def choose(table: Mapping[str, Entry], name: str, key: str) -> Entry:
    """The entry of a table by its name; ValueError with the choices where it has none."""
    if name not in table:
        raise ValueError(f'{key} = "{name}": must be one of {", ".join(table)}')
    return table[name]


def _base_correlation(settings: Any) -> Anisotropy:
    kernel = choose(CORRELATIONS, settings.correlation, "correlation")
    own = {}
    if settings.correlation == "matern":
        own["nu"] = _setting(settings, "matern_nu")
        if own["nu"] is None:
            raise ValueError('matern_nu: missing; correlation = "matern" needs it')
    return kernel(
        theta_h=settings.scale_of_fluctuation_h_m,
        theta_v=settings.scale_of_fluctuation_v_m,
        rotation=radians(settings.rotation_deg),
        **own,
    )


def _averaged(law: Law, point: Marginal, coefficient_of_variation: float, is_physical: bool, box: Box | None) -> Law:
    if box is None:
        raise ValueError('averaging = "volume": needs the size of the boxes of the points')
    if law.nugget:
        raise ValueError('nugget: must be 0 where averaging = "volume": what is uncorrelated averages out')
    physical = law.correlated if is_physical else InPhysicalSpace(law.correlated, space_map(point))
    average = VolumeAveraged(physical, *box)
    reduced = Law(average, 0.0, law.point_marginal, average.variance_factor)
    mapped = InGaussianSpace(average, space_map(reduced.marginal(1.0, coefficient_of_variation)))
    return Law(mapped, 0.0, law.point_marginal, average.variance_factor)


def _setting(settings: Any, name: str, default: Any = None) -> Any:
    value = getattr(settings, name, None)
    return default if value is None else value
