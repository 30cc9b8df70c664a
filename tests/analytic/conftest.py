"""Elastic blocks, anywhere in their domain and moving as a test wants."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

import rfmpm
from rfmpm.kernel_tools import Tensor, Vector
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.initial_stress import elastic_gravity_stress
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import Points, start
from rfmpm.study import Study


def block_study(width, height, foreland, cell=0.25, base=None, **changes) -> Study:
    """Study of an elastic block between rollers, or on another base; changes by path, with `__` for the dots.

    Compressible rubber does not lock: each point has its own volumetric strain.
    """
    study = rfmpm.load_study(
        {
            "study": {"name": "elastic block", "seed": 1},
            "geometry": {"kind": "block", "width_m": width, "height_m": height, "foreland_m": foreland},
            "discretisation": {
                "cell_m": cell,
                "points_per_cell": 4,
                "shape": "quadratic_bspline",
                "volumetric_strain": "point",
            },
            "boundary": {"base": base or {"kind": "roller"}, "sides": {"kind": "roller"}},
            "material": [
                {
                    "name": "rubber",
                    "law": "elastic",
                    "unit_weight_kn_m3": 20.0,
                    "youngs_modulus_kpa": 1000.0,
                    "poissons_ratio": 0.33,
                }
            ],
            "time": {"end_s": 1.0},
            "output": {"directory": "results"},
        }
    )
    return study.with_changes({key.replace("__", "."): value for key, value in changes.items()})


def launched(
    scene, shift=(0.0, 0.0), velocity=(0.0, 0.0), stress=(0.0, 0.0, 0.0, 0.0), gravity=None, height=None, **controls
):
    """The scene with its points elsewhere, with other velocities and stresses (uniform or one per point).

    `stress` None: elastic stresses under gravity where the points then are. `height`: of the domain [m]. It neither
    ends at rest nor for its energy, which the engine counts from a start at rest.
    """
    controls = {"energy_scale": inf, "rest_time": inf} | controls
    if height is not None:
        rows = round(height * scene.axes.y.inverse_cell)
        scene = replace(scene, axes=scene.axes._replace(y=scene.axes.y._replace(cells=rows)))
    first = scene.points
    position = Vector(first.position.x + shift[0], first.position.y + shift[1])
    if gravity is not None:
        controls["gravity"] = gravity
    changed = scene.controls._replace(**controls)
    if stress is None:
        stress = elastic_gravity_stress(
            np.column_stack(position), first.mass, first.volume, scene.axes, scene.walls, scene.lame, scene.shear,
            changed.gravity, scene.cell_means,
        )  # fmt: skip
    points = Points(
        position,
        Vector(*(first.mass * 0.0 + component for component in velocity)),
        first.mass,
        first.volume,
        Tensor(*(first.mass * 0.0 + component for component in stress)),
    )
    return replace(scene, points=points, controls=changed)


class Flight:
    """A run of a scene, step by step if asked."""

    def __init__(self, scene):
        self.scene, self.now = scene, start()
        self.own = scenes.release(scene, None)
        self.points = self.own.points

    def until(self, time):
        self.now = SOLVERS["explicit"](self.now, time, *scenes.arguments(self.scene, self.own))
        return self.now


@pytest.fixture
def blocks():
    """The builders of this folder's scenes."""
    return Blocks


class Blocks:
    study, launched, flight = staticmethod(block_study), staticmethod(launched), Flight

    @staticmethod
    def scene(*arguments, **changes):
        return scenes.build(block_study(*arguments, **changes))
