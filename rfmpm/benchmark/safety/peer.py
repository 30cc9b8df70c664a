"""Another package that finds factors of safety, on slopes that it can describe; not needed to run this program."""

import time
from importlib.util import find_spec
from math import radians, tan
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.safety.cases import SQUARE, face
from rfmpm.stability import critical_surface, sides_of

SLOPES = ((26.565, 19.6, 3.0), (45.0, 20.0, 20.0), (60.0, 30.0, 10.0))  # face [deg], friction [deg], cohesion [kPa]
HEIGHT, WEIGHT = 10.0, 20.0  # m, kN/m3
SLICES, SURFACES = 50, 2500  # of pyslope; its defaults are 50 and 2000
REPEATS = 3


class Peer(NamedTuple):
    """A factor by both, and the processor time of each."""

    name: str
    own: float
    own_seconds: float
    other: float
    other_seconds: float


def compare() -> list[Peer]:
    """Find the factors of a few homogeneous slopes with both; nothing where pyslope is not installed."""
    if find_spec("pyslope") is None:
        return []
    return [_compare(*slope) for slope in SLOPES]


def _compare(angle: float, friction: float, cohesion: float) -> Peer:
    from pyslope import Material, Slope

    section = face(angle, HEIGHT, 0.5 * HEIGHT, 2.0 * HEIGHT, SQUARE)
    soil = [np.full(len(section.points), value) for value in (1e3 * cohesion, radians(friction), 1e3 * WEIGHT)]
    sides, own_times, other_times = sides_of(section), [], []
    for _ in range(REPEATS):
        started = time.process_time()
        own = critical_surface(sides, *soil).factor
        own_times.append(time.process_time() - started)
    for _ in range(REPEATS):
        slope = Slope(height=HEIGHT, angle=None, length=HEIGHT / tan(radians(angle)))
        slope.set_materials(Material(WEIGHT, friction, cohesion, depth_to_bottom=1.5 * HEIGHT))
        slope.update_analysis_options(slices=SLICES, iterations=SURFACES)
        started = time.process_time()
        slope.analyse_slope()
        other_times.append(time.process_time() - started)
    name = f"{angle:.4g} degrees, phi {friction:g} degrees, c {cohesion:g} kPa"
    return Peer(name, own, min(own_times), slope.get_min_FOS(), min(other_times))
