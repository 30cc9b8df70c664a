"""What the distribution, the correlation and the averaging of a random field must satisfy together."""

from collections.abc import Callable, Iterator

from rfmpm.study.bodies import height_of
from rfmpm.study.errors import Problem
from rfmpm.study.field_checks import LARGEST_VARIATION
from rfmpm.study.known import Known, path_of, problem
from rfmpm.study.soils import fields_of, layers_of, paths_of_fields, soils_of

BOUNDED = ("beta", "bounded_tanh")
NEEDED_BY = {"upper_over_mean": BOUNDED, "sample": ("empirical",), "matern_nu": ("matern",)}
CHOSEN_BY = {"matern_nu": "correlation"}  # the others: distribution
ALLOWED_BY = {  # keys with a default, and what gives them a meaning
    "lower_over_mean": ("distribution", BOUNDED),
    "karhunen_loeve_variance_share": ("method", ("karhunen_loeve",)),
}
WHAT = {
    "upper_over_mean": "a number greater than 1, the upper bound over the mean",
    "sample": "a list of at least 10 measured values; or name a file of them, sample_file",
    "matern_nu": "a number, the smoothness: 0.5 is rough, 2.5 smooth",
}
SMALLEST_SAMPLE = 10
LOWEST_BETA_PARAMETER = 0.2  # below, most of the mass sticks to the bounds
HIGHEST_TANH_SHARE = 0.9  # of the largest variance between the bounds
HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION = 0.99  # towards 1 a truncated normal becomes exponential


def _has_what_it_needs(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        for key, users in NEEDED_BY.items():
            chooser = CHOSEN_BY.get(key, "distribution")
            chosen, value = known[f"{field}.{chooser}"], known[f"{field}.{key}"]
            if chosen in users and value is None:
                yield Problem(path_of(f"{field}.{key}"), f'missing; {chooser} = "{chosen}" needs {WHAT[key]}')
            elif chosen not in users and value is not None:
                yield problem(known, f"{field}.{key}", f'has no meaning where {chooser} = "{chosen}": leave it out')
        for key, (chooser, users) in ALLOWED_BY.items():
            chosen = known[f"{field}.{chooser}"]
            if known[f"{field}.{key}"] is not None and chosen not in users:
                yield problem(known, f"{field}.{key}", f'has no meaning where {chooser} = "{chosen}": leave it out')


def _highest_variation(known: Known, field: str) -> tuple[float, str] | None:
    """What every coefficient of variation must stay below, and where; None where the distribution has no such limit.

    Largest variance of a variable between bounds: (mean - lower) (upper - mean), all of it at the bounds.
    """
    distribution, upper = known[f"{field}.distribution"], known[f"{field}.upper_over_mean"]
    if distribution == "normal_truncated":
        return HIGHEST_TRUNCATED_COEFFICIENT_OF_VARIATION, "for normal_truncated; lognormal allows more"
    if distribution not in BOUNDED or upper is None:
        return None
    lower = known[f"{field}.lower_over_mean"] or 0.0
    share = HIGHEST_TANH_SHARE
    if distribution == "beta":
        nearer = min(1.0 - lower, upper - 1.0) / (upper - lower)
        share = 1.0 / (1.0 + LOWEST_BETA_PARAMETER / nearer)
    highest = (share * (1.0 - lower) * (upper - 1.0)) ** 0.5
    return highest, "between these bounds; or lower lower_over_mean, raise upper_over_mean"


def _variation_suits_the_distribution(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        if (limit := _highest_variation(known, field)) is None:
            continue
        highest, where = limit
        for key in (f"{path}.coefficient_of_variation" for path in (field, *layers_of(known, field))):
            if (known[key] or 0.0) >= highest:
                yield problem(known, key, f"must be less than {highest:.4g} {where}")


def _variation_at_the_base_suits_the_distribution(known: Known) -> Iterator[Problem]:
    """The coefficient of variation rises or falls from crest to base: what holds at both holds between them."""
    for variable, field, material in fields_of(known):
        limit, height = _highest_variation(known, field), height_of(known)
        for soil in soils_of(known, variable, field, material):
            base = soil.mean_at(height)
            if limit is None or soil.deviation_gain is None or min(soil.mean, base) <= 0.0:
                continue
            (highest, where), found = limit, soil.variation_at(height)
            if highest <= found <= LARGEST_VARIATION:
                most = (highest * base - soil.mean * soil.variation) / height
                text = f"makes the coefficient of variation {found:.4g} at a depth of {height:g} m, where the mean is "
                text += f"{base:.4g} kPa: must be less than {most:.4g}, to keep it below {highest:.4g} {where}"
                yield problem(known, f"{field}.standard_deviation_trend_kpa_per_m", text)


def _sample_shows_a_shape(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        sample = known[f"{field}.sample"]
        if sample is None or known[f"{field}.distribution"] != "empirical":
            continue
        if len(sample) < SMALLEST_SAMPLE:
            text = f"has {len(sample)} values: must be at least {SMALLEST_SAMPLE} to show the shape of a distribution"
            yield Problem(path_of(f"{field}.sample"), text)
        elif len({known[f"{field}.sample.{index}"] for index in range(len(sample))}) == 1:
            yield Problem(path_of(f"{field}.sample"), "has equal values only: they show no distribution")


def _sample_file_is_read(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        if known[f"{field}.sample_file"] is not None:
            text = "is read where a study is loaded: use load_study, or give its content as sample"
            yield problem(known, f"{field}.sample_file", text)


def _an_average_has_no_nugget(known: Known) -> Iterator[Problem]:
    for _, field in paths_of_fields(known):
        if known[f"{field}.averaging"] == "volume" and known[f"{field}.nugget"] > 0.0:
            text = 'must be 0 where averaging = "volume": what differs from point to point averages out'
            yield problem(known, f"{field}.nugget", text)


DISTRIBUTION_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _has_what_it_needs,
    _variation_suits_the_distribution,
    _variation_at_the_base_suits_the_distribution,
    _sample_shows_a_shape,
    _sample_file_is_read,
    _an_average_has_no_nugget,
]
