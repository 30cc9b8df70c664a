"""How the slopes failed: the share of each kind of failure, and a typical member of each."""

from dataclasses import dataclass

import numpy as np

from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.failure_modes import MODES
from rfmpm.report.members import flagged

NAMES = {
    "no_failure": "No failure",
    "rotational": "Rotational slide",
    "translational": "Translational slide",
    "superficial": "Superficial slide",
    "earthflow": "Earthflow",
    "retrogressive": "Retrogressive slides",
    "spread": "Spread",
}
MEANINGS = {
    "no_failure": "no soil moves further than the threshold of failure",
    "rotational": "one mass stays together, on no plane: as a rule it turns on a curved slip surface",
    "translational": "one mass goes down together on a plane, even if it breaks up on the way",
    "superficial": "a thin skin goes down on a plane",
    "earthflow": "nearly all that fails loses its shape",
    "retrogressive": "one slide after the other, each behind the last",
    "spread": "the ground breaks into ridges with subsided ground between them, over a nearly level band",
}


@dataclass(frozen=True)
class Mode:
    """One kind of failure among the realisations."""

    name: str
    count: int
    at_edge: int  # of them, how many met an edge of the model and might have gone on
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
        The kinds in the order of MODES; none of a dataset of a version that did not tell them.
    """
    if "failure_mode" not in rows:
        return []
    codes, edge = rows["failure_mode"].values, flagged(rows, "run_out_censored", "retrogression_censored")
    run_out, index = rows["run_out"].values, rows["realisation"].values
    unknown = int(np.sum(np.isnan(codes.astype(float))))
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
        at_edge = int(edge[members].sum())
        found.append(Mode(name, members.size, at_edge, share, float(lower), float(upper), typical, reached))
    return found
