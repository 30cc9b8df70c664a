"""Planar granular columns: two published laws of their run-out, and ours."""

from math import inf

from rfmpm.benchmark.frictional.cases import collapse

NAME = "lube_2005_columns"
HALF_WIDTH = 0.1  # [m]
ASPECTS = (0.5, 1.0, 2.0, 3.0, 5.0, 8.0)
ROOM = 2.4  # foreland over the run-out of the law


def lube(aspect: float) -> tuple[float, float]:
    """Run-out over half width by Lube et al. (2005), the lower and the higher one: they leave 1.8 to 2.8 open."""
    flat, tall = 1.2 * aspect, 1.9 * aspect ** (2.0 / 3.0)
    if aspect < 1.8:
        return flat, flat
    return (flat, tall) if aspect < 2.8 else (tall, tall)


def lajeunesse(aspect: float) -> float:
    """Run-out over half width by Lajeunesse et al. (2005), planar: 1.8 a below an aspect ratio of 3, then 2.3 a^(2/3).

    The coefficients are read as such from a list of three numbers, 1.8, 2.3 and 3.0; of the possible readings this is
    the narrowest.
    """
    return 1.8 * aspect if aspect < 3.0 else 2.3 * aspect ** (2.0 / 3.0)


def span(aspect: float) -> tuple[float, float]:
    """Lowest and highest run-out over half width by the two laws."""
    both = (*lube(aspect), lajeunesse(aspect))
    return min(both), max(both)


def run_out(aspect: float, cells: int, friction: float | None = None) -> float:
    """Run-out over half width.

    Args:
        aspect: height over half width.
        cells: in the half width.
        friction: angle [degrees]; None for the study's.

    Returns:
        The run-out [-]; infinite where the far wall stopped it.

    Raises:
        RuntimeError: the run broke.
    """
    cell = HALF_WIDTH / cells
    changes = {
        "geometry.height_m": HALF_WIDTH * aspect,
        "geometry.foreland_m": HALF_WIDTH * round(ROOM * lube(aspect)[1] + 1.0),
        "discretisation.cell_m": cell,
    }
    if friction is not None:
        changes["material.0.friction_angle_deg"] = friction
    outcome = collapse(NAME, changes)
    if outcome.status not in ("ok", "not_at_rest"):
        raise RuntimeError(f"column of aspect ratio {aspect:g}: {outcome.reason}")
    return inf if outcome.quantities["run_out_censored"] else outcome.quantities["run_out"] / HALF_WIDTH
