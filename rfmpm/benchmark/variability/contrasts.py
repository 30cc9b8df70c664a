"""Which differences the study is sure of: pairs of the same random numbers, with the many comparisons allowed for."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rfmpm.benchmark.variability.campaigns import Grid
from rfmpm.benchmark.variability.summary import CONFIDENCE, each_cell, outcomes
from rfmpm.estimators import Estimate, exceedance_difference, mean, mean_difference

if TYPE_CHECKING:
    import xarray as xr


class Contrast(NamedTuple):
    """One difference of a family of them."""

    here: dict[str, float]  # the combination
    there: dict[str, float]  # the one it is compared with; empty for a slope of one strength
    estimate: Estimate  # with its own 95 % interval
    is_secure: bool  # 0 lies outside of the interval that allows for the whole family


Compare = Callable[["xr.Dataset", "xr.Dataset", float], Estimate]  # two cells, confidence


def mean_of(quantity: str) -> Compare:
    """Compare the mean of a quantity."""

    def compare(here: "xr.Dataset", there: "xr.Dataset", confidence: float) -> Estimate:
        return mean_difference(outcomes(here, quantity)[0], outcomes(there, quantity)[0], confidence)

    return compare


def probability_beyond(quantity: str, limit: float) -> Compare:
    """Compare the probability that a quantity exceeds a limit."""

    def compare(here: "xr.Dataset", there: "xr.Dataset", confidence: float) -> Estimate:
        (one, one_censored), (other, other_censored) = outcomes(here, quantity), outcomes(there, quantity)
        return exceedance_difference(one, other, limit, one_censored, other_censored, confidence)

    return compare


def against(found: "xr.Dataset", dimension: str, reference: float, compare: Compare) -> list[Contrast]:
    """Compare every combination with the one that has the reference along a dimension and is otherwise the same.

    Args:
        found: dataset of the study.
        dimension: along which the two differ.
        reference: value of that dimension.
        compare: what is compared.

    Returns:
        One difference for each combination that does not have the reference itself. `is_secure` is by Bonferroni: the
        chance that any of these is called secure where nothing differs is at most 5 %.
    """
    pairs = [
        (cell, there)
        for there in each_cell(found.sel({dimension: [reference]}))
        for cell in each_cell(found.sel({name: [float(there[name])] for name in Grid._fields if name != dimension}))
        if float(cell[dimension]) != reference
    ]
    family = 1.0 - (1.0 - CONFIDENCE) / len(pairs)
    return [
        Contrast(place(here), place(there), compare(here, there, CONFIDENCE), _excludes_0(compare(here, there, family)))
        for here, there in pairs
    ]


def against_uniform(found: "xr.Dataset", quantity: str) -> list[Contrast]:
    """Compare the mean of a quantity in every combination with the slope that has the mean strength everywhere."""
    combinations = list(each_cell(found))
    family = 1.0 - (1.0 - CONFIDENCE) / len(combinations)
    contrasts = []
    for cell in combinations:
        difference = outcomes(cell, quantity)[0] - float(cell[f"{quantity}_uniform"].sel(strength="mean"))
        is_secure = _excludes_0(mean(difference, family))
        contrasts.append(Contrast(place(cell), {}, mean(difference, CONFIDENCE), is_secure))
    return contrasts


def main_effects(found: "xr.Dataset", outcome: Callable[["xr.Dataset"], np.ndarray]) -> list[Contrast]:
    """Compare each value along each dimension with the first one, on average over all that the others may be.

    The average is taken realisation by realisation, so that these, which are independent, give the interval.

    Args:
        found: dataset of the study.
        outcome: number of every realisation of a cell, shape (n,); NaN where it failed.

    Returns:
        One difference for each value but the first of each dimension; both its places name that dimension alone.
    """
    chosen = [(name, float(value)) for name in Grid._fields for value in found[name].values[1:]]
    family, contrasts = 1.0 - (1.0 - CONFIDENCE) / len(chosen), []
    for name, value in chosen:
        first = float(found[name][0])
        here, there = (
            np.mean([outcome(cell) for cell in each_cell(found.sel({name: [along]}))], axis=0)
            for along in (value, first)
        )
        contrasts.append(
            Contrast(
                {name: value},
                {name: first},
                mean_difference(here, there, CONFIDENCE),
                _excludes_0(mean_difference(here, there, family)),
            )
        )
    return contrasts


def effects(found: "xr.Dataset", limit: float) -> dict[str, list[Contrast]]:
    """Main effects on the mean of each quantity and on P(run-out > limit), by what they are of."""
    return {
        "mean run-out [m]": main_effects(found, lambda cell: outcomes(cell, "run_out")[0]),
        f"P(run-out > {limit:g} m)": main_effects(found, lambda cell: exceeds(cell, "run_out", limit)),
        "mean retrogression [m]": main_effects(found, lambda cell: outcomes(cell, "retrogression_distance")[0]),
        "mean volume [m³/m]": main_effects(found, lambda cell: outcomes(cell, "failure_volume")[0]),
    }


def exceeds(cell: "xr.Dataset", quantity: str, limit: float) -> np.ndarray:
    """1 where a quantity exceeds a limit, 0 where it does not, NaN where it failed; shape (n,)."""
    values, censored = outcomes(cell, quantity)
    return np.where(np.isnan(values), np.nan, (values > limit) | censored)


def _excludes_0(estimate: Estimate) -> bool:
    return estimate.lower > 0.0 or estimate.upper < 0.0


def place(cell: "xr.Dataset") -> dict[str, float]:
    """The combination that a cell is."""
    return {name: float(cell[name]) for name in Grid._fields}


def correlations(found: "xr.Dataset", dimension: str, reference: float, quantity: str) -> Iterator[float]:
    """Correlation of a quantity between the members of each pair that `against` compares; not where one is constant."""
    for there in each_cell(found.sel({dimension: [reference]})):
        for here in each_cell(found.sel({name: [float(there[name])] for name in Grid._fields if name != dimension})):
            one, other = outcomes(here, quantity)[0], outcomes(there, quantity)[0]
            both = np.isfinite(one) & np.isfinite(other)
            if float(here[dimension]) != reference and np.ptp(one[both]) > 0.0 and np.ptp(other[both]) > 0.0:
                yield float(np.corrcoef(one[both], other[both])[0, 1])
