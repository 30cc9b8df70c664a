"""Which studies can be known to be right only once their random fields have been made."""

from rfmpm.study.field_models import RandomField
from rfmpm.study.study import Study

ALWAYS_MADE = ("ar1", "kronecker", "cholesky", "auto")  # on any points that checks let pass, of a correlation at points


def fields_need_making(study: Study) -> bool:
    """Whether some random field may still be refused where it is made: its correlation, its data or its points.

    Args:
        study: a validated study.

    Returns:
        True where a field depends on more than closed forms: the correlation of the values or of averages, which not
        every distribution can have; a distribution from a sample; data, which must agree with the correlation; layers,
        which must hold a point; a method that is limited in what it can resolve.
    """
    return any(_needs_making(field) for field in study.random_field.values())


def _needs_making(field: RandomField) -> bool:
    is_mapped = field.correlation_space == "physical" or field.averaging == "volume"
    is_limited = field.method not in ALWAYS_MADE or field.distribution == "empirical"
    return is_mapped or is_limited or bool(field.data or field.layer)
