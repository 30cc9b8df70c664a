"""How the slopes failed: the share of each kind of failure, and a typical member of each."""

from dataclasses import dataclass

import numpy as np

from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.quantities.failure_mode import MODES, UNKNOWN, failure_modes
from rfmpm.report.members import flagged

NAMES = {
    "no_failure": "No failure",
    "single_slide": "Single slide",
    "retrogressive": "Retrogressive",
    "reaches_boundary": "Reaches the edge of the model",
}
MEANINGS = {
    "no_failure": "no soil moves further than the threshold of failure",
    "single_slide": "one mass slides and stays in one piece, or flows apart altogether",
    "retrogressive": "fails in stages: what fails after the first slide adds more than a tenth to it, or the failed "
    "mass ends in two or more blocks that stayed whole",
    "reaches_boundary": "the failure meets the back or the front of the model and might have gone on",
}


@dataclass(frozen=True)
class Mode:
    """One kind of failure among the realisations."""

    name: str
    count: int
    value: float  # share of the completed realisations [-]
    lower: float  # of its probability, failed realisations counted both ways [-]
    upper: float
    typical: int | None  # realisation with the median run-out among them
    run_out: float  # of that one [m]


def modes(rows, confidence: float) -> list[Mode]:
    """Count the kinds of failure.

    Args:
        rows: the rows the estimates rest on.
        confidence: level of the Clopper-Pearson intervals, each for itself [-].

    Returns:
        The four kinds in the order of MODES; none of a dataset that lacks what they are told from.
    """
    needed = ("failure_volume", "initial_failure_volume", "block_count")
    if any(name not in rows for name in needed):
        return []
    edge = flagged(rows, "run_out_censored", "retrogression_censored")
    codes = failure_modes(*(rows[name].values for name in needed), edge)
    run_out, index = rows["run_out"].values, rows["realisation"].values
    unknown = int(np.sum(codes == UNKNOWN))
    found = []
    for code, name in enumerate(MODES):
        members = np.flatnonzero(codes == code)
        lower, _ = clopper_pearson(members.size, codes.size, confidence)
        _, upper = clopper_pearson(members.size + unknown, codes.size, confidence)
        share = members.size / (codes.size - unknown) if codes.size > unknown else float("nan")
        typical, reached = None, float("nan")
        if members.size:
            at = members[np.argsort(run_out[members], kind="stable")[(members.size - 1) // 2]]
            typical, reached = int(index[at]), float(run_out[at])
        found.append(Mode(name, members.size, share, float(lower), float(upper), typical, reached))
    return found
