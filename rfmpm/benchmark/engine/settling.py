"""Bodies without stress that settle under their own weight, which comes on so slowly that they hardly swing.

The weight rises as s - sin(2 pi s) / (2 pi) over so many periods of the slowest swing, in many small steps: over ten
periods the swing that it leaves is about 4 pi^2 / (20 pi)^3, 0.02 %, of the stress (half a cosine would leave ten times
that, and be what is seen on fine grids).
"""

from dataclasses import replace
from math import pi, sin

from rfmpm.benchmark.engine.runs import Run
from rfmpm.kernel_tools import Tensor
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.scene import Scene

PIECES_A_PERIOD = 40


def unstressed(study) -> Scene:
    """The scene of a study, its points without stress."""
    scene = scenes.build(study)
    points = scene.points
    return replace(scene, points=points._replace(stress=Tensor(*(0.0 * component for component in points.stress))))


def settle(run: Run, height: float, gravity: float, periods: int) -> None:
    """Let the weight come on.

    Args:
        run: of a scene without stress.
        height: of the body [m]; its slowest swing takes a wave four times that way.
        gravity: in the end [m/s2].
        periods: of that swing in which the weight comes on.
    """
    duration = periods * 4.0 * height / run.scene.controls.wave_speed
    pieces = PIECES_A_PERIOD * periods
    for piece in range(1, pieces + 1):
        share = piece / pieces
        run.until(share * duration, gravity * (share - sin(2.0 * pi * share) / (2.0 * pi)))
