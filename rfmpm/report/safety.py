"""What a factor of safety says beside what the simulation shows: who fails by which."""

from dataclasses import dataclass

import numpy as np

from rfmpm import estimators


@dataclass(frozen=True)
class Safety:
    """Realisations by whether soil failed and whether their factor of safety is below 1, and both probabilities."""

    both: int
    simulation_alone: int  # fails, although its factor of safety is 1 or more
    factor_alone: int  # stays, although its factor of safety is below 1
    neither: int
    below_one: estimators.Estimate  # P(factor of safety < 1) [-]
    failing: estimators.Estimate  # P(any soil fails) [-]


def safety(rows, confidence: float) -> Safety | None:
    """Compare the two, where the dataset holds factors of safety.

    Args:
        rows: the rows the estimates rest on.
        confidence: level of the Clopper-Pearson intervals [-].

    Returns:
        Safety; its counts are of the realisations for which both are known. None without factors.
    """
    if "factor_of_safety" not in rows:
        return None
    factor, volume = rows["factor_of_safety"].values, rows["failure_volume"].values
    known = ~np.isnan(factor) & ~np.isnan(volume)
    below, fails = factor[known] < 1.0, volume[known] > 0.0
    indicator = np.where(np.isnan(factor), np.nan, factor < 1.0)
    return Safety(
        both=int(np.sum(below & fails)),
        simulation_alone=int(np.sum(~below & fails)),
        factor_alone=int(np.sum(below & ~fails)),
        neither=int(np.sum(~below & ~fails)),
        below_one=estimators.exceedance(indicator, 0.5, None, confidence),
        failing=estimators.exceedance(volume, 0.0, None, confidence),
    )
