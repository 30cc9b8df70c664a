"""Which studies can be known to be right only once their random fields have been made."""

from rfmpm.ground import is_plain, regions_of, size_of_body
from rfmpm.study.field_checks import SEPARABLE
from rfmpm.study.field_models import OwnField
from rfmpm.study.study import Study

ALWAYS_MADE = ("ar1", "kronecker", "cholesky")  # on any points that checks let pass, of a correlation at points

FEW_POINTS = 4500  # fewer than those up to which `auto` has the dense factor to fall back on, partial squares included


def fields_need_making(study: Study) -> bool:
    """Whether some random field may still be refused where it is made: its correlation, its data or its points.

    Args:
        study: a validated study.

    Returns:
        True where a field depends on more than closed forms: the correlation of the values or of averages, which not
        every distribution can have; a distribution from a sample; data, which must agree with the correlation; layers,
        which must hold a point; a method that is limited in what it can resolve, such as that for many points of a
        correlation that is no product along x and y.
    """
    return any(_needs_making(field.settings, _count(study)) for field in study.fields)


def with_fastest_methods(study: Study) -> Study:
    """The study with `auto` for every method that would only take longer to refuse, or to allow, the same fields."""
    fields = [(field.path, field.settings) for field in study.fields]
    paths = [path for path, field in fields if field.method in ALWAYS_MADE and _is_separable(field)]
    return study.with_changes({f"{path}.method": "auto" for path in paths})


def _count(study: Study) -> float:
    """Points in the rectangle around the body, at least those of the body itself."""
    geometry, cell = study.geometry, study.discretisation.cell_m
    regions = None if is_plain(geometry) else regions_of(geometry, study.material[0].name, cell)
    _, length, height = size_of_body(geometry, regions)
    return length * height / study.discretisation.cell_m**2 * study.discretisation.points_per_cell


def _needs_making(field: OwnField, count: float) -> bool:
    has_few = field.reference_cell_m is None and count <= FEW_POINTS
    is_limited = not (field.method in ALWAYS_MADE or (field.method == "auto" and (has_few or _is_separable(field))))
    is_checked = bool(field.data or field.layer) or field.distribution == "empirical"
    return _is_mapped(field) or is_limited or is_checked


def _is_mapped(field: OwnField) -> bool:
    return field.correlation_space == "physical" or field.averaging == "volume"


def _is_separable(field: OwnField) -> bool:
    """Whether `auto` makes the field on any lattice: its correlation is a product along x and y."""
    turned = [field.rotation_deg]
    for layer in field.layer or ():
        turned.append(layer.dip_deg if layer.rotation_deg is None else layer.rotation_deg)
    is_along_axes = all(angle % 90.0 == 0.0 for angle in turned)
    return is_along_axes and field.correlation in SEPARABLE and not _is_mapped(field)
