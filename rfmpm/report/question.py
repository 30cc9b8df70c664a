"""The question of a study, its answer and the reservations, for a reader who knows risk but not the method."""

from rfmpm.report import words
from rfmpm.report.numbers import Numbers

NAMES = {
    "ok": "came to rest",
    "not_at_rest": "still moving at the end",
    "diverged": "diverged",
    "left_grid": "a point left the grid",
    "timeout": "ran out of time",
    "crashed": "crashed",
    "lost": "lost",
}

MEANS = {
    "cohesion": ("cohesion_kpa", " kPa"),
    "residual_cohesion": ("residual_cohesion_kpa", " kPa"),
    "friction_angle": ("friction_angle_deg", "° (its tangent is what varies)"),
}


def question(study) -> str:
    """Say what was asked.

    Args:
        study: the Study.

    Returns:
        A few sentences.
    """
    limit = study.quantities.run_out_limit_m
    asked = f"How far does the soil run out, and how likely is it to travel more than {limit:g} m beyond the toe?"
    return f"{_body(study)} {_strength(study)} {asked}"


def _body(study) -> str:
    geometry = study.geometry
    if geometry.kind == "slope":
        body = f"A slope {geometry.height_m:g} m high, inclined at {geometry.angle_deg:g}°,"
    else:
        body = f"A block of soil {geometry.width_m:g} m wide and {geometry.height_m:g} m high"
    return f"{body} is released under its own weight."


def _strength(study) -> str:
    if not study.random_field:
        return "Its strength is the same everywhere and in every realisation."
    properties = "; ".join(_random_property(study, name, field) for name, field in study.random_field.items())
    return (
        f"Its strength varies from place to place: {properties}. "
        f"Each realisation is one such {study.geometry.kind} with its own pattern of weak and strong zones, followed "
        f"until it comes to rest, for at most {study.time.end_s:g} s."
    )


def _random_property(study, name: str, field) -> str:
    key, unit = MEANS[name]
    mean = getattr(next(m for m in study.material if m.name == field.material), key)
    return (
        f"{name.replace('_', ' ')} has a mean of {mean:g}{unit} and a coefficient of variation of "
        f"{100 * field.coefficient_of_variation:g} %, and stays alike over about "
        f"{field.scale_of_fluctuation_h_m:g} m along and {field.scale_of_fluctuation_v_m:g} m across the layering"
    )


def answer(numbers: Numbers) -> list[str]:
    """Say what was found.

    Args:
        numbers: of the report.

    Returns:
        Sentences, the most important first.
    """
    if not numbers.completed:
        return ["No realisation completed, so the run-out and its probability are unknown."]
    mean, probability, failing = numbers.mean_run_out, numbers.exceedance, numbers.failing
    return [
        f"The probability that the run-out exceeds {numbers.limit:g} m is {words.share(probability.value)} "
        f"({words.share_interval(probability)}).",
        f"The mean run-out is {words.number(mean.value)} m ({words.interval(mean, 'm')}); half of the realisations "
        f"stay within {words.number(numbers.quantiles['median'].value)} m and 95 % within "
        f"{words.number(numbers.quantiles['p95'].value)} m.",
        f"Some soil fails with probability {words.share(failing.value)} ({words.share_interval(failing)}).",
    ]


def reservations(numbers: Numbers, study) -> list[str]:
    """Say what must be known to read the answer.

    Args:
        numbers: of the report.
        study: the Study.

    Returns:
        Sentences; the last one holds for every report.
    """
    found = []
    failed, unfinished = numbers.used - numbers.completed, numbers.statuses.get("not_at_rest", 0)
    if numbers.used < study.study.realisations and numbers.used == numbers.held:
        found.append(
            f"This is a part of the study: realisations {numbers.first} to {numbers.first + numbers.used - 1} of "
            f"{study.study.realisations}, counted from 0."
        )
    if numbers.used < numbers.held:
        found.append(
            f"Of {numbers.held} realisations on record {numbers.used} are used, those before the first missing index: "
            "what is finished beyond it was finished because it was quick, and would bias the answer."
        )
    if failed:
        found.append(
            f"{words.count(failed, 'realisation')} of {numbers.used} did not complete. The value of a probability "
            "leaves them out; its interval counts them both as exceeding and as not exceeding. "
            "The mean leaves them out."
        )
    if numbers.censored:
        found.append(
            f"In {words.count(numbers.censored, 'realisation')} the soil reached the far wall (censored): counted as "
            "exceeding every limit; the mean takes the distance to the wall and is therefore too low."
        )
    if unfinished:
        found.append(
            f"{words.count(unfinished, 'realisation')} had not come to rest at the end of the simulated time; "
            "the run-out reached by then is used."
        )
    if not study.random_field:
        found.append("Nothing is random in this study: all realisations are the same, and the intervals mean nothing.")
    elif numbers.completed == 1:
        found.append("A single completed realisation says next to nothing about a probability.")
    return [
        *found,
        "The intervals express the limited number of realisations alone; whether the model and its soil statistics "
        "suit the site is another question.",
    ]
