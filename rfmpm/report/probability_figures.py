"""Charts of probability: the answer on its exceedance curve, inundation and convergence."""

import math

import numpy as np

from rfmpm.estimators.curves import Band
from rfmpm.report import words
from rfmpm.report.histograms import histograms
from rfmpm.report.numbers import CONFIDENCE, Numbers
from rfmpm.report.style import (
    BLUE,
    CHART,
    CHART_DOTS_PER_INCH,
    GREY,
    ORANGE,
    VERMILION,
    Picture,
    drawing,
    encode,
    new_figure,
)

LEVEL = f"{100 * CONFIDENCE:g} %"
BEYOND = {"run_out": "distance beyond the toe [m]"}  # of other quantities: the quantity itself


def charts(rows, numbers: Numbers) -> dict[str, list[Picture]]:
    """Draw every chart that the rows allow.

    Args:
        rows: the rows the estimates rest on, an xarray.Dataset.
        numbers: what `analyse` made of them.

    Returns:
        Pictures by section: exceedance, spread, convergence, inundation; a section without data is empty.
    """
    with drawing():
        completed = numbers.completed > 0
        varied, several = completed and numbers.is_random, numbers.completed > 1 and numbers.is_random
        return {
            "exceedance": [_exceedance(numbers)] if varied else [],
            "spread": list(histograms(rows)),
            "convergence": _convergences(numbers) if several else [],
            "inundation": [_inundation(numbers)] if completed and numbers.inundation is not None else [],
        }


def _convergences(numbers: Numbers) -> list[Picture]:
    if numbers.settling is not None:
        return [_settling(numbers)]
    found = [_running_mean(numbers)]
    return found if numbers.running_exceedance is None else [_running_exceedance(numbers), *found]


def _exceedance(numbers: Numbers) -> Picture:
    curve, asked = numbers.curve, numbers.asked
    figure = new_figure(*CHART)
    axes = figure.add_subplot()
    bands = [
        (curve.simultaneous_lower, curve.simultaneous_upper, 0.13, f"{LEVEL} band, whole curve"),
        (curve.lower, curve.upper, 0.28, f"{LEVEL} band, each point"),
    ]
    for lower, upper, alpha, label in bands:
        if lower is not None:
            axes.fill_between(curve.at, lower, upper, step="post", color=BLUE, alpha=alpha, lw=0, label=label)
    axes.step(curve.at, curve.value, where="post", color=BLUE, label="estimate")
    _mark_answer(axes, numbers)
    label = BEYOND.get(asked.quantity, f"{asked.noun} [{asked.unit}]")
    axes.set(xlabel=label, ylabel="probability of exceeding it", xlim=(curve.at[0], curve.at[-1]), ylim=(-0.02, 1.02))
    _legend_below(figure)
    one = "band holds the true probability at one value"
    both = f"dark {one}, the light band the whole curve" if curve.simultaneous_lower is not None else one
    return Picture(
        f"Probability that the {asked.noun} exceeds a value",
        encode(figure, CHART_DOTS_PER_INCH),
        f"Falling curve of the probability that the {asked.noun} exceeds a value, with bands. "
        f"The answer is marked: {words.number(numbers.answer.value)}{' ' if asked.answer_unit else ''}"
        f"{asked.answer_unit}.",
        f"With {LEVEL} confidence the {both}. Marked is the answer with its bounds.",
    )


def _mark_answer(axes, numbers: Numbers) -> None:
    """The answer as a point, or a line, with the bounds of the whole error."""
    asked, whole, value = numbers.asked, numbers.budget, numbers.answer.value
    if math.isnan(value):
        return
    if asked.is_probability:
        at, level = asked.limit, value
        _mark(axes, at, f"{at:g} {asked.unit}", "--")
        axes.errorbar([at], [level], [[level - whole.lower], [whole.upper - level]], **_point())
        return
    _mark(axes, value, words.supported(value, whole.upper - whole.lower, asked.unit), "--")
    if math.isfinite(whole.upper - whole.lower):
        axes.axvspan(whole.lower, whole.upper, color=VERMILION, alpha=0.15, lw=0)
    if asked.quantile is not None:
        axes.axhline(1.0 - asked.quantile, color=VERMILION, lw=1.0, ls=":")


def _point() -> dict:
    return {"fmt": "o", "color": VERMILION, "ms": 6, "capsize": 4, "lw": 1.8, "zorder": 5, "clip_on": False}


def _running_mean(numbers: Numbers) -> Picture:
    band, asked = numbers.running_mean, numbers.asked
    figure, axes = _convergence(band)
    # The band of the first few realisations would dwarf all the rest: it may leave the picture.
    settled = (band.at > 0.1 * band.at[-1]) & np.isfinite(band.lower)
    shown = np.concatenate([band.value, band.lower[settled], band.upper[settled]])
    low, high = np.nanmin(shown), np.nanmax(shown)
    margin = max(0.08 * (high - low), 0.1)
    axes.set(ylabel=f"mean {asked.noun} [{asked.unit}]", ylim=(low - margin, high + margin))
    return Picture(
        f"Mean {asked.noun} as realisations are added",
        encode(figure, CHART_DOTS_PER_INCH),
        f"Line of the mean {asked.noun} against the number of realisations, ending at {words.number(band.value[-1])} "
        f"{asked.unit}, with a band that narrows.",
        f"Band: {LEVEL} Student t interval; it assumes that the mean of so many values is normally distributed. "
        "The band of the first few may leave the picture.",
    )


def _running_exceedance(numbers: Numbers) -> Picture:
    band, asked = numbers.running_exceedance, numbers.asked
    figure, axes = _convergence(band)
    axes.set(ylabel=f"P({asked.noun} > {asked.limit:g} {asked.unit})", ylim=(-0.02, 1.02))
    return Picture(
        "Probability as realisations are added",
        encode(figure, CHART_DOTS_PER_INCH),
        f"Line of the probability that the {asked.noun} exceeds {asked.limit:g} {asked.unit} against the number of "
        f"realisations, ending at {words.share(band.value[-1])}, with a band that narrows.",
        f"Band: {LEVEL} Clopper-Pearson interval at each number of realisations, failed ones counted both ways.",
    )


def _settling(numbers: Numbers) -> Picture:
    band, asked = numbers.settling, numbers.asked
    figure, axes = _convergence(band)
    unit = asked.answer_unit
    axes.set(xlabel="realisations on the study's own cells", ylabel=f"answer [{unit}]" if unit else "probability")
    if asked.is_probability:
        axes.set_ylim(-0.02, 1.02)
    coarser = "Those on coarser cells are added in the same proportion. " if numbers.coarser else ""
    last = words.supported(float(band.value[-1]), float(band.upper[-1] - band.lower[-1]), unit)
    return Picture(
        "The answer as realisations are added",
        encode(figure, CHART_DOTS_PER_INCH),
        f"Line of the answer against the number of realisations on the study's own cells, ending at {last}, with a "
        "band that narrows.",
        f"{coarser}Band: {LEVEL} interval of the estimator.",
    )


def _convergence(band: Band):
    figure = new_figure(*CHART)
    axes = figure.add_subplot()
    axes.fill_between(band.at, band.lower, band.upper, color=BLUE, alpha=0.2, lw=0, label=f"{LEVEL} interval")
    axes.plot(band.at, band.value, color=BLUE, label="estimate")
    axes.axhline(band.value[-1], color=GREY, lw=0.8, ls=":")
    axes.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    axes.set(xlabel="number of realisations", xlim=(1, band.at[-1]))
    _legend_below(figure)
    return figure, axes


def _inundation(numbers: Numbers) -> Picture:
    band = numbers.inundation
    figure = new_figure(*CHART)
    axes = figure.add_subplot()
    axes.fill_between(band.at, band.lower, band.upper, color=ORANGE, alpha=0.3, lw=0, label=f"{LEVEL} band, each point")
    axes.plot(band.at, band.value, color=VERMILION, label="estimate")
    axes.set(xlabel="distance beyond the toe [m]", ylabel="probability of soil arriving", ylim=(-0.02, 1.02))
    axes.set_xlim(0.0, band.at[-1])
    _legend_below(figure)
    half = band.at[band.value >= 0.5]
    reach = (
        f"It is at least one half up to {words.number(half[-1])} m" if half.size else "It is below one half throughout"
    )
    return Picture(
        "Probability that a place is inundated",
        encode(figure, CHART_DOTS_PER_INCH),
        f"Probability of inundation against distance beyond the toe, with a band. {reach}.",
        f"A place counts as inundated where at least {numbers.inundation_depth:g} m of soil lies at the end. "
        f"{reach} beyond the toe. Band: Clopper-Pearson at each distance.",
    )


def _mark(axes, x: float, text: str, style: str) -> None:
    axes.axvline(x, color=VERMILION, lw=1.4, ls=style)
    axes.annotate(
        text,
        (x, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(0, 3),
        textcoords="offset points",
        ha="center",
        va="bottom",
        color=VERMILION,
        fontsize=9,
    )


def _legend_below(figure) -> None:
    figure.legend(loc="outside lower center", ncols=3, handlelength=1.2, columnspacing=1.0)
