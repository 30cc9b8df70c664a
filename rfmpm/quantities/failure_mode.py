"""The kind of failure, told from the quantities of finished realisations."""

import numpy as np

MODES = ("no_failure", "single_slide", "retrogressive", "reaches_boundary")  # the codes are the places in this list
UNKNOWN = -1  # of a realisation that failed to complete
GROWTH = 1.1  # ratio of all that failed to the first slide from which later slides count


def failure_modes(failure_volume, initial_failure_volume, block_count, is_censored) -> np.ndarray:
    """Classify realisations by how their slope failed; the first description that fits counts.

    reaches_boundary: the slide met an edge of the model, so that it might have gone on. no_failure: no soil failed.
    retrogressive: it failed in stages: what failed after the first slide adds more than a tenth to it, or the failed
    mass ended in two or more blocks that stayed whole. single_slide: any other.

    Args:
        failure_volume: volume of all that failed, shape (n,) [m3/m]; NaN where the realisation did not complete.
        initial_failure_volume: volume of the first slide, shape (n,) [m3/m].
        block_count: blocks of the failed mass that stayed whole, shape (n,) [-].
        is_censored: whether run-out or retrogression met an edge of the model, shape (n,).

    Returns:
        Place of each realisation's mode in MODES, or UNKNOWN; shape (n,).
    """
    volume = np.asarray(failure_volume, float)
    in_stages = (volume > GROWTH * np.asarray(initial_failure_volume, float)) | (np.asarray(block_count) >= 2)
    cases = [np.isnan(volume), np.asarray(is_censored, bool), volume == 0.0, in_stages]
    codes = [UNKNOWN, MODES.index("reaches_boundary"), MODES.index("no_failure"), MODES.index("retrogressive")]
    return np.select(cases, codes, MODES.index("single_slide"))
