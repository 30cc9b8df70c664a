"""What correlated random fields of a study must satisfy: they vary alike in space, and their coefficients agree."""

from collections.abc import Callable, Collection, Iterator
from math import sqrt
from typing import Any

from rfmpm.study.errors import Problem
from rfmpm.study.field_models import FieldLayer, OwnField, RandomField
from rfmpm.study.kinds import Table
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.schema import shown
from rfmpm.study.soils import layers_of, material_above, paths_of_fields

# Keys that say what the values are; all others say how they vary in space, and are those of both fields.
OF_THE_VALUES = {
    *("distribution", "coefficient_of_variation"),
    *("trend_kpa_per_m", "standard_deviation_trend_kpa_per_m"),
    *("lower_over_mean", "upper_over_mean", "sample", "sample_file"),
    *("data", "data_file", "measurement_error"),
}
OF_THE_VALUES_IN_A_LAYER = {"mean_kpa", "mean_deg", "coefficient_of_variation"}
OF_THE_DISTRIBUTION = {  # with what it is where left out
    "distribution": None,
    "coefficient_of_variation": None,
    "lower_over_mean": 0.0,
    "upper_over_mean": None,
    "sample": None,
}
SMALLEST_PIVOT = 1e-12  # of the matrix of the coefficients; below it a field would be no more than the others


def _pairs(known: Known, fields: str) -> Iterator[tuple[str, str, str]]:
    """Path of each correlation and its two fields, of the fields in one table."""
    correlations = f"{fields}_correlation"
    for number in range(len(known[correlations] or ())):
        path = f"{correlations}.{number}"
        yield path, known[f"{path}.between.0"], known[f"{path}.between.1"]


def _tables(known: Known) -> Iterator[tuple[str, Collection[str]]]:
    """Paths of the tables of fields, and the variables in each: that of the study, then those of its materials."""
    for place in ("", *(f"material.{index}." for index in range(len(known["material"])))):
        yield f"{place}random_field", known[f"{place}random_field"] or ()


def _present_pairs(known: Known) -> Iterator[tuple[str, str]]:
    """Paths of the two fields of each correlation between two that exist."""
    for fields, names in _tables(known):
        for _, first, second in _pairs(known, fields):
            if first != second and first in names and second in names:
                yield f"{fields}.{first}", f"{fields}.{second}"


def _keys_in_space(field: str) -> set[str]:
    model = OwnField if material_above(field) else RandomField
    return model.model_fields.keys() - OF_THE_VALUES - {"layer"}


def _correlated_fields_exist_once(known: Known) -> Iterator[Problem]:
    for fields, names in _tables(known):
        seen = set()
        for path, first, second in _pairs(known, fields):
            for place, name in enumerate((first, second)):
                if name not in names:
                    text = f"is not random in this study: add the table {fields}.{name}, or leave this one out"
                    yield problem(known, f"{path}.between.{place}", text)
            if first == second or frozenset((first, second)) in seen:
                yield problem(known, f"{path}.between", "must be two different fields, and each pair once")
            seen.add(frozenset((first, second)))


def _correlated_fields_vary_alike(known: Known) -> Iterator[Problem]:
    for own, other in _present_pairs(known):
        for key in _keys_in_space(own):
            if (asked := known[f"{own}.{key}"]) != known[f"{other}.{key}"]:
                text = f"must be that of {own}, with which it is correlated: {'left out' if asked is None else asked}"
                yield _unequal(known, f"{other}.{key}", text)
        if _borders(known, own) != _borders(known, other):
            text = f"must have the borders, scales and rotations of {own}, with which it is correlated"
            yield _unequal(known, f"{other}.layer", text)


def _correlated_values_have_one_distribution(known: Known) -> Iterator[Problem]:
    """Fields whose correlation is that of the values share one standard-normal field's only if distributed alike."""
    for own, other in _present_pairs(known):
        if known[f"{own}.averaging"] == "volume":
            chosen = 'averaging = "volume"'
        elif known[f"{own}.correlation_space"] == "physical":
            chosen = 'correlation_space = "physical"'
        else:
            continue
        where = f"must be that of {own}, with which it is correlated, where {chosen}"
        for key in OF_THE_DISTRIBUTION:
            asked = known[f"{own}.{key}"] or OF_THE_DISTRIBUTION[key]
            if asked != (known[f"{other}.{key}"] or OF_THE_DISTRIBUTION[key]):
                expected = "the same values" if key == "sample" else "left out" if asked is None else shown(asked)
                yield _unequal(known, f"{other}.{key}", f"{where}: {expected}")
        for layer, its_own in zip(layers_of(known, other), layers_of(known, own), strict=False):
            key = "coefficient_of_variation"
            variations = [known[f"{path}.{key}"] for path in (its_own, layer)]
            asked, found = (
                value or known[f"{field}.{key}"] for value, field in zip(variations, (own, other), strict=True)
            )
            if asked != found and variations != [None, None]:
                yield _unequal(known, f"{layer}.{key}", f"{where}: {asked:g}")


def _the_first_of_them_has_the_data(known: Known) -> Iterator[Problem]:
    """The later of two correlated fields is a share of the earlier one and what is independent of it."""
    order = [field for _, field in paths_of_fields(known)]
    for pair in _present_pairs(known):
        key = f"{max(pair, key=order.index)}.data"
        if known[key]:
            text = "must be left out: of correlated fields only the first in the study may have data"
            yield Problem(path_of(key), f"{text}; write this one before the others")


def _unequal(known: Known, key: str, text: str) -> Problem:
    return Problem(path_of(key), f"missing; {text}") if known[key] is None else problem(known, key, text)


def _borders(known: Known, field: str) -> list[dict[str, Any]]:
    count = len(known[f"{field}.layer"] or ())
    return [_values(known, f"{field}.layer.{number}", FieldLayer, OF_THE_VALUES_IN_A_LAYER) for number in range(count)]


def _values(known: Known, path: str, model: type[Table], without: set[str]) -> dict[str, Any]:
    return {key: known[f"{path}.{key}"] for key in model.model_fields if key not in without}


def _coefficients_allow_each_other(known: Known) -> Iterator[Problem]:
    """The matrix of the coefficients must be positive definite: it has a Cholesky factor."""
    for fields, variables in _tables(known):
        names = list(variables)
        matrix = [[float(i == j) for j in names] for i in names]
        for path, *pair in _pairs(known, fields):
            if set(pair) <= set(names) and pair[0] != pair[1]:
                i, j = (names.index(name) for name in pair)
                matrix[i][j] = matrix[j][i] = known[f"{path}.coefficient"]
        if not _has_factor(matrix):
            text = "has coefficients that exclude each other: bring one of them closer to 0"
            yield Problem(path_of(f"{fields}_correlation"), text)


def _has_factor(matrix: list[list[float]]) -> bool:
    """Whether a symmetric matrix has a Cholesky factor."""
    lower = [[0.0] * len(matrix) for _ in matrix]
    for i in range(len(matrix)):
        for j in range(i + 1):
            left = matrix[i][j] - sum(lower[i][k] * lower[j][k] for k in range(j))
            if i == j and left <= SMALLEST_PIVOT:
                return False
            lower[i][j] = sqrt(left) if i == j else left / lower[j][j]
    return True


CORRELATION_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _correlated_fields_exist_once,
    _correlated_fields_vary_alike,
    _correlated_values_have_one_distribution,
    _the_first_of_them_has_the_data,
    _coefficients_allow_each_other,
]
