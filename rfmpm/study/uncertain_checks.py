"""What the uncertain numbers of a study must satisfy: a key that may vary, and a distribution within what it allows."""

from collections.abc import Callable, Iterator
from copy import deepcopy
from typing import Any

from pydantic.fields import FieldInfo

from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, Unknown, path_of, problem
from rfmpm.study.schema import LIMITS, bare, child, chosen, field_at, limits_of, near_miss, tables, value_at
from rfmpm.study.uncertain_models import uniform_limits
from rfmpm.study.uncertain_models import value_at as quantile

PLACES = ("material", "boundary.base", "boundary.sides", "random_field", "random_field_correlation")
BELOW = ("layer", "random_field", "random_field_correlation")  # tables inside these
NUMERICAL = ("softening_reference_cell_m", "reference_cell_m", "karhunen_loeve_variance_share")  # no property of soil
CAPPED = ("residual_cohesion_kpa", "residual_friction_angle_deg", "residual_dilation_angle_deg")  # at their peaks
DEVIATIONS = 4.0  # of the standard normal; one value in 16 000 lies further out
HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION = 0.99  # towards 1 a truncated normal becomes exponential
GIVEN_BY = ({"mean", "coefficient_of_variation"}, {"low", "high"})


def uncertain_keys(known: Known) -> dict[str, tuple[Any, FieldInfo | None]]:
    """Dotted paths of the numbers that may be uncertain, with what they may hold; Unknown where a table is wrong."""
    found = {}
    for place in PLACES:
        annotation, _ = field_at(known.model, known.data, path_of(place))
        found |= _numbers_below(known, annotation, place)
    return found


def _numbers_below(known: Known, annotation: Any, place: str) -> dict[str, tuple[Any, FieldInfo | None]]:
    data, found = known[place], {}
    if not (members := tables(annotation)):
        for key in range(len(data or ())) if isinstance(data, list | None) else data:
            found |= _numbers_below(known, child(annotation, data, key)[0], f"{place}.{key}")
        return found
    for name, info in chosen(members, data).model_fields.items():
        if bare(info.annotation) is float and name not in NUMERICAL:
            found[f"{place}.{name}"] = info.annotation, info
        elif name in BELOW:
            found |= _numbers_below(known, info.annotation, f"{place}.{name}")
    return found


def _entries(known: Known) -> Iterator[str]:
    for index in range(len(known["uncertain"] or ())):
        yield f"uncertain.{index}"


def _key_may_be_uncertain(known: Known) -> Iterator[Problem]:
    if known["uncertain"] is None:
        return
    if not known["uncertain"]:
        yield problem(known, "uncertain", "must have a table, written [[uncertain]], or be left out")
    allowed = uncertain_keys(known)
    for entry in _entries(known):
        key = known[f"{entry}.key"]
        if key not in allowed:
            meant = near_miss(key, [name for name in allowed if known[name] is not None])
            guess = f" (did you mean {meant}?)" if meant else ""
            text = f"must be the path of a number of material, boundary or random_field that the study has{guess}"
            yield problem(known, f"{entry}.key", text)
        elif known[key] is None:
            text = "must have a value of its own in the study too, which a homogeneous simulation uses"
            yield problem(known, f"{entry}.key", text)


def _keys_differ(known: Known) -> Iterator[Problem]:
    seen = set()
    for entry in _entries(known):
        key = known[f"{entry}.key"]
        if key in seen:
            yield problem(known, f"{entry}.key", "is uncertain twice; keys must differ")
        seen.add(key)


def _distribution_is_given(known: Known) -> Iterator[Problem]:
    for entry in _entries(known):
        given = {name for pair in GIVEN_BY for name in pair if known[f"{entry}.{name}"] is not None}
        distribution, mean = known[f"{entry}.distribution"], known[f"{entry}.mean"]
        if given not in (GIVEN_BY if distribution == "uniform" else GIVEN_BY[:1]):
            pairs = "mean and coefficient_of_variation" + (", or low and high" if distribution == "uniform" else "")
            text = f"must have {pairs}" + ("" if distribution == "uniform" else f' where it is "{distribution}"')
            yield problem(known, f"{entry}.distribution", text)
        elif "low" in given and known[f"{entry}.low"] >= known[f"{entry}.high"]:
            yield problem(known, f"{entry}.low", f"must be less than high = {known[f'{entry}.high']:.10g}")
        elif "mean" in given and mean <= 0.0:
            yield problem(
                known, f"{entry}.mean", "must be greater than 0; a uniform distribution may have low and high"
            )
        elif distribution == "normal_truncated":
            highest = HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION
            if known[f"{entry}.coefficient_of_variation"] >= highest:
                text = f"must be less than {highest} for normal_truncated; lognormal allows more"
                yield problem(known, f"{entry}.coefficient_of_variation", text)


UNCERTAIN_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _key_may_be_uncertain,
    _keys_differ,
    _distribution_is_given,
]


def problems_at_the_ends(known: Known, joint_problems: Callable[[Known], list[Problem]]) -> list[Problem]:
    """What is wrong where one uncertain number is at the low or the high end of its distribution, the others as given.

    The ends of a distribution without limits are four standard deviations out; what lies beyond, or is wrong only
    together with other uncertain numbers, is a realisation that is refused. A residual above its peak is none: it
    counts as the peak.

    Args:
        known: a study that is right but for this.
        joint_problems: finds what is wrong between keys.

    Returns:
        The problems, in words of the key that leaves what is allowed.
    """
    found = []
    try:
        entries = list(_entries(known))
        for entry in entries:
            annotation = uncertain_keys(known)[known[f"{entry}.key"]]
            for end, value in zip(("low", "high"), _ends(known, entry), strict=True):
                found += _problems_at(known, entry, annotation, end, value, joint_problems)
    except Unknown:
        return found
    return found


def _ends(known: Known, entry: str) -> tuple[float, float]:
    distribution = known[f"{entry}.distribution"]
    mean, variation, low, high = (
        known[f"{entry}.{name}"] for name in ("mean", "coefficient_of_variation", "low", "high")
    )
    if distribution == "uniform":
        return uniform_limits(mean, variation, low, high)
    return tuple(quantile(distribution, mean, variation, sign * DEVIATIONS) for sign in (-1.0, 1.0))


def _problems_at(known, entry: str, annotation, end: str, value: float, joint_problems) -> list[Problem]:
    key = known[f"{entry}.key"]
    place = f"reaches {value:.4g} at its {end} end"
    is_truncated = value == 0.0 and known[f"{entry}.distribution"] == "normal_truncated"  # approached, never taken
    broken = [
        f"{words} {limit:.10g}"
        for name, (words, is_kept) in LIMITS.items()
        for limit in limits_of(*annotation, name)
        if not is_kept(value, limit) and not (is_truncated and limit == 0.0)
    ]
    if broken:
        return [Problem(path_of(entry), f"{key} {place}: must be {' and '.join(broken)}")]
    if is_truncated:
        return []
    data = deepcopy(known.data)
    *parents, last = path_of(key)
    value_at(data, tuple(parents))[last] = value
    data.pop("uncertain")
    wrong = joint_problems(Known(known.model, data, known.doubtful))
    return [Problem(path_of(entry), f"{key} {place}, and then {one}") for one in wrong if one.path[-1] not in CAPPED]
