"""What a campaign cost: computing time, and the electricity that goes with it."""

import math
from datetime import datetime

import numpy as np

WATTS_PER_CORE = 10.0  # assumed: a server's share for one busy core, its memory and its cooling


def cost(dataset) -> dict[str, float]:
    """Add up what all simulations of a campaign took, on coarser cells too.

    Args:
        dataset: the ensemble.

    Returns:
        Times in seconds: computing, per_realisation (mean of those on the study's own cells), coarser (where there are
        such), elapsed (where it is known); electricity_j, the computing time times WATTS_PER_CORE.
    """
    wall, own = dataset["wall_time"].values, dataset["level"].values == 0
    known = ~np.isnan(wall)
    found = {
        "computing": float(wall[known].sum()),
        "per_realisation": float(wall[known & own].mean()) if np.any(known & own) else math.nan,
        "electricity_j": float(wall[known].sum()) * WATTS_PER_CORE,
    }
    if not own.all():
        found["coarser"] = float(wall[known & ~own].sum())
    if {"start", "end"} <= dataset.attrs.keys():
        start, end = (datetime.fromisoformat(dataset.attrs[key]) for key in ("start", "end"))
        found["elapsed"] = (end - start).total_seconds()
    return found
