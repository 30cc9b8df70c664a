"""A quantile and its interval from an exceedance curve and its pointwise intervals."""

from collections.abc import Callable

import numpy as np

from rfmpm.estimators.protocol import Expectation

AT_A_TIME = 64


def invert(curve: Callable[[np.ndarray], Expectation], values: np.ndarray, tail: float) -> tuple[float, float, float]:
    """Find where an exceedance curve and the edges of its interval fall to a given probability.

    Args:
        curve: limits, shape (k,) -> probabilities of exceeding them.
        values: ascending, distinct; where the curve has its steps, shape (n,).
        tail: probability of exceeding the quantile [-].

    Returns:
        The quantile, the lower and the upper bound: for each a value at which the curve, its lower and its upper edge
        fall to the tail; lower -inf or upper inf where an edge is below it from the start, or stays above.

    Source: Woodruff (1952), J. Am. Stat. Assoc. 47, 635-646.
    """
    if not values.size:
        return float("nan"), float("-inf"), float("inf")
    value, lower, upper = (_first(curve, values, tail, name) for name in ("value", "lower", "upper"))
    is_below = lower == 0 and curve(np.nextafter(values[:1], -np.inf)).lower[0] <= tail
    return (
        float(values[min(value, values.size - 1)]),
        float(values[lower]) if lower < values.size and not is_below else float("-inf"),
        float(values[upper]) if upper < values.size else float("inf"),
    )


def _first(curve: Callable[[np.ndarray], Expectation], values: np.ndarray, tail: float, name: str) -> int:
    """Place of the first value at which the falling curve is at most the tail; their number if it is at none."""
    low, high = -1, values.size  # above the tail at low, at most the tail at high
    while high - low > 1:
        places = np.unique(np.linspace(low, high, AT_A_TIME + 2).round().astype(int)[1:-1])
        places = places[(places > low) & (places < high)]
        below = getattr(curve(values[places]), name) <= tail
        if below.any():
            first = int(np.argmax(below))
            low, high = (int(places[first - 1]) if first else low), int(places[first])
        else:
            low = int(places[-1])
    return high
