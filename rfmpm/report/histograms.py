"""How the quantities of the slopes that fail spread."""

from collections.abc import Iterator

import numpy as np

from rfmpm.planning.questions import NOUNS
from rfmpm.report import words
from rfmpm.report.asked import Asked
from rfmpm.report.members import censored_members
from rfmpm.report.style import BLUE, CHART, CHART_DOTS_PER_INCH, VERMILION, Picture, encode, new_figure

SPREAD = ("run_out", "failure_volume", "retrogression_distance")
MOST_BINS = 40


def histograms(rows) -> Iterator[Picture]:
    """Draw a histogram of each quantity over the realisations that fail; of one that is the same in all of them none.

    Args:
        rows: the rows the estimates rest on, an xarray.Dataset.
    """
    for name in SPREAD:
        values, fails = _of_failing(rows, name)
        if values.size and np.ptp(values) > 0.0:
            yield _histogram(values, name, int(np.sum(censored_members(rows, name) & fails)), _completed(rows))


def unvarying(rows) -> list[str]:
    """Say which quantities need no histogram, as they are the same in all realisations that fail.

    Args:
        rows: the rows the estimates rest on, an xarray.Dataset.

    Returns:
        A sentence for each; one for all where no realisation fails.
    """
    completed, sentences = _completed(rows), []
    if completed and not _of_failing(rows, SPREAD[0])[0].size:
        return [f"No soil fails in {_every(completed, 'completed realisation')}."]
    for name in SPREAD:
        values, _ = _of_failing(rows, name)
        if values.size and np.ptp(values) == 0.0:
            value = words.with_unit(values[0], Asked(name).unit)
            sentences.append(f"{_title(name)}: {value} in {_every(values.size, 'realisation that fails')}.")
    return sentences


def _of_failing(rows, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Values of the realisations that completed and failed, and which these are."""
    fails = rows["failure_volume"].values > 0.0
    return rows[name].values[fails], fails


def _completed(rows) -> int:
    return int(np.sum(~np.isnan(rows["failure_volume"].values)))


def _every(n: int, noun: str) -> str:
    return f"the one {noun}" if n == 1 else f"each of {n} {noun.replace('realisation', 'realisations')}"


def _title(name: str) -> str:
    return NOUNS[name][0].upper() + NOUNS[name][1:]


def _histogram(values: np.ndarray, name: str, bounds: int, completed: int) -> Picture:
    label, unit = NOUNS[name], Asked(name).unit
    edges = np.histogram_bin_edges(values, bins="auto")
    if edges.size > MOST_BINS + 1:  # a few far values make the rule ask for hundreds
        edges = np.linspace(edges[0], edges[-1], MOST_BINS + 1)
    figure = new_figure(*CHART)
    axes = figure.add_subplot()
    axes.hist(values, bins=edges, color=BLUE, edgecolor="white", linewidth=0.8)
    axes.axvline(np.median(values), color=VERMILION, lw=1.4)
    axes.set_title(f"median {words.number(np.median(values))} {unit}", color=VERMILION, fontsize=9)
    axes.yaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    axes.grid(axis="x", visible=False)
    axes.set(xlabel=f"{label} [{unit}]", ylabel="slopes that fail")
    censored = f" {bounds} of them met an edge of the model and are lower bounds." if bounds else ""
    return Picture(
        _title(name),
        encode(figure, CHART_DOTS_PER_INCH),
        f"Histogram of the {label} of slopes that fail: from {words.number(values.min())} to "
        f"{words.number(values.max())} {unit}, median {words.number(np.median(values))} {unit}.",
        f"{values.size} of {words.count(completed, 'completed realisation')} fail and are shown.{censored}",
    )
