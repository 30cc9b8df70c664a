"""The runs of the slope of Toro Rojas et al.: factors of safety, cohesion that holds it, travel, histories, cost."""

import time
from collections.abc import Mapping
from math import radians, tan
from typing import Any, NamedTuple

import numpy as np

from rfmpm import realisation
from rfmpm.benchmark.papers.case import simulate, study
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import RUNNING, start

NAME = "toro_rojas_slope"
CELLS = {1.0: 0.8, 0.5: 1.6 / 3.0, 0.4: 0.4, 0.3: 0.32, 0.2: 0.2}  # theirs, and the nearest that divide the height [m]
HELD = 0.1  # [m]: a slope that holds has moved by less, everywhere
PLACES = ("crown", "centre", "foot")
THEIR_ELEMENTS, THEIR_TIME = 60_450, 2.0 * 24.0 * 3600.0  # of the finest cells, 0.2 m; [s]
AS_MANY = 3.2 / 131.0  # [m]: cells of about that number
SAMPLE = 0.02  # [s] of model time
CELL, COHESION, STIFFNESS = "discretisation.cell_m", "material.0.cohesion_kpa", "material.0.youngs_modulus_kpa"
POINTS, SHAPE = "discretisation.points_per_cell", "discretisation.shape"
STIFFNESSES = (30e3, 60e3, 150e3, 300e3)  # [kPa]
SHAPES = ("quadratic_bspline", "linear")
FULL_RUN = 8.0  # [s] of model time; the slide is over after 3 s
STANDS = 1.8  # [kPa]: the slope holds


class Travel(NamedTuple):
    """How far a slide went."""

    at: dict[str, float]  # displacement of the named places [m]
    mean: float  # of all soil [m]
    furthest: float  # of any point [m]
    run_out: float  # [m]
    status: str
    points: dict[str, np.ndarray]  # final, by name


class Cost(NamedTuple):
    """What a run took."""

    cell: float  # [m]
    cells: int  # that hold soil
    points: int
    steps: int
    preparing: float  # processor time [s]
    stepping: float  # the same [s]

    @property
    def total(self) -> float:
        """The whole [s]."""
        return self.preparing + self.stepping


class Plan(NamedTuple):
    """What is run."""

    cells: tuple[float, ...]  # [m], from coarse to fine
    cohesions: tuple[float, ...]  # [kPa]
    packings: dict[float, tuple[int, ...]]  # points per cell by cell
    halvings: int  # of the search for the cohesion that holds
    many: float  # cell of the run of which only a short time is computed [m]
    short: float  # that time [s]


FULL = Plan(
    tuple(CELLS.values()),
    (0.1, 0.5, 1.0, 1.25, 1.5, STANDS),
    {CELLS[theirs]: (1, 4, 9) for theirs in (0.5, 0.3, 0.2)},
    halvings=6,
    many=AS_MANY,
    short=0.02,
)
QUICK = Plan((0.8, 0.4), (0.1, STANDS), {0.4: (4, 9)}, halvings=1, many=0.2, short=0.02)


class Studies(NamedTuple):
    """What the runs came to."""

    factors: list[float]  # at 0.1 and 1.8 kPa
    held: dict[float, dict[str, float]]  # cohesion that holds [kPa] by cell and shape
    softer: list[Travel]  # by STIFFNESSES, on the finest cells
    standing: dict[float, Travel]  # the same of a slope that holds, by stiffness [kPa]
    stronger: dict[float, Travel]  # by cohesion [kPa]
    finer: dict[float, Travel]  # by cell [m]
    packed: dict[tuple[float, int], Travel]  # by cell and points per cell
    histories: dict[float, dict[str, np.ndarray]]  # of the softest and the stiffest slope, by stiffness [kPa]
    costs: list[Cost]  # by cell
    many: Cost  # of the short run


def studies(plan: Plan) -> Studies:
    """Run everything."""
    finest = {CELL: plan.cells[-1]}
    return Studies(
        factors=[factor(cohesion) for cohesion in (0.1, STANDS)],
        held={cell: {shape: holding_cohesion(cell, shape, plan.halvings) for shape in SHAPES} for cell in plan.cells},
        softer=[travel(finest | {STIFFNESS: value}) for value in STIFFNESSES],
        standing={value: travel({CELL: CELLS[0.4], COHESION: STANDS, STIFFNESS: value}) for value in STIFFNESSES},
        stronger={value: travel(finest | {COHESION: value}) for value in plan.cohesions},
        finer={cell: travel({CELL: cell}) for cell in plan.cells},
        packed={
            (cell, count): travel({CELL: cell, POINTS: count})
            for cell, counts in plan.packings.items()
            for count in counts
        },
        histories={
            value: histories(finest | {STIFFNESS: value, "time.end_s": 5.0})
            for value in (STIFFNESSES[0], STIFFNESSES[-1])
        },
        costs=[cost(cell, FULL_RUN) for cell in plan.cells],
        many=cost(plan.many, plan.short),
    )


def factor(cohesion: float) -> float:
    """Factor of safety by Morgenstern and Price at a cohesion [kPa]; the slope need not move for it."""
    changes = {COHESION: cohesion, "quantities.factor_of_safety": "morgenstern_price", "time.end_s": 1e-3}
    return simulate(study(NAME, changes)).quantities["factor_of_safety"]


def travel(changes: Mapping[str, Any]) -> Travel:
    """Let the slope go, with some keys of its study changed."""
    asked = study(NAME, changes)
    outcome = simulate(asked)
    points = outcome.points
    moved = np.hypot(points["displacement_x"], points["displacement_y"])
    near = _named(asked, points["x_initial"], points["y_initial"])
    at = {name: float(moved[points_near].mean()) for name, points_near in near.items()}
    mean = float(np.average(moved, weights=points["volume"]))
    return Travel(at, mean, float(moved.max()), float(outcome.quantities["run_out"]), outcome.status, points)


def holding_cohesion(cell: float, shape: str, halvings: int, low: float = 0.1, high: float = 2.5) -> float:
    """The cohesion from which the slope holds [kPa], by bisection, on cells of a size [m] with a shape function."""
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        moved = travel({CELL: cell, COHESION: middle, SHAPE: shape}).furthest
        low, high = (low, middle) if moved < HELD else (middle, high)
    return 0.5 * (low + high)


def histories(changes: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Follow the named places while the slope goes, with some keys of its study changed.

    Args:
        changes: of the study.

    Returns:
        "time" [s], shape (samples,), and for each place a motion: displacement [m], speed [m/s] and acceleration along
        the way [m/s2], shape (3, samples); the latter two are rates of change over a tenth of a second.
    """
    asked = study(NAME, changes)
    scene = realisation.prepare(asked).scene
    own, now, advance = scenes.release(scene, None), start(), SOLVERS[asked.time.scheme]
    first, live = scene.points.position, own.points.position
    named, arguments = _named(asked, first.x, first.y), scenes.arguments(scene, own)
    times, moved = [0.0], {place: [(0.0, 0.0)] for place in PLACES}
    while now.status == RUNNING and now.time < asked.time.end_s:
        now = advance(now, now.time + SAMPLE, *arguments)
        times.append(now.time)
        for place, near in named.items():
            moved[place].append(((live.x - first.x)[near].mean(), (live.y - first.y)[near].mean()))
    time_ = np.array(times)
    return {"time": time_} | {place: _motion(time_, np.array(way)) for place, way in moved.items()}


def _motion(times: np.ndarray, way: np.ndarray) -> np.ndarray:
    speed = _smooth(np.hypot(*np.gradient(way, times, axis=0).T))
    return np.array([np.hypot(*way.T), speed, np.gradient(speed, times)])


def _smooth(values: np.ndarray, width: int = 5) -> np.ndarray:
    return np.convolve(np.pad(values, width // 2, mode="edge"), np.ones(width) / width, mode="valid")


def cost(cell: float, end: float) -> Cost:
    """Run the slope on cells of a size [m] for a model time [s]; kernels are compiled before."""
    realisation.compile_kernels(realisation.prepare(study(NAME)))
    started = time.process_time()
    prepared = realisation.prepare(study(NAME, {CELL: cell, "time.end_s": end}))
    ready = time.process_time()
    outcome = realisation.simulate(prepared)
    ended = time.process_time()
    x, y = outcome.points["x_initial"], outcome.points["y_initial"]
    cells = len(np.unique(np.column_stack([x // cell, y // cell]), axis=0))
    return Cost(cell, cells, len(x), outcome.step_count, ready - started, ended - ready)


def _named(asked, x: np.ndarray, y: np.ndarray) -> dict[str, np.ndarray]:
    """Numbers of the points within a cell of the upper end, the middle and the lower end of the face, by name."""
    height, crest, cell = asked.geometry.height_m, asked.geometry.crest_m, asked.discretisation.cell_m
    width = height / tan(radians(asked.geometry.angle_deg))
    at = {"crown": (crest, height), "centre": (crest + 0.5 * width, 0.5 * height), "foot": (crest + width, 0.0)}
    return {name: np.flatnonzero(np.hypot(x - at[name][0], y - at[name][1]) < cell) for name in PLACES}
