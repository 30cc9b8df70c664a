"""What a sequence of grids says about the value on an infinitely fine one."""

from math import inf, log, nan
from typing import NamedTuple

HIGHEST_ORDER, LOWEST_ORDER = 2.0, 0.5
SAFETY_MONOTONE, SAFETY_OTHER = 1.25, 3.0


class Limit(NamedTuple):
    """Value extrapolated to cells of no size."""

    value: float
    band: float  # half width within which the limit is believed to lie
    order: float  # observed, NaN where the sequence does not run one way


def extrapolate(values, ratio: float = 2.0) -> Limit:
    """Extrapolate values on ever finer grids (Richardson 1911), with the band of Roache's grid convergence index.

    The order is that of the last three values, kept between 0.5 and 2. Where they do not approach a limit from one side
    with falling differences, nothing is extrapolated: the finest value stands, with three times the last difference.

    Args:
        values: from the coarsest to the finest grid, at least three.
        ratio: of one cell size to the next finer one.

    Returns:
        The limit.

    Raises:
        ValueError: for fewer than three values.
    """
    if len(values) < 3:
        raise ValueError(f"{len(values)} values: at least three grids are needed")
    coarse, middle, fine = (float(value) for value in values[-3:])
    before, last = middle - coarse, fine - middle
    if last == 0.0:
        return Limit(fine, 0.0, inf)
    quotient = before / last
    if quotient <= 1.0:
        return Limit(fine, SAFETY_OTHER * abs(last), nan)
    order = log(quotient) / log(ratio)
    used = min(max(order, LOWEST_ORDER), HIGHEST_ORDER)
    step = last / (ratio**used - 1.0)
    return Limit(fine + step, SAFETY_MONOTONE * abs(step), order)
