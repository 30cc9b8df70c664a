"""Monte Carlo ensembles of slope failures: random fields of strength, the material point method, probabilities.

The names below are the public ones; each loads what it needs when it is first used.
"""

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr

    from rfmpm.outcome import Outcome
    from rfmpm.results import open_ensemble
    from rfmpm.study import Study, StudyError, load_study

__all__ = [
    "Study",
    "StudyError",
    "__version__",
    "draw_xi",
    "load_study",
    "open_ensemble",
    "realise_fields",
    "run_ensemble",
    "simulate",
]

_HOMES = {
    "Study": "rfmpm.study",
    "StudyError": "rfmpm.study",
    "load_study": "rfmpm.study",
    "open_ensemble": "rfmpm.results",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("rfmpm")
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'rfmpm' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def draw_xi(study: Any, index: int = 0, level: int = 0) -> "np.ndarray":
    """Draw the standard-normal vector from which the fields of one realisation are made.

    It depends on the study, level and index alone: on no rank and no order. That of level 0 is the campaign's.

    Args:
        study: a Study, or anything `load_study` reads.
        index: realisation index.
        level: of the stream of random numbers; 0 for that of the study's campaign, on whatever cells.

    Returns:
        `xi`, shape (n_variables,) [-]: one for each uncertain number of the study, in its order, then the parts of the
        properties in the order of the study, those of a property from its uppermost soil down; empty for a study in
        which nothing is random.

    Raises:
        StudyError: with everything that is wrong with the study, or if the realisation follows from others.
    """
    from rfmpm import planning, realisation
    from rfmpm.study import load_study

    replay = planning.Replay(load_study(study))
    return realisation.draw_xi(replay.prepared, index, level) if level else replay.xi(index)


def realise_fields(
    study: Any, index: int = 0, level: int = 0, xi: "np.ndarray | None" = None
) -> "dict[str, np.ndarray]":
    """Realise the random fields of one realisation.

    Args:
        study: a Study, or anything `load_study` reads.
        index: realisation index.
        level: of the stream of random numbers; 0 for that of the study's campaign, on whatever cells.
        xi: standard-normal vector, shape (n_variables,) [-], in place of the one that `draw_xi` draws.

    Returns:
        Values at the material points by name: {"cohesion": (n_points,) [Pa]}, also "residual_cohesion" [Pa] and
        "friction_angle" [rad] where they are random; empty for a homogeneous study.

    Raises:
        StudyError: with everything that is wrong with the study.
        ValueError: `xi` has another length than the study's fields take.
    """
    from rfmpm import planning, realisation
    from rfmpm.study import load_study

    study = load_study(study)
    if xi is None and not level and not planning.is_random(study):
        xi = planning.Replay(study).xi(index)
    return realisation.realise_fields(planning.studies_by_level(study)[0], index, level=level, xi=xi)


def simulate(
    study: Any,
    index: int = 0,
    *,
    level: int = 0,
    frames: int = 0,
    homogeneous: bool = False,
    xi: "np.ndarray | None" = None,
    threads: int | None = None,
) -> "Outcome":
    """Simulate one realisation.

    Args:
        study: a Study, or anything `load_study` reads.
        index: realisation index.
        level: of the stream of random numbers; 0 for that of the study's campaign, on whatever cells.
        frames: number of snapshots to keep on the way.
        homogeneous: take the mean strength everywhere, and the study's own value of what is uncertain.
        xi: standard-normal vector in place of the one that `draw_xi` draws, as for `realise_fields`.
        threads: that share every step, at least 1; None for the cores where the scene is large, else 1. Results depend
            on the number by rounding; an ensemble has one for each realisation.

    Returns:
        The outcome: quantities, status, final points, histories and snapshots.

    Raises:
        StudyError: with everything that is wrong with the study, or if there are no threads or more than points.
        ValueError: `xi` has another length than the study's fields take.
    """
    from rfmpm import planning, realisation
    from rfmpm.study import load_study

    replay = planning.Replay(load_study(study))
    prepared = replay.prepared
    if xi is None and not (level or homogeneous):
        xi = replay.options(index).get("xi")
    threads = realisation.threads_for(prepared) if threads is None else threads
    return realisation.simulate(
        prepared, index, level=level, frames=frames, homogeneous=homogeneous, xi=xi, threads=threads
    )


def run_ensemble(
    study: Any,
    realisations: int | None = None,
    directory: str | Path | None = None,
    *,
    workers: int | None = None,
    fresh: bool = False,
    indices: tuple[int, int] | None = None,
) -> "xr.Dataset":
    """Run a campaign, continuing what its folder holds of the same study.

    Args:
        study: a Study, or anything `load_study` reads.
        realisations: how many, instead of the study's own number.
        directory: folder of the results, instead of the study's own.
        workers: number of local processes; by default one for each core.
        fresh: start anew instead of continuing.
        indices: only the realisations from the first of these up to the second, itself not included.

    Returns:
        One row for each realisation, with units and definitions; None on all ranks of an MPI run but the first.

    Raises:
        StudyError: with everything that is wrong with the study.
    """
    from rfmpm import ensemble
    from rfmpm.study import load_study

    study = load_study(study)
    if realisations is not None:
        study = study.with_changes({"study.realisations": realisations})
    folder = Path(study.output.directory if directory is None else directory)
    return ensemble.run(
        study, folder, realisations=study.study.realisations, workers=workers, fresh=fresh, indices=indices
    )
