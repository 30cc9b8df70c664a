"""The answer in three lines, for the end of a campaign."""

from rfmpm.report import words
from rfmpm.report.numbers import Numbers, analyse

LABEL = 18  # width of the first column
VALUE = 8  # width of the second


def summary_lines(dataset, study) -> list[str]:
    """Write the answer of a study in three lines: mean run-out, probability of exceeding the limit, cost.

    Args:
        dataset: the ensemble, an xarray.Dataset as `open_ensemble` gives it.
        study: its Study.

    Returns:
        Three lines of text.
    """
    numbers = analyse(dataset, study)
    mean, probability = numbers.mean_run_out, numbers.exceedance
    realisations = words.count(numbers.used, "realisation")
    censored = f", {numbers.censored} censored counted as exceeding" if numbers.censored else ""
    return [
        _line("mean run-out", words.with_unit(mean.value, "m"), f"{words.interval(mean, 'm')}, {realisations}"),
        _line(
            f"P(run-out > {numbers.limit:g} m)",
            words.share(probability.value),
            f"{words.share_interval(probability)}{censored}",
        ),
        _line("cost", words.duration(numbers.cost["computing"]), _cost(numbers)),
    ]


def _line(label: str, value: str, remark: str) -> str:
    return f"{label:{LABEL - 2}}  {value:{VALUE - 2}}  ({remark})"


def _cost(numbers: Numbers) -> str:
    parts = [f"computing time, {words.duration(numbers.cost['per_realisation'])} per realisation"]
    if "elapsed" in numbers.cost:
        parts.append(f"{words.duration(numbers.cost['elapsed'])} from start to end")
    parts.append(f"{numbers.used - numbers.completed} of {numbers.used} failed")
    return "; ".join(parts)
