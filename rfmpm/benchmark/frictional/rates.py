"""How fast the pile of bars is sheared: its inertial number, and the friction that it would add."""

from math import sqrt

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.frictional.cases import CELL
from rfmpm.benchmark.papers.case import study
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.soils import plastic_strain_of
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import RUNNING, start

DIAMETER, DENSITY = 1.25e-3, 2650.0  # of the bars, 1 and 1.5 mm [m], [kg/m3]
SLOPE = 1.0  # friction coefficient gained per inertial number, of discs: da Cruz et al. (2005), Phys. Rev. E 72, 021309
SAMPLE, END = 0.01, 1.0  # [s] of model time
LEAST = 20.0  # [Pa]: a bar or so of cover


def inertial_number(name: str, cell: float) -> float:
    """Mean inertial number of a collapse, every place counted by the work it does in shear.

    Args:
        name: of the study.
        cell: side of a cell [m].

    Returns:
        The mean of rate x diameter x sqrt(density / pressure) [-].
    """
    scene = realisation.prepare(study(name, {CELL: cell})).scene
    own, now = scenes.release(scene, None), start()
    advance, arguments = SOLVERS["explicit"], scenes.arguments(scene, own)
    count = len(own.points.mass)
    before, work, sum_ = plastic_strain_of(own.history, count).copy(), 0.0, 0.0
    while now.status == RUNNING and now.time < END:
        then = now.time
        now = advance(now, then + SAMPLE, *arguments)
        strain = plastic_strain_of(own.history, count).copy()
        shear, before = sqrt(3.0) * (strain - before), strain  # as an angle
        pressure = -0.5 * (own.points.stress.xx + own.points.stress.yy)
        own_work = pressure * shear * own.points.volume
        covered = pressure > LEAST
        number = shear[covered] / (now.time - then) * DIAMETER * np.sqrt(DENSITY / pressure[covered])
        work += float(own_work[covered].sum())
        sum_ += float(own_work[covered] @ number)
    return sum_ / work
