"""What the measured values of a random field must satisfy: each other, its distribution, and the body they are of."""

from collections.abc import Callable, Iterator, Sequence
from math import atan, degrees, exp, inf, log, log1p, sqrt
from typing import NamedTuple

from rfmpm.study.bodies import height_of
from rfmpm.study.data_file import contradictions
from rfmpm.study.distribution_checks import BOUNDED
from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.soils import (
    Place,
    Soil,
    distance,
    fields_of,
    lines_of,
    of_field,
    outline_of_body,
    outline_of_soil,
    over_scales,
    paths_of_fields,
    soil_at,
    soils_of,
)

FARTHEST_DEVIATIONS = 8.0  # from the median: the probability beyond is 1e-15
FARTHEST_SCALES = 3.0  # of fluctuation; the Markov correlation is 0.0025 there
LARGEST_ANGLE = 80.0  # [degrees]
LARGEST_VARIATION_OF_DATA, LARGEST_LOGARITHM = 1e6, 700.0  # far beyond any soil, and short of overflow


class Datum(NamedTuple):
    """One measured value [kPa or degrees] and the coefficient of variation of its error [-]; 0: exact."""

    path: str
    place: Place
    value: float
    error: float


def _data_of(known: Known, field: str) -> list[Datum]:
    common, data = known[f"{field}.measurement_error"], []
    for number in range(len(known[f"{field}.data"] or ())):
        path = f"{field}.data.{number}"
        x, y, value, own = (known[f"{path}.{name}"] for name in ("x_m", "y_m", "value", "measurement_error"))
        data.append(Datum(path, (x, y), value, (common if own is None else own) or 0.0))
    return data


def _soils_of_data(known: Known) -> Iterator[tuple[str, str, list[tuple[Datum, int, Soil]]]]:
    """Variable and path of each field that has data, and the data with the number and the soil they lie in."""
    for variable, field, material in fields_of(known):
        if data := _data_of(known, field):
            lines, soils = lines_of(known, field), soils_of(known, variable, field, material)
            numbers = [soil_at(lines, datum.place) for datum in data]
            yield variable, field, [(datum, k, soils[k]) for datum, k in zip(data, numbers, strict=True)]


def _data_files_are_read(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        key = f"{field}.data_file"
        if known[key] is not None:
            text = "is read where a study is loaded: use load_study, or give its content as data"
            yield problem(known, key, text)


def _data_agree(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        data = _data_of(known, field)
        labels = [datum.path.removeprefix(f"{field}.") for datum in data]
        values = [(*datum.place, datum.value, datum.error) for datum in data]
        for first, second, text in contradictions(values, labels):
            yield problem(known, f"{field}.{first}", f"and {second} {text}")


def _data_are_of_the_distribution(known: Known) -> Iterator[Problem]:
    for variable, field, placed in _soils_of_data(known):
        unit, crest = "degrees" if variable == "friction_angle" else "kPa", height_of(known)
        for datum, _, soil in placed:
            (x, y), depth = datum.place, crest - datum.place[1]
            at = f"at x_m = {x:g}, y_m = {y:g}"
            if variable == "friction_angle" and datum.value > LARGEST_ANGLE:
                yield problem(known, f"{datum.path}.value", f"{at}: must be at most {LARGEST_ANGLE:g} degrees")
                continue
            if soil.mean == 0.0:
                continue  # another check's matter
            if soil.mean_at(depth) <= 0.0 or soil.variation_at(depth) <= 0.0:
                what = "mean" if soil.mean_at(depth) <= 0.0 else "standard deviation"
                text = f"lies where the trend makes the {what} 0 or less, at x_m = {x:g}, a depth of {depth:g} m: "
                yield problem(known, f"{datum.path}.y_m", f"{text}leave the datum out, or change the trend")
                continue
            low, high = _range(known, field, soil, depth)
            if not low < of_field(variable, datum.value) < high:
                low, high = (degrees(atan(end)) if variable == "friction_angle" else end for end in (low, high))
                text = f"{at}: must be greater than {low:.4g} and less than {high:.4g} {unit} to be of this "
                yield problem(known, f"{datum.path}.value", f"{text}distribution; are the unit and the mean right?")


def _range(known: Known, field: str, soil: Soil, depth: float) -> tuple[float, float]:
    """Between what values a field may have one at a depth, where a closed form says so [kPa or -]."""
    distribution, mean = known[f"{field}.distribution"], soil.mean_at(depth)
    if distribution == "lognormal":
        variance = log1p(min(soil.variation_at(depth), LARGEST_VARIATION_OF_DATA) ** 2)
        median, reach = log(mean) - 0.5 * variance, FARTHEST_DEVIATIONS * sqrt(variance)
        return exp(median - reach), exp(min(median + reach, LARGEST_LOGARITHM))
    if distribution in BOUNDED and known[f"{field}.upper_over_mean"] is not None:
        return mean * (known[f"{field}.lower_over_mean"] or 0.0), mean * known[f"{field}.upper_over_mean"]
    return 0.0, inf


def _data_concern_the_body(known: Known) -> Iterator[Problem]:
    """Data far from all soil of their own change nothing: a unit, or an origin, must be wrong."""
    for _, field, placed in _soils_of_data(known):
        if any(_scales_away(known, field, datum, number, soil) <= FARTHEST_SCALES for datum, number, soil in placed):
            continue
        nearest, metres = _nearest(known, field, placed)
        if nearest is None:
            text = "lie in a layer that the body holds nothing of: they change no value"
            yield Problem(path_of(f"{field}.data"), text)
            continue
        (x, y), what = nearest.place, "is" if len(placed) == 1 else "are all"
        text = f"{what} too far from the body to change a value; the nearest, at x_m = {x:g}, y_m = {y:g} with value = "
        text += f"{nearest.value:g}, is {metres:.4g} m away: must be within {FARTHEST_SCALES:g} scales of fluctuation "
        yield Problem(path_of(f"{field}.data"), f"{text}of the soil they are of; x_m is 0 at the left, y_m at the base")


def _scales_away(known: Known, field: str, datum: Datum, number: int, soil: Soil) -> float:
    """Distance of a datum from the soil it is of, in scales of fluctuation."""
    outline = outline_of_soil(outline_of_body(known, field), lines_of(known, field), number)
    if not outline:
        return inf
    keys = ("scale_of_fluctuation_h_m", "scale_of_fluctuation_v_m")
    scales = tuple(known[f"{soil.path}.{key}"] or known[f"{field}.{key}"] for key in keys)
    rotation = known[f"{soil.path}.rotation_deg"]
    if rotation is None:
        rotation = known[f"{soil.path}.dip_deg"]
    (place,), corners = (over_scales(places, scales, rotation) for places in ([datum.place], outline))
    return distance(place, corners)


def _nearest(known: Known, field: str, placed: Sequence[tuple[Datum, int, Soil]]) -> tuple[Datum | None, float]:
    """The datum that is nearest to the soil it is of, and its distance [m]; None if the body holds no such soil."""
    found: tuple[Datum | None, float] = None, inf
    for datum, number, _ in placed:
        outline = outline_of_soil(outline_of_body(known, field), lines_of(known, field), number)
        away = distance(datum.place, outline) if outline else inf
        if away < found[1]:
            found = datum, away
    return found


DATA_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _data_files_are_read,
    _data_agree,
    _data_are_of_the_distribution,
    _data_concern_the_body,
]
