"""Charts of probability: exceedance curve, histograms, convergence and inundation."""

from collections.abc import Iterator

import numpy as np

from rfmpm.estimators.curves import Band
from rfmpm.report import words
from rfmpm.report.numbers import CONFIDENCE, SPREAD, Numbers
from rfmpm.report.style import BLUE, CHART, GREY, ORANGE, VERMILION, Picture, drawing, encode, new_figure

LEVEL = f"{100 * CONFIDENCE:g} %"


def charts(rows, numbers: Numbers) -> dict[str, list[Picture]]:
    """Draw every chart that the rows allow.

    Args:
        rows: the rows the estimates rest on, an xarray.Dataset.
        numbers: what `analyse` made of them.

    Returns:
        Pictures by section: exceedance, spread, convergence, inundation; a section without data is empty.
    """
    with drawing():
        completed, several = numbers.completed > 0, numbers.completed > 1
        return {
            "exceedance": [_exceedance(numbers)] if completed else [],
            "spread": list(_histograms(rows)),
            "convergence": [_running_mean(numbers), _running_exceedance(numbers)] if several else [],
            "inundation": [_inundation(numbers)] if completed and numbers.inundation is not None else [],
        }


def _exceedance(numbers: Numbers) -> Picture:
    curve = numbers.curve
    figure = new_figure(*CHART)
    axes = figure.add_subplot()
    axes.fill_between(
        curve.at,
        curve.simultaneous_lower,
        curve.simultaneous_upper,
        step="post",
        color=BLUE,
        alpha=0.13,
        lw=0,
        label=f"{LEVEL} band, whole curve",
    )
    axes.fill_between(
        curve.at, curve.lower, curve.upper, step="post", color=BLUE, alpha=0.28, lw=0, label=f"{LEVEL} band, each point"
    )
    axes.step(curve.at, curve.value, where="post", color=BLUE, label="estimate")
    _mark(axes, numbers.limit, f"{numbers.limit:g} m", "--")
    axes.set(xlabel="limit l [m]", ylabel="P(run-out > l)", xlim=(curve.at[0], curve.at[-1]), ylim=(-0.02, 1.02))
    _legend_below(figure)
    return Picture(
        "Probability that run-out exceeds a limit",
        encode(figure),
        "Falling step curve of the probability that run-out exceeds a limit, with two bands. "
        f"At {numbers.limit:g} m it is {words.share(numbers.exceedance.value)}.",
        "Read it upwards from a distance. The dark band (Clopper-Pearson) holds the true probability at one distance "
        f"with {LEVEL} confidence, the light band (Dvoretzky-Kiefer-Wolfowitz) at all distances at once. "
        "The dashed line is the limit of the study.",
    )


def _histograms(rows) -> Iterator[Picture]:
    for name in SPREAD:
        values = rows[name].values
        values = values[~np.isnan(values)]
        if values.size and np.ptp(values) > 0.0:
            yield _histogram(values, _label(name), _unit(rows[name]), _lower_bounds(rows, name))


def unvarying(rows) -> list[str]:
    """Say which quantities need no histogram, as they are the same in all completed realisations.

    Args:
        rows: the rows the estimates rest on, an xarray.Dataset.

    Returns:
        A sentence for each.
    """
    sentences = []
    for name in SPREAD:
        values = rows[name].values
        values = values[~np.isnan(values)]
        if values.size and np.ptp(values) == 0.0:
            value = words.with_unit(values[0], _unit(rows[name]))
            sentences.append(f"{_label(name).capitalize()}: {value} in {_every(values.size)}.")
    return sentences


def _every(n: int) -> str:
    return "the one completed realisation" if n == 1 else f"each of {n} completed realisations"


def _label(name: str) -> str:
    return name.replace("_", " ").replace("run out", "run-out")


def _lower_bounds(rows, name: str) -> int:
    """How many values are lower bounds, because the soil met the edge of the domain."""
    flag = f"{name.removesuffix('_distance')}_censored"
    return int(np.nansum(rows[flag].values)) if flag in rows else 0


def _histogram(values: np.ndarray, label: str, unit: str, bounds: int) -> Picture:
    edges = np.histogram_bin_edges(values, bins="auto")
    if edges.size > 41:  # a few far values make the rule ask for hundreds
        edges = np.linspace(edges[0], edges[-1], 41)
    figure = new_figure(*CHART)
    axes = figure.add_subplot()
    axes.hist(values, bins=edges, color=BLUE, edgecolor="white", linewidth=0.8)
    _mark(axes, values.mean(), f"mean {words.number(values.mean())}", "-")
    axes.yaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    axes.grid(axis="x", visible=False)
    axes.set(xlabel=f"{label} [{unit}]", ylabel="realisations")
    still = int(np.sum(values == 0.0))
    censored = f" {bounds} met the edge of the domain and are lower bounds." if bounds else ""
    return Picture(
        label.capitalize(),
        encode(figure),
        f"Histogram of {label}: from {words.number(values.min())} to {words.number(values.max())} {unit}, "
        f"mean {words.number(values.mean())} {unit}.",
        f"{words.count(values.size, 'completed realisation')}, {still} of them exactly zero.{censored}",
    )


def _running_mean(numbers: Numbers) -> Picture:
    band = numbers.running_mean
    figure, axes = _convergence(band)
    # The band of the first few realisations would dwarf all the rest: it may leave the picture.
    settled = (band.at > 0.1 * band.at[-1]) & np.isfinite(band.lower)
    shown = np.concatenate([band.value, band.lower[settled], band.upper[settled]])
    low, high = np.nanmin(shown), np.nanmax(shown)
    margin = max(0.08 * (high - low), 0.1)
    axes.set(ylabel="mean run-out [m]", ylim=(low - margin, high + margin))
    return Picture(
        "Mean run-out as realisations are added",
        encode(figure),
        f"Line of the mean run-out against the number of realisations, ending at {words.number(band.value[-1])} "
        "metres, with a band that narrows.",
        f"Band: {LEVEL} Student t interval; it assumes that the mean of so many values is normally distributed. "
        "The band of the first few may leave the picture.",
    )


def _running_exceedance(numbers: Numbers) -> Picture:
    band = numbers.running_exceedance
    figure, axes = _convergence(band)
    axes.set(ylabel=f"P(run-out > {numbers.limit:g} m)", ylim=(-0.02, 1.02))
    return Picture(
        "Probability as realisations are added",
        encode(figure),
        f"Line of the probability that run-out exceeds {numbers.limit:g} metres against the number of realisations, "
        f"ending at {words.share(numbers.exceedance.value)}, with a band that narrows.",
        f"Band: {LEVEL} Clopper-Pearson interval at each number of realisations, failed ones counted both ways.",
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
    axes.set(xlabel="distance beyond the toe [m]", ylabel="P(inundated)", ylim=(-0.02, 1.02))
    axes.set_xlim(0.0, band.at[-1])
    _legend_below(figure)
    half = band.at[band.value >= 0.5]
    reach = (
        f"It is at least one half up to {words.number(half[-1])} m" if half.size else "It is below one half throughout"
    )
    return Picture(
        "Probability that a place is inundated",
        encode(figure),
        f"Probability of inundation against distance beyond the toe, with a band. {reach}.",
        f"A place counts as inundated where at least {numbers.inundation_depth:g} m of soil lies at the end. "
        "Band: Clopper-Pearson at each distance.",
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
    figure.legend(loc="outside lower center", ncols=3, handlelength=1.4, columnspacing=1.4)


def _unit(variable) -> str:
    """Unit for an axis: 'm3 m-1' reads 'm³/m'."""
    return {"m3 m-1": "m³/m"}.get(variable.attrs.get("units", ""), variable.attrs.get("units", ""))
