"""The random fields of a study in one list, whether a table of their own or that of a material holds them."""

from typing import Any, NamedTuple

from rfmpm.study.field_models import OwnField


class FieldOfSoils(NamedTuple):
    """A random field of a study.

    Attributes:
        name: "cohesion", or "cohesion of clay" in the table of a material; no other field has it.
        variable: what is random.
        path: of its table in the study.
        settings: that table.
        materials: positions in the study's list of those that have it, first the one whose mean is that of the table.
    """

    name: str
    variable: str
    path: str
    settings: OwnField
    materials: tuple[int, ...]


class CorrelatedFields(NamedTuple):
    """Two random fields by name, and the correlation of their standard-normal fields at one point [-]."""

    between: tuple[str, str]
    coefficient: float


def fields_of(study: Any) -> tuple[FieldOfSoils, ...]:
    """List the random fields of a study: those of [random_field], then each material's own.

    Args:
        study: a validated study.

    Returns:
        The fields.
    """
    position = {material.name: number for number, material in enumerate(study.material)}
    found = []
    for variable, settings in study.random_field.items():
        materials = tuple(position[name] for name in (settings.material, *(settings.shared_with or ())))
        found.append(FieldOfSoils(variable, variable, f"random_field.{variable}", settings, materials))
    for number, material in enumerate(study.material):
        for variable, settings in (material.random_field or {}).items():
            path = f"material.{number}.random_field.{variable}"
            found.append(FieldOfSoils(_own_name(variable, material), variable, path, settings, (number,)))
    return tuple(found)


def correlated_fields(study: Any) -> tuple[CorrelatedFields, ...]:
    """List the correlations between the random fields of a study, in the order of the fields; as `fields_of`."""
    found = [CorrelatedFields(one.between, one.coefficient) for one in study.random_field_correlation or ()]
    for material in study.material:
        for one in material.random_field_correlation or ():
            first, second = (_own_name(variable, material) for variable in one.between)
            found.append(CorrelatedFields((first, second), one.coefficient))
    return tuple(found)


def _own_name(variable: str, material: Any) -> str:
    return f"{variable} of {material.name}"
