"""What the distribution, the correlation and the averaging of a random field must satisfy together."""

from collections.abc import Callable, Iterator

from rfmpm.study.errors import Problem
from rfmpm.study.known import Known, path_of, problem

BOUNDED = ("beta", "bounded_tanh")
NEEDED_BY = {"upper_over_mean": BOUNDED, "sample": ("empirical",), "matern_nu": ("matern",)}
CHOSEN_BY = {"matern_nu": "correlation"}  # the others: distribution
WHAT = {
    "upper_over_mean": "a number greater than 1, the upper bound over the mean",
    "sample": "a list of at least 10 measured values; or name a file of them, sample_file",
    "matern_nu": "a number, the smoothness: 0.5 is rough, 2.5 smooth",
}
SMALLEST_SAMPLE = 10
LOWEST_BETA_PARAMETER = 0.2  # below, most of the mass sticks to the bounds
HIGHEST_TANH_SHARE = 0.9  # of the largest variance between the bounds


def _fields(known: Known) -> Iterator[str]:
    for variable in known["random_field"]:
        yield f"random_field.{variable}"


def _has_what_it_needs(known: Known) -> Iterator[Problem]:
    for field in _fields(known):
        for key, users in NEEDED_BY.items():
            chooser = CHOSEN_BY.get(key, "distribution")
            chosen, value = known[f"{field}.{chooser}"], known[f"{field}.{key}"]
            if chosen in users and value is None:
                yield Problem(path_of(f"{field}.{key}"), f'missing; {chooser} = "{chosen}" needs {WHAT[key]}')
            elif chosen not in users and value is not None:
                yield problem(known, f"{field}.{key}", f'has no meaning where {chooser} = "{chosen}": leave it out')
        if known[f"{field}.lower_over_mean"] is not None and known[f"{field}.distribution"] not in BOUNDED:
            text = f'has no meaning where distribution = "{known[f"{field}.distribution"]}": leave it out'
            yield problem(known, f"{field}.lower_over_mean", text)


def _spread_fits_between_the_bounds(known: Known) -> Iterator[Problem]:
    """Largest variance of a variable between bounds: (mean - lower) (upper - mean), all of it at the bounds."""
    for field in _fields(known):
        distribution, upper = known[f"{field}.distribution"], known[f"{field}.upper_over_mean"]
        if distribution not in BOUNDED or upper is None:
            continue
        lower = known[f"{field}.lower_over_mean"] or 0.0
        share = HIGHEST_TANH_SHARE
        if distribution == "beta":
            nearer = min(1.0 - lower, upper - 1.0) / (upper - lower)
            share = 1.0 / (1.0 + LOWEST_BETA_PARAMETER / nearer)
        highest = (share * (1.0 - lower) * (upper - 1.0)) ** 0.5
        if known[f"{field}.coefficient_of_variation"] >= highest:
            text = (
                f"must be less than {highest:.4g} between these bounds; or lower lower_over_mean, raise upper_over_mean"
            )
            yield problem(known, f"{field}.coefficient_of_variation", text)


def _sample_shows_a_shape(known: Known) -> Iterator[Problem]:
    for field in _fields(known):
        sample = known[f"{field}.sample"]
        if sample is None or known[f"{field}.distribution"] != "empirical":
            continue
        if len(sample) < SMALLEST_SAMPLE:
            text = f"has {len(sample)} values: must be at least {SMALLEST_SAMPLE} to show the shape of a distribution"
            yield Problem(path_of(f"{field}.sample"), text)
        elif len({known[f"{field}.sample.{index}"] for index in range(len(sample))}) == 1:
            yield Problem(path_of(f"{field}.sample"), "has equal values only: they show no distribution")


def _sample_file_is_read(known: Known) -> Iterator[Problem]:
    for field in _fields(known):
        if known[f"{field}.sample_file"] is not None:
            text = "is read where a study is loaded: use load_study, or give its content as sample"
            yield problem(known, f"{field}.sample_file", text)


def _an_average_has_no_nugget(known: Known) -> Iterator[Problem]:
    for field in _fields(known):
        if known[f"{field}.averaging"] == "volume" and known[f"{field}.nugget"] > 0.0:
            text = 'must be 0 where averaging = "volume": what differs from point to point averages out'
            yield problem(known, f"{field}.nugget", text)


DISTRIBUTION_CHECKS: list[Callable[[Known], Iterator[Problem]]] = [
    _has_what_it_needs,
    _spread_fits_between_the_bounds,
    _sample_shows_a_shape,
    _sample_file_is_read,
    _an_average_has_no_nugget,
]
