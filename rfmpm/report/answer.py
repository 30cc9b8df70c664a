"""The answer of a study in plain words: one sentence, how sure it is, what it rests on and what weakens it."""

import math

from rfmpm.planning.records import BOUNDED_BY
from rfmpm.report import words
from rfmpm.report.budget import FEW
from rfmpm.report.numbers import Numbers

SIMULATION = "simulation"


def headline(numbers: Numbers) -> str:
    """Answer the question in one sentence, with all of the error that is known.

    Args:
        numbers: of the report.

    Returns:
        A sentence.
    """
    asked, answer, whole = numbers.asked, numbers.answer, numbers.budget
    if not numbers.completed:
        return "No realisation completed, so the answer is unknown."
    if not numbers.is_random:
        return _same(numbers)
    width, level = whole.upper - whole.lower, f"{100.0 * answer.confidence:g} %"
    topic = asked.topic[0].upper() + asked.topic[1:]
    if width == 0.0:
        return f"{topic} is {words.supported(answer.value, width, asked.answer_unit)}."
    if asked.is_probability and answer.value in (0.0, 1.0):
        return _certain(numbers, topic, width, level)
    value = words.supported(answer.value, width, asked.answer_unit)
    if math.isinf(whole.lower) and math.isinf(whole.upper):
        return f"{topic} is {value}; so few simulations give no bounds."
    if math.isinf(whole.upper):
        return f"{topic} is {value}: with {level} confidence above {_bound(whole.lower, width, numbers)}."
    if math.isinf(whole.lower):
        return f"{topic} is {value}: with {level} confidence below {_bound(whole.upper, width, numbers)}."
    bounds = f"{_bound(whole.lower, width, numbers)} and {_bound(whole.upper, width, numbers)}"
    return f"{topic} is {value}: between {bounds} with {level} confidence."


def _same(numbers: Numbers) -> str:
    """Where all realisations are the same one."""
    asked = numbers.asked
    found = f"The {asked.noun} is {words.with_unit(numbers.running_mean.value[-1], asked.unit)}"
    if not asked.is_probability:
        return f"{found}."
    verb = "exceeds" if numbers.answer.value > 0.5 else "does not exceed"
    return f"{found}: it {verb} {asked.limit:g} {asked.unit}."


def _certain(numbers: Numbers, topic: str, width: float, level: str) -> str:
    """Where the estimate is 0 or 1: a bound, as it says nothing itself; and whether none or all did exceed."""
    none = numbers.answer.value == 0.0
    bound = numbers.budget.upper if none else numbers.budget.lower
    side, which, so_many = ("below", "none", 0) if none else ("above", "all", numbers.completed)
    found = f"{topic} is {side} {words.share(bound, width)} with {level} confidence"
    if numbers.beyond != so_many:  # coarser cells moved the estimate there
        return f"{found}."
    return f"{found}: {which} of {words.count(numbers.completed, SIMULATION)} did."


def _bound(value: float, width: float, numbers: Numbers) -> str:
    return words.supported(value, width, numbers.asked.answer_unit)


def certainty(numbers: Numbers, study) -> str:
    """Say which errors the bounds of the headline count."""
    if not numbers.completed:
        return ""
    if not numbers.is_random:
        return f"What the size of the cells ({study.discretisation.cell_m:g} m) adds is unknown."
    if numbers.budget.is_whole:
        return "The bounds count both the limited number of simulations and the size of the cells."
    why = "too few were simulated on coarser cells too" if numbers.coarser else "they were all of one size"
    return (
        "The bounds count the limited number of simulations alone. What the size of the cells "
        f"({study.discretisation.cell_m:g} m) adds is unknown: {why}."
    )


def basis(numbers: Numbers, study) -> str:
    """Say what the answer rests on."""
    failed = numbers.used - numbers.completed
    pattern = ", each with its own pattern of weak and strong soil" if numbers.is_random else ""
    sentence = f"{words.count(numbers.used, 'simulated slope')}{pattern}"
    if numbers.asked.is_probability and numbers.completed:
        exceed = "exceeds" if numbers.beyond == 1 else "exceed"
        sentence += f"; {numbers.beyond} of them {exceed} {numbers.asked.limit:g} {numbers.asked.unit}"
    if numbers.choice:
        sentence += f"; most of all were {numbers.choice}"
    if numbers.coarser:
        sentence += f"; {words.count(numbers.coarser, SIMULATION)} on coarser cells support them"
    if study.estimator is not None and study.estimator.sampling != "random":
        sentence += f"; their patterns are spread evenly ({study.estimator.sampling.replace('_', ' ')})"
    return f"{sentence}; {failed if failed else 'none'} failed to complete."


def details(numbers: Numbers) -> list[str]:
    """Say what else was found of the run-out.

    Args:
        numbers: of the report.

    Returns:
        Sentences; none where nothing completed.
    """
    if not numbers.completed:
        return []
    probability, mean, failing = numbers.exceedance, numbers.mean_run_out, numbers.failing
    median, p95 = numbers.quantiles["median"], numbers.quantiles["p95"]
    found = [
        f"The probability that the run-out exceeds {numbers.limit:g} m is {_share(probability)}.",
        f"The mean run-out is {_value(mean)}. Half of the slopes stay within {_value(median)}, 95 % of them within "
        f"{_value(p95)}.",
        f"Some soil fails with probability {_share(failing)}.",
    ]
    given = numbers.given_failure
    if numbers.failing.value > 0.0:
        found.append(
            f"If a slope fails, its run-out exceeds {numbers.limit:g} m with probability "
            f"{_share(given['exceedance'])}, and the median run-out is {_value(given['median'])}."
        )
    return found


def _share(estimate) -> str:
    width = estimate.upper - estimate.lower
    return f"{words.share(estimate.value, width)} ({words.share_interval(estimate)})"


def _value(estimate) -> str:
    width = estimate.upper - estimate.lower
    if math.isinf(estimate.upper) and math.isfinite(estimate.lower):
        value, lower = words.with_unit(estimate.value, "m"), words.with_unit(estimate.lower, "m")
        return f"{value} (more than {lower} with {100.0 * estimate.confidence:g} % confidence)"
    return f"{words.supported(estimate.value, width, 'm')} ({words.interval(estimate, 'm')})"


def warnings(numbers: Numbers, study) -> list[str]:
    """Say what weakens the answer.

    Args:
        numbers: of the report.
        study: the Study.

    Returns:
        Sentences.
    """
    return [sentence for sentence in (*_of_the_sample(numbers, study), *_of_its_members(numbers, study)) if sentence]


def _of_the_sample(numbers: Numbers, study):
    planned = study.study.realisations
    if planned is not None and numbers.used < planned and numbers.used == numbers.held:
        yield (
            f"This is a part of the study: realisations {numbers.first} to {numbers.first + numbers.used - 1} of "
            f"{planned}, counted from 0."
        )
    if numbers.used < numbers.held:
        yield (
            f"Of {numbers.held} realisations on record {numbers.used} are used, those before the first missing index: "
            "what is finished beyond it was finished because it was quick, and would bias the answer."
        )
    if not numbers.is_random:
        yield "Nothing is random in this study: all realisations are the same, and the bounds mean nothing."
    elif numbers.completed == 1:
        yield "A single completed realisation says next to nothing about a probability."
    elif numbers.asked.is_probability and numbers.completed > 1 and numbers.beyond < FEW:
        some = words.count(numbers.beyond, "simulation") if numbers.beyond else "no simulation"
        yield f"The answer rests on {some} beyond the limit: take the bounds, not the value, for a decision."


def _of_its_members(numbers: Numbers, study):
    failed, unfinished = numbers.used - numbers.completed, numbers.statuses.get("not_at_rest", 0)
    if failed and numbers.completed:
        yield (f"{words.count(failed, 'realisation')} of {numbers.used} did not complete; {_fate(numbers)}.")
    if numbers.censored:
        yield (
            f"In {words.count(numbers.censored, 'realisation')} the soil reached the far wall (censored): counted as "
            "exceeding every limit; the mean takes the distance to the wall and is therefore too low."
        )
    if numbers.at_back:
        yield (
            f"In {words.count(numbers.at_back, 'realisation')} of {numbers.completed} the failure reached the back of "
            f"the model{_crest(study)}: with more ground there it might have gone on and brought down more soil."
            f"{_as_bounds(numbers)}"
        )
    if unfinished:
        yield (
            f"{words.count(unfinished, 'realisation')} had not come to rest at the end of the simulated time; "
            "the values reached by then are used."
        )


def _fate(numbers: Numbers) -> str:
    """What becomes of the members that failed to complete."""
    them = "it" if numbers.used - numbers.completed == 1 else "them"
    if numbers.asked.limit is None and numbers.asked.quantile is None:
        return f"the mean leaves {them} out, whatever would have come"
    return f"the bounds count {them} both as exceeding and as not"


def _as_bounds(numbers: Numbers) -> str:
    """What becomes of these members where the quantity asked is cut short by that edge."""
    if "retrogression_censored" not in BOUNDED_BY[numbers.asked.quantity]:
        return ""
    if numbers.asked.limit is None and numbers.asked.quantile is None:
        return " The mean takes what was found and is therefore too low."
    return " They count as exceeding every value, so the curve does not come down to 0."


def _crest(study) -> str:
    return f", {study.geometry.crest_m:g} m behind the crest edge" if study.geometry.kind == "slope" else ""
