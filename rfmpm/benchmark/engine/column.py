"""A column compressed by its own weight until its strains are large: Bardenhagen and Kober (2004), section 5.1.

With Poisson's ratio 0 the rate law of the engine gives sigma = E ln(lambda) along the column, with the stretch lambda;
equilibrium on the first configuration asks for sigma = -rho0 g (l0 - Y), whatever the law. The weight comes on in many
small steps, as s - sin(2 pi s) / (2 pi) over ten periods: the swing it leaves is about 4 pi^2 / (20 pi)^3, 0.02 %, of
the stress (half a cosine would leave ten times that, and be what is seen on fine grids).
"""

from dataclasses import replace
from math import pi, sin

import numpy as np

from rfmpm.benchmark.engine.blocks import elastic_block
from rfmpm.benchmark.engine.runs import Measurement, Run, timed
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.kernel_tools import Tensor
from rfmpm.mpm import scene as scenes

NAME, TITLE = "column", "Column under its own weight"
ERRORS = {"stress": "error of the stress over the stress at the base [1]"}
HEIGHT, DENSITY, MODULUS, GRAVITY = 50.0, 80.0, 1e6, 10.0  # [m], [kg/m3], [Pa], [m/s2]
WIDTH_IN_CELLS = 3
PERIODS, PIECES = 10, 400


def measure(scheme: Scheme, cells: int, repeats: int) -> Measurement:
    """Run the column on so many cells and compare the points' stresses with the exact ones, root mean square."""
    cell = HEIGHT / cells
    study = elastic_block(
        WIDTH_IN_CELLS * cell, HEIGHT, cell, scheme.shape, scheme.points_per_cell, DENSITY, MODULUS, 0.0
    )
    scene = scenes.build(study)
    points = scene.points
    exact = -DENSITY * GRAVITY * (HEIGHT - points.position.y)
    scene = replace(scene, points=points._replace(stress=Tensor(*(0.0 * s for s in points.stress))))
    cpu_time, run, _ = timed(lambda: Run(scene, scheme), _load, repeats)
    error = np.sqrt(np.mean((run.points.stress.yy - exact) ** 2)) / (DENSITY * GRAVITY * HEIGHT)
    return Measurement(NAME, scheme, cell, cpu_time, {"stress": float(np.nan if run.is_broken else error)})


def _load(run: Run) -> None:
    duration = PERIODS * 4.0 * HEIGHT / run.scene.controls.wave_speed
    for piece in range(1, PIECES + 1):
        share = piece / PIECES
        run.until(share * duration, GRAVITY * (share - sin(2.0 * pi * share) / (2.0 * pi)))
