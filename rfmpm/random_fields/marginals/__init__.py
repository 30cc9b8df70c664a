"""The marginal distributions a study can name. A new one is a file here and a line in the table."""

from rfmpm.random_fields.marginals.beta import Beta
from rfmpm.random_fields.marginals.bounded_tanh import BoundedTanh
from rfmpm.random_fields.marginals.empirical import Empirical
from rfmpm.random_fields.marginals.gamma import Gamma
from rfmpm.random_fields.marginals.lognormal import Lognormal
from rfmpm.random_fields.marginals.normal_truncated import (
    HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION,
    NormalTruncated,
)
from rfmpm.random_fields.marginals.protocol import Distribution, Marginal
from rfmpm.random_fields.marginals.weibull import Weibull

__all__ = [
    "HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION",
    "MARGINALS",
    "Distribution",
    "Lognormal",
    "Marginal",
    "NormalTruncated",
]

MARGINALS: dict[str, type[Distribution]] = {
    "lognormal": Lognormal,
    "normal_truncated": NormalTruncated,
    "beta": Beta,
    "bounded_tanh": BoundedTanh,
    "gamma": Gamma,
    "weibull": Weibull,
    "empirical": Empirical,
}
