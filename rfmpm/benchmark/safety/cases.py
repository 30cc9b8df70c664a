"""Slopes whose factors of safety are published or known otherwise.

ACADS: Giam and Donald (1989), Example problems for testing soil slope stability programs, Monash University, with the
referees' factors; geometry and soils as problems 1, 2, 3, 7 and 8 of the verification manual of Slide (Rocscience). The
factors are those that XSLOPE's documentation cites from it, SLIDE_BY_XSLOPE; geometry and soils are from memory.
"""

from math import radians, tan
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.safety.spiral import factor_of_safety as by_spiral
from rfmpm.stability import Section

SLIDE_BY_XSLOPE = "https://xslope.readthedocs.io/en/latest/verification/rocscience/"  # read in its repository
SQUARE = 0.25  # [m]
SIMPLE = ((20.0, 35.0), (40.0, 35.0), (60.0, 25.0), (70.0, 25.0))  # ACADS 1: 10 m high, 2 to 1
SEAM = ((0.0, 40.0), (16.5, 40.0), (41.0, 27.75), (64.0, 27.75))  # ACADS 3


class Case(NamedTuple):
    """A slope, the soil of its points, and its factor.

    Attributes:
        name: of the case.
        section: the slope.
        soil: cohesion [Pa], angle of friction [rad] and unit weight [N/m3] at its points, shape (n,) each.
        least: of the known factor; equal to most where one is given.
        most: of the known factor.
        tolerance: relative error allowed.
        source: of the factor.
        methods: that are to find it.
        surface: slip surface, where one is given, shape (k, 2) [m].
    """

    name: str
    section: Section
    soil: tuple[np.ndarray, np.ndarray, np.ndarray]
    least: float
    most: float
    tolerance: float
    source: str
    methods: tuple[str, ...]
    surface: np.ndarray | None = None


SLICES = ("bishop", "spencer", "morgenstern_price")
GENERAL = ("spencer", "morgenstern_price")


def taylor(angle: float, depth: float, number: float) -> Case:
    """Undrained slope of 5 m on a firm base at a depth of so many heights below the crest (Taylor 1937)."""
    height, cohesion = 5.0, 12e3
    section = face(angle, height, (depth - 1.0) * height, 4.0 * height, SQUARE)
    known = number * cohesion / (20e3 * height)
    return Case(
        f"{angle:g} degrees, base at {depth:g} H",
        section,
        _uniform(section, cohesion, 0.0, 20e3),
        known,
        known,
        0.01,
        "Taylor (1937)",
        ("bishop",),
    )


def drained(angle: float, friction: float, ratio: float) -> Case:
    """Slope of 10 m with friction, its cohesion ratio * unit weight * height, against the logarithmic spiral."""
    height, weight = 10.0, 20e3
    section = face(angle, height, 0.5 * height, 2.0 * height, SQUARE)
    cohesion = ratio * weight * height
    known = by_spiral(radians(angle), height, cohesion, radians(friction), weight, 0.3, 10.0)
    return Case(
        f"{angle:g} degrees, phi {friction:g} degrees, c / (gamma H) {ratio:g}",
        section,
        _uniform(section, cohesion, friction, weight),
        known,
        known,
        0.02,
        "logarithmic spiral",
        SLICES,
    )


def acads() -> list[Case]:
    """The example problems 1a, 1b, 1c, 3a and 3b."""
    simple, seam = _raster(SIMPLE, 20.0), _raster(SEAM, 20.0)
    crack = 2.0 * 32.0 / 20.0 * tan(radians(45.0 + 5.0))  # 2 c / gamma tan(45 + phi / 2)
    x, y = simple.points.T
    # The layers as the source has them, on a slope that faces left: x runs backwards, from 90 - 70 to 90 - 20.
    upper = np.interp(90.0 - x, (20.0, 30.0, 40.0, 50.0, 54.0, 70.0), (25.0, 25.0, 27.0, 29.0, 31.0, 31.0))
    lower = np.interp(90.0 - x, (20.0, 30.0, 40.0, 52.0, 70.0), (25.0, 25.0, 27.0, 24.0, 24.0))
    three = [y > upper, y > lower], [0.0, 5.3e3], [38.0, 23.0]
    layers = (
        np.select(three[0], three[1], 7.2e3),
        np.radians(np.select(three[0], three[2], 20.0)),
        np.full(len(x), 19.5e3),
    )
    is_seam = (seam.points[:, 1] > 26.5) & (seam.points[:, 1] < 27.0)
    weak = (
        np.where(is_seam, 0.0, 28.5e3),
        np.radians(np.where(is_seam, 10.0, 20.0)),
        np.full(len(is_seam), 18.84e3),
    )
    line = np.array([(84.0 - 73.31, 40.0), (84.0 - 63.31, 27.0), (84.0 - 44.0, 26.5), (84.0 - 41.85, 27.75)])
    plain, cohesive = _uniform(simple, 3e3, 19.6, 20e3), _uniform(simple, 32e3, 10.0, 20e3)
    referees = "ACADS, referees"
    return [
        Case("ACADS 1a", simple, plain, 1.00, 1.00, 0.02, referees, SLICES),
        Case("ACADS 1b, dry crack", simple._replace(crack=crack), cohesive, 1.65, 1.65, 0.02, referees, SLICES),
        Case("ACADS 1c, three layers", simple, layers, 1.39, 1.39, 0.02, referees, SLICES),
        Case("ACADS 3a, weak seam", seam, weak, 1.24, 1.27, 0.02, referees, GENERAL),
        Case("ACADS 3b, its given surface", seam, weak, 1.262, 1.277, 0.02, "Slide, problem 8", GENERAL, line),
    ]


def all_cases() -> list[Case]:
    """Every case of the report."""
    return [
        taylor(45.0, 1.0, 6.12),
        taylor(60.0, 1.0, 5.24),
        taylor(90.0, 1.0, 3.83),
        taylor(45.0, 1.5, 5.75),
        taylor(45.0, 2.0, 5.65),
        *(drained(angle, friction, ratio) for angle in (30.0, 45.0, 60.0) for friction, ratio in DRAINED),
        *acads(),
    ]


def short_slope() -> tuple[Section, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """The short slope and the undrained soil of its points: 5 m at 45 degrees, 20 kPa, 20 kN/m3."""
    section = face(45.0, 5.0, 0.0, 10.0, 0.125)
    return section, _uniform(section, 20e3, 0.0, 20e3)


DRAINED = ((10.0, 0.15), (20.0, 0.10), (30.0, 0.05))


def face(angle: float, height: float, foundation: float, level: float, square: float) -> Section:
    """A plane face between level ground, as long in front of it as behind it where there is a foundation."""
    run = height / tan(radians(angle)) if angle < 90.0 else 0.0
    ground = [(0.0, height), (level, height), (level + run, 0.0)]
    if foundation > 0.0:
        ground.append((2.0 * level + run, 0.0))
    return _raster(ground, -foundation, square)


def _raster(ground, base: float, square: float = SQUARE) -> Section:
    ground = np.array(ground, dtype=float)
    columns = np.arange(ground[0, 0] + 0.5 * square, ground[-1, 0], square)
    rows = np.arange(base + 0.5 * square, ground[:, 1].max(), square)
    x, y = np.meshgrid(columns, rows)
    return Section(ground, base, np.column_stack([x.ravel(), y.ravel()]), square)


def _uniform(section: Section, cohesion: float, friction: float, weight: float):
    return tuple(np.full(len(section.points), value) for value in (cohesion, radians(friction), weight))
