"""What the layers of a random field must satisfy: every soil has its place in the body, and a mean of its kind."""

from collections.abc import Callable, Iterator

from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.soils import (
    BORDER,
    LAYER_MEAN_KEY,
    fields_of,
    layers_of,
    lines_of,
    outline_of_points,
    outline_of_soil,
)


def _means_are_of_the_variable(known: Known) -> Iterator[Problem]:
    for variable, field, _ in fields_of(known):
        for layer in layers_of(known, field):
            for key in {"mean_kpa", "mean_deg"} - {LAYER_MEAN_KEY[variable]}:
                if known[f"{layer}.{key}"] is not None:
                    text = f"must be left out: the mean of {variable} is {LAYER_MEAN_KEY[variable]}"
                    yield problem(known, f"{layer}.{key}", text)


def _range_of_tops(known: Known, field: str, slope: float) -> tuple[float, float]:
    """Lowest and highest `top_m` [m] of a line of this slope between the points of a field."""
    offsets = [y - slope * x for x, y in outline_of_points(known, field)]
    return min(offsets), max(offsets)


def _crosses(known: Known, field: str, top: float, slope: float) -> bool:
    lowest, highest = _range_of_tops(known, field, slope)
    return lowest + BORDER < top <= highest + BORDER


def _layers_cross_the_body(known: Known) -> Iterator[Problem]:
    for _, field, _ in fields_of(known):
        for layer, (top, slope) in zip(layers_of(known, field), lines_of(known, field), strict=True):
            if not _crosses(known, field, top, slope):
                lowest, highest = _range_of_tops(known, field, slope)
                text = f"must be greater than {lowest:.4g} and at most {highest:.4g}, to have points above and below"
                yield problem(known, f"{layer}.top_m", text)


def _no_layer_hides_another(known: Known) -> Iterator[Problem]:
    """A point belongs to the last layer whose line it lies below, so that a layer cuts off those listed before it."""
    for _, field, _ in fields_of(known):
        lines, layers = lines_of(known, field), layers_of(known, field)
        if not all(_crosses(known, field, *line) for line in lines):
            continue  # another check's matter
        for number, path in enumerate([field, *layers]):
            if outline_of_soil(outline_of_points(known, field), lines, number):
                continue
            if number == 0:
                text = "leave no point of the body above all of them: lower one of them, or leave one out"
                yield Problem(path_of(f"{field}.layer"), text)
            else:
                later = " and ".join(layer.removeprefix(f"{field}.") for layer in _hiding(known, field, number))
                text = f"holds no point of the body, as {later}, listed later, reaches up to the soil above it: list "
                yield Problem(path_of(path), f"{text}layers from the top down")


def _hiding(known: Known, field: str, number: int) -> list[str]:
    """The layer that alone hides a soil, or all later ones where only together they do."""
    outline, lines, layers = outline_of_points(known, field), lines_of(known, field), layers_of(known, field)
    for later in range(number, len(layers)):
        if not outline_of_soil(outline, [lines[number - 1], lines[later]], 1):
            return [layers[later]]
    return layers[number:]


LAYER_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _means_are_of_the_variable,
    _layers_cross_the_body,
    _no_layer_hides_another,
]
