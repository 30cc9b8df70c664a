"""What came of a case: done, stopped or refused for the right reason; anything else is a failure."""

import time
from dataclasses import dataclass
from math import inf, nan, sqrt

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.stability.case import Case
from rfmpm.kernel_tools import Tensor, at
from rfmpm.mpm.protocols import update_stress
from rfmpm.mpm.scene import GRAVITY, domain_size, release
from rfmpm.outcome import Outcome
from rfmpm.realisation import Prepared
from rfmpm.study import StudyError
from rfmpm.variables import FAILED

DONE, OPEN, STOPPED, REFUSED, UNBALANCED, FAIL = KINDS = ("done", "open", "stopped", "refused", "unbalanced", "FAIL")
FAILURES = (UNBALANCED, FAIL)
CLOSED = 0.005  # energy not accounted for, as a share, up to which a balance counts as closed
TOO_FAR_OPEN = 0.05
SMALLER_STEP, LONGER_FORELAND = 0.25, 12.0  # factors with which the advice of a stopped run is put to the test
NO_FALL = 1e-9  # [m] of the whole body: no work to speak of
YIELD_TOLERANCE = 1e-6  # of the stress; rounding of the return to the yield surface is some 1e-15


@dataclass(frozen=True)
class Verdict:
    """What came of a case."""

    kind: str  # one of KINDS
    words: str  # reason of a stop or refusal, faults of a failure
    balance_error: float = nan  # share, see `balance_error`
    seconds: float = nan


def judge(case: Case) -> Verdict:
    """Run a case and judge it; what the run raises is not caught here."""
    started = time.perf_counter()
    try:
        study = case.study()
    except StudyError as error:
        is_right = case.refusal and all(case.refusal in problem for problem in error.problems)
        return Verdict(REFUSED if is_right else FAIL, str(error))
    outcome, prepared = _run(case, study)
    verdict = _verdict(case, study, outcome, prepared)
    return Verdict(*verdict, balance_error(outcome, prepared), time.perf_counter() - started)


def _run(case: Case, study) -> tuple[Outcome, Prepared]:
    prepared = realisation.prepare(study)
    if case.arrange is not None:
        prepared = case.arrange(prepared)
    with np.errstate(all="ignore"):
        return realisation.simulate(prepared, case.index), prepared


def _verdict(case: Case, study, outcome: Outcome, prepared: Prepared) -> tuple[str, str]:
    if outcome.status in FAILED:
        if case.may_stop or _advice_helps(case, study, outcome.reason):
            return STOPPED, outcome.reason
        return FAIL, f"{outcome.reason}: neither helps"
    if found := faults(outcome, prepared):
        return FAIL, f"undetected: {'; '.join(found)}"
    error = abs(balance_error(outcome, prepared))
    if not error <= TOO_FAR_OPEN:
        return UNBALANCED, f"energy balance open by {100 * error:.3g} %"
    return (DONE if error <= CLOSED else OPEN), outcome.reason


def _advice_helps(case: Case, study, reason: str) -> bool:
    """Run again as the reason of a stop says: with smaller steps, or with a longer foreland where it names that."""
    advice = {"time.step_fraction": SMALLER_STEP * study.time.step_fraction}
    if "geometry.foreland_m" in reason:
        advice = {"geometry.foreland_m": LONGER_FORELAND * study.geometry.foreland_m}
    outcome, prepared = _run(case, study.with_changes(advice))
    return outcome.status not in FAILED and not faults(outcome, prepared)


def balance_error(outcome: Outcome, prepared: Prepared) -> float:
    """Energy that does not close or that the numerics added, as a share of gravity's work.

    Of the elastic energy at the start if that is more: a slope that only rings under its own weight takes next to no
    work from gravity; a share of that says nothing. A body that lies still without stress has no energy to account for.
    """
    points, mass = outcome.points, prepared.scene.points.mass
    work = abs(GRAVITY * np.sum(mass * (points["y_initial"] - points["y"])))
    whole = max(work, prepared.scene.controls.energy_scale)
    if whole < NO_FALL * GRAVITY * np.sum(mass):
        return 0.0
    added = max(0.0, -outcome.quantities["numerical_dissipation_share"])
    return float((abs(outcome.quantities["energy_balance_error"]) + added) * work / whole)


def faults(outcome: Outcome, prepared: Prepared) -> list[str]:
    """Look at the points: what cannot be, although the run says that all is well."""
    points = outcome.points
    if not all(np.isfinite(values).all() for name, values in points.items() if name != "cohesion"):  # elastic: none
        return ["not a number"]
    length, top = domain_size(prepared.study)
    outside = (points["x"] < 0.0) | (points["x"] > length) | (points["y"] < 0.0) | (points["y"] > top)
    speed = float(np.hypot(points["velocity_x"], points["velocity_y"]).max())
    found = []
    if outside.any():
        found.append(f"{outside.sum()} points outside the domain")
    if (points["volume"] <= 0.0).any():
        found.append(f"{(points['volume'] <= 0.0).sum()} points turned inside out")
    if speed > 2.0 * sqrt(2.0 * GRAVITY * top):
        found.append(f"a point at {speed:.3g} m/s, twice the speed of a fall from the top")
    if (excess := yield_excess(outcome, prepared)) > YIELD_TOLERANCE:
        found.append(f"stress outside the yield surface by {100 * excess:.2g} %")
    return found


def yield_excess(outcome: Outcome, prepared: Prepared) -> float:
    """How far the stresses lie outside the yield surface: the law's answer to no strain and no viscosity at all.

    What viscosity may hold beyond it, at the fastest shear that the points' speeds allow over a cell, is taken off.

    Returns:
        The largest change of stress of any point over the size of its stress [-]; 0 inside the surface.
    """
    points = outcome.points
    own = release(prepared.scene, {name: points[name] for name in ("cohesion", *prepared.fields)})
    law, history, held = own.law, own.history, 0.0
    if getattr(law, "viscosity", 0.0) > 0.0:
        speed = np.hypot(points["velocity_x"], points["velocity_y"]).max()
        held = law.viscosity * 2.0 * speed / prepared.scene.cell
        law = law._replace(viscosity=0.0)
    if history is not None:
        history = history._replace(plastic_strain=points["plastic_strain"])
    stress = Tensor(*(points[f"stress_{name}"] for name in Tensor._fields))
    worst, none = 0.0, Tensor(0.0, 0.0, 0.0, 0.0)
    for p in range(len(points["x"])):
        old = at(stress, p)
        new, _ = update_stress(at(law, p), old, none, at(history, p), inf)
        change = max(0.0, sqrt(sum((a - b) ** 2 for a, b in zip(old, new, strict=True))) - sqrt(2.0) * held)
        size = sqrt(sum(a * a for a in old))
        worst = max(worst, change / size if size > 0.0 else 0.0 if change == 0.0 else inf)
    return worst
