"""An elastic bar that swings in its first axial mode for 100 periods: error of the phase, loss of energy."""

from dataclasses import replace

import numpy as np

from rfmpm.benchmark.engine.blocks import elastic_block
from rfmpm.benchmark.engine.runs import Measurement, Run, timed
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.kernel_tools import Tensor, Vector
from rfmpm.mpm import scene as scenes

NAME, TITLE = "bar", "Vibrating bar, 100 periods"
ERRORS = {"phase": "error of the phase per period [period]", "energy": "energy lost per period [1]"}
HEIGHT, DENSITY, MODULUS, POISSON = 2.0, 2000.0, 1e6, 0.33  # [m], [kg/m3], [Pa], [1]
SPEED = 1e-4  # at the free end [m/s]: small displacements
WIDTH_IN_CELLS = 3
PERIODS, SAMPLES = 100, 8  # samples per period, to count the turns of the phase


def measure(scheme: Scheme, cells: int, repeats: int, periods: int = PERIODS) -> Measurement:
    """Run the bar on so many cells along its length.

    The amplitude of the mode and its rate make a complex number that turns once in a period: its angle is the phase,
    its square the energy.
    """
    cell = HEIGHT / cells
    study = elastic_block(
        WIDTH_IN_CELLS * cell, HEIGHT, cell, scheme.shape, scheme.points_per_cell, DENSITY, MODULUS, POISSON
    )
    scene = scenes.build(study)
    first = scene.points
    mode = np.sin(0.5 * np.pi * first.position.y / HEIGHT)
    points = first._replace(
        velocity=Vector(0.0 * mode, SPEED * mode), stress=Tensor(*(0.0 * component for component in first.stress))
    )
    scene = replace(scene, points=points, controls=scene.controls._replace(gravity=0.0))
    frequency = 0.5 * np.pi * scene.controls.wave_speed / HEIGHT
    norm = mode @ mode

    def swing(run: Run) -> tuple[np.ndarray, np.ndarray]:
        times, states = [0.0], [1j * SPEED]
        for sample in range(1, periods * SAMPLES + 1):
            run.until(sample * 2.0 * np.pi / frequency / SAMPLES)
            shift, rate = mode @ (run.points.position.y - first.position.y), mode @ run.points.velocity.y
            times.append(run.time)
            states.append((frequency * shift + 1j * rate) / norm)
        return np.array(times), np.array(states)

    cpu_time, run, (times, states) = timed(lambda: Run(scene, scheme), swing, repeats)
    if run.is_broken:
        return Measurement(NAME, scheme, cell, cpu_time, dict.fromkeys(ERRORS, np.nan))
    turns = -(np.unwrap(np.angle(states))[-1] - np.angle(states[0])) / (2.0 * np.pi)
    passed = times[-1] * frequency / (2.0 * np.pi)
    kept = (abs(states[-1]) / abs(states[0])) ** (2.0 / passed)
    errors = {"phase": abs(turns / passed - 1.0), "energy": abs(1.0 - kept)}
    return Measurement(NAME, scheme, cell, cpu_time, {name: float(value) for name, value in errors.items()})
