"""Nanoseconds per point and step on the short slope: the engine, the plain solver, three plain loops, a peer."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf

from rfmpm.benchmark.engine.plain_loop import empty_nodes, three_loops
from rfmpm.benchmark.engine.runs import Run
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.benchmark.engine.slopes import slope_study
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.shapes import SHAPES

STEPS = 40
SHARED = "production engine, each step shared by two threads, wall time: "  # all others: CPU time
Code = Callable[[], Callable[[], int]]  # makes a fresh run; that takes its steps and returns how many


@dataclass(frozen=True)
class Speed:
    """What one code needs."""

    label: str
    points: int
    nanoseconds: float  # per point and step


def measure(cell: float, repeats: int, shapes: Iterable[str] = tuple(SHAPES)) -> list[Speed]:
    """Time a few steps of the short slope with every code, minimum of the repeats.

    The repeats go round the codes, so that a disturbance of the machine meets all of them alike.

    Args:
        cell: side of a cell [m].
        repeats: how often each is timed.
        shapes: of the production engine.

    Returns:
        One entry per code.
    """
    study = slope_study().with_changes({"discretisation.cell_m": cell})
    made = {
        shape: scenes.build(study.with_changes({"discretisation.shape": shape}))
        for shape in dict.fromkeys([*shapes, "linear", "quadratic_bspline"])
    }
    bare = {"discretisation.volumetric_strain": "point", "material.0.softening_length_m": None}
    codes = {"three plain loops: linear, FLIP, stress last": _plain(made["linear"])}
    for shape in shapes:
        for transfer in ("flip_fmpm2", "flip"):
            scheme = Scheme(shape, transfer, engine="fast")
            codes[f"production engine: {scheme.label}"] = _run(made[shape], scheme)
    scheme = Scheme("quadratic_bspline", "flip_fmpm2", engine="fast")
    codes[SHARED + scheme.label] = _run(made["quadratic_bspline"], scheme, threads=2)
    for shape in ("linear", "quadratic_bspline"):
        scheme = Scheme(shape, engine="fast")
        scene = scenes.build(study.with_changes({"discretisation.shape": shape} | bare))
        codes[f"the same without means over cells and softening length: {scheme.label}"] = _run(scene, scheme)
    for scheme in (Scheme("linear", "flip", "usl"), Scheme("quadratic_bspline")):
        codes[f"plain solver: {scheme.label}"] = _run(made[scheme.shape], scheme)
    if peer := _peer(made["quadratic_bspline"]):
        codes["Taichi on one thread: quadratic B-spline, FLIP, stress last"] = peer
    count, least = len(made["linear"].points.mass), dict.fromkeys(codes, inf)
    for prepare in codes.values():
        prepare()()  # compiles
    for _ in range(repeats):
        for label, prepare in codes.items():
            advance = prepare()
            clock = time.perf_counter if label.startswith(SHARED) else time.process_time
            started = clock()
            steps = advance()
            least[label] = min(least[label], (clock() - started) / steps)
    return [Speed(label, count, 1e9 * seconds / count) for label, seconds in least.items()]


def _time_step(scene: scenes.Scene) -> float:
    return scene.controls.courant * scene.controls.cell / scene.controls.wave_speed


def _plain(scene: scenes.Scene) -> Code:
    def prepare() -> Callable[[], int]:
        own = scenes.release(scene, None)
        nodes, dt = empty_nodes(scene.axes.y.cells, scene.axes.x.cells), _time_step(scene)

        def advance() -> int:
            three_loops(
                own.points, own.law, own.history, scene.axes.x.inverse_cell, nodes, scene.controls.gravity, dt, STEPS
            )
            return STEPS

        return advance

    return prepare


def _run(scene: scenes.Scene, scheme: Scheme, threads: int = 1) -> Code:
    def prepare() -> Callable[[], int]:
        run = Run(scene, scheme, threads=threads)

        def advance() -> int:
            run.until((STEPS - 0.5) * _time_step(scene))
            return run.now.step_count

        return advance

    return prepare


def _peer(scene: scenes.Scene) -> Code | None:
    """The peer; None where Taichi is not installed."""
    try:
        from rfmpm.benchmark.engine.taichi_peer import Peer
    except ImportError:
        return None
    peer = Peer(scene, scenes.release(scene, None).law, _time_step(scene))

    def steps() -> int:
        peer.advance(STEPS)
        return STEPS

    return lambda: steps
