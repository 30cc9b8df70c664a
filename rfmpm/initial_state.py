"""The state a realisation starts from, where it is another than the scene's elastic one, and whether it is balanced."""

from rfmpm.mpm.equilibrium import raise_gravity, release_at_rest
from rfmpm.mpm.initial_stress import SETTLES
from rfmpm.mpm.scene import Released, Scene
from rfmpm.mpm.state import Progress
from rfmpm.study import StudyError

# Measured: level ground under K0, 0.04 over the root of its rows of cells (0.009 with 20, 0.046 with 2); a slope of 30
# degrees under K0, 0.17; after a ramp, below 1e-3 where the slope stands, 6e-3 at a factor of safety near 0.9.
LARGEST_OUT_OF_BALANCE = {"k0": 0.05, "gravity_ramp": 2e-3}
ADVICE = {
    "k0": 'K0 is for level ground, take "elastic" or "gravity_ramp" for this one',
    "gravity_ramp": 'the slope does not stand under its own weight, take "elastic" to watch it fail, or more strength',
}


def begin(study, scene: Scene, own: Released, now: Progress, threads: int) -> tuple[Scene, Progress, float]:
    """Raise gravity if the study asks for it, and take the points to their grid.

    Args:
        study: the study.
        scene: the scene.
        own: what the realisation owns; its stresses change.
        now: progress before the first step.
        threads: that share every step.

    Returns:
        The scene as it then is, the progress, and what is out of balance [-].
    """
    if study.time.initial_stress in SETTLES:
        raise_gravity(scene, own)
    return release_at_rest(scene, own, now, threads)


def refuse_large(study, out_of_balance: float) -> None:
    """Refuse a study whose initial stresses are far from equilibrium.

    Args:
        study: the study.
        out_of_balance: unbalanced over gravity's forces [-].

    Raises:
        StudyError: if they are.
    """
    kind = study.time.initial_stress
    if out_of_balance > LARGEST_OUT_OF_BALANCE[kind]:
        text = f"forces at the start are out of balance by {out_of_balance:.2g} of gravity's"
        most = f"must be at most {LARGEST_OUT_OF_BALANCE[kind]:g}; {ADVICE[kind]}"
        raise StudyError([f'time.initial_stress = "{kind}": {text}, {most}'])
