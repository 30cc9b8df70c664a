"""A column compressed by its own weight until its strains are large: Bardenhagen and Kober (2004), section 5.1.

With Poisson's ratio 0 the rate law of the engine gives sigma = E ln(lambda) along the column, with the stretch lambda;
equilibrium on the first configuration asks for sigma = -rho0 g (l0 - Y), whatever the law.
"""

from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.engine.blocks import elastic_block
from rfmpm.benchmark.engine.runs import Measurement, Run, timed
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.benchmark.engine.settling import settle, unstressed
from rfmpm.mpm import scene as scenes

NAME, TITLE = "column", "Column under its own weight"
ERRORS = {"stress": "error of the stress over the stress at the base [1]"}
HEIGHT, DENSITY, MODULUS, GRAVITY = 50.0, 80.0, 1e6, 10.0  # [m], [kg/m3], [Pa], [m/s2]
WIDTH_IN_CELLS = 3
PERIODS = 10


class Compression(NamedTuple):
    """What a column came to; arrays over its points have shape (n,)."""

    y_initial: np.ndarray  # [m]
    y: np.ndarray  # [m]
    stress: np.ndarray  # along the column [Pa]
    exact: np.ndarray  # the same, in closed form [Pa]
    error: float  # root mean square over the stress at the base [1]; NaN where the run broke
    cpu_time: float  # [s]


def compress(study, scheme: Scheme, repeats: int = 1) -> Compression:
    """Let the column of a study of a block settle, and compare the points' stresses with the exact ones."""
    scene, height = unstressed(study), study.geometry.height_m
    first = scene.points.position.y
    weight = study.material[0].unit_weight_kn_m3 * 1e3 / scenes.GRAVITY * GRAVITY
    exact = -weight * (height - first)
    cpu_time, run, _ = timed(lambda: Run(scene, scheme), lambda run: settle(run, height, GRAVITY, PERIODS), repeats)
    error = np.nan if run.is_broken else np.sqrt(np.mean((run.points.stress.yy - exact) ** 2)) / (weight * height)
    return Compression(first, run.points.position.y, run.points.stress.yy, exact, float(error), cpu_time)


def measure(scheme: Scheme, cells: int, repeats: int) -> Measurement:
    """Run the column on so many cells and compare the points' stresses with the exact ones, root mean square."""
    cell = HEIGHT / cells
    study = elastic_block(
        WIDTH_IN_CELLS * cell, HEIGHT, cell, scheme.shape, scheme.points_per_cell, DENSITY, MODULUS, 0.0
    )
    found = compress(study, scheme, repeats)
    return Measurement(NAME, scheme, cell, found.cpu_time, {"stress": found.error})
