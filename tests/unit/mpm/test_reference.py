"""The plain solver and the engine are one method: same scene, same state; and what each transfer keeps."""

from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.solvers.reference import (
    ORDERS,
    Flip,
    Settings,
    advance,
    empty_nodes,
    still_gradient,
    wind_up,
)
from rfmpm.mpm.state import start

SHORT_SLOPE = Path(__file__).parents[3] / "configs" / "short_slope.toml"
TIME = 0.4  # [s]: the coarse slope yields from the first step on


def scene_of(shape, **changes):
    coarse = {
        "discretisation.cell_m": 0.5,
        "discretisation.shape": shape,
        "geometry.foreland_m": 5.0,
        "material.0.cohesion_kpa": 10.0,
    }
    return scenes.build(rfmpm.load_study(SHORT_SLOPE).with_changes(coarse | changes))


def plain_run(scene, transfer, order, time, body_force=None, **settings):
    points, law, history, _ = scenes.release(scene, None)
    settings = Settings(**{name: getattr(scene.controls, name) for name in Settings._fields})._replace(**settings)
    carried = None if isinstance(transfer, Flip) else still_gradient(len(points.mass))
    nodes = empty_nodes(scene.axes)
    now = advance(
        wind_up(points, law, history, scene.axes, nodes), time, points, carried, law, history, scene.axes, nodes,
        scene.walls, transfer, ORDERS[order], settings, body_force,
    )  # fmt: skip
    return now, points, history


def engine_run(scene, time):
    points, law, history, grid = scenes.release(scene, None)
    now = SOLVERS["explicit"](
        start(), time, points, law, history, scene.axes, grid, scene.walls, scene.controls
    )  # fmt: skip
    return now, points, history


@pytest.mark.parametrize(
    ("shape", "order"), [("quadratic_bspline", "usl"), ("cubic_bspline", "usl"), ("linear", "musl"), ("gimp", "musl")]
)
def test_engine_is_the_plain_solver(shape, order):
    scene = scene_of(shape)
    plain_now, plain, plain_history = plain_run(scene, Flip(2), order, TIME)
    now, points, history = engine_run(scene, TIME)
    assert now.step_count == plain_now.step_count > 25
    assert history.plastic_strain.max() > 1e-2
    # Sums are taken in another order: rounding, which the collapse lets grow a little from step to step.
    for found, expected, scale in (
        (points.position, plain.position, 1.0),
        (points.velocity, plain.velocity, 1.0),
        (points.stress, plain.stress, 1e4),
        ((points.volume, history.plastic_strain), (plain.volume, plain_history.plastic_strain), 1.0),
    ):
        for one, other in zip(found, expected, strict=True):
            np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-10 * scale)
