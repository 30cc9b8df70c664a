"""Factor of safety by strength reduction: the number that cohesion and tan(phi) can be divided by until a slope flows.

Zienkiewicz, Humpheson and Lewis (1975), on the points, grid, walls and law of the simulation, with the peak strength of
a realisation and without softening (`rfmpm.mpm.equilibrium`). A body stands at a factor if its forces come into balance
to a thousandth of its weight. It fails if, before that, the least that is out of balance within a period, that of a
shear wave four times as long as the body is high, is no longer a fifth below that of the period before. A failing body
then flows at a speed at which the damping takes what strength lacks, and what is out of balance stays proportional to
that lack: a thousandth of the weight of a short slope is half a per cent of its strength, and correspondingly more
where most of the body never moves.

Trials go from factors at which the body stands, each from the state of the last one that did (warm start), to the first
at which it fails; the bracket is then halved, in the logarithm. Friction of the base is a property of the boundary: it
is not reduced. Tensile strength given by a cut-off is not reduced either.

Against limit analysis with 20 cells to the height: a short slope on a firm base 0.4 % more, on a base with friction of
0.3 2 % less; with 24, drained soil with associated flow 2 % more, with no dilation 1 to 3 % less. Rock as a foundation
holds the soil within a cell of it: 5 % more, of first order in the cell.
"""

from math import log, sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm.kernel_tools import mapped
from rfmpm.mpm.equilibrium import Verdict, damped_start, relax, relaxation
from rfmpm.mpm.scene import Released, Scene, release
from rfmpm.mpm.state import copy_points

WIDTH = 0.01  # of the bracket, over the factor
STRIDE = 1.25  # from one factor to the next until the bracket is closed
SMALLEST, LARGEST = 0.02, 50.0  # factors beyond which none is looked for


class Trial(NamedTuple):
    """A factor tried, and where it ended."""

    factor: float
    verdict: Verdict


class StrengthReduction(NamedTuple):
    """What strength reduction found."""

    factor: float  # the middle of the bracket, or its end where the other is not finite or zero [-]
    bracket: tuple[float, float]  # largest factor at which the body stands, smallest at which it fails
    history: tuple[Trial, ...]  # every trial, in order


def strength_reduction(prepared: Any, fields: dict[str, np.ndarray], first: float = 1.0) -> StrengthReduction:
    """Find the factor of safety of one realisation.

    Args:
        prepared: the prepared study; its scene is read.
        fields: of the realisation by name, shape (n,) each, in SI units; empty where nothing is random.
        first: factor that is tried first; a good guess saves trials.

    Returns:
        What was found; a factor beyond 0.02 or 50 is given as that, with 0 or infinity in the bracket.
    """
    scene: Scene = prepared.scene
    state, tried = release(scene, fields), []

    def stands(factor: float) -> bool:
        nonlocal state
        start = _copy(state)
        verdict = relax(relaxation(scene, start, factor), damped_start())
        tried.append(Trial(factor, verdict))
        if verdict.stands:
            state = start
        return verdict.stands

    low, high = _bracket(stands, first)
    while 0.0 < low < LARGEST < np.inf and high < np.inf and log(high / low) > WIDTH:
        middle = sqrt(low * high)
        if stands(middle):
            low = middle
        else:
            high = middle
    factor = sqrt(low * high) if low > 0.0 and high < np.inf else (high if low == 0.0 else low)
    return StrengthReduction(factor, (low, high), tuple(tried))


def _bracket(stands, factor: float) -> tuple[float, float]:
    """Largest factor tried at which the body stands, 0 for none, and smallest at which it fails, infinite for none."""
    if stands(factor):
        while factor < LARGEST:
            low, factor = factor, factor * STRIDE
            if not stands(factor):
                return low, factor
        return factor, np.inf
    while factor > SMALLEST:
        high, factor = factor, factor / STRIDE
        if stands(factor):
            return factor, high
    return 0.0, factor


def _copy(state: Released) -> Released:
    """A state whose points and history can change without it."""
    history = mapped(lambda own: type(own)(*(values.copy() for values in own)), state.history)
    return state._replace(points=copy_points(state.points), history=history)
