"""Where a random field drives a quantity: correlation at each point, and what chance alone would show.

Fields come in blocks of rows, so that no more than one block is in memory.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import sqrt

import numpy as np

PERMUTATIONS = 200
SEED = 40  # of the permutations: the same rows give the same levels
FEWEST = 10  # rows


@dataclass(frozen=True)
class Influence:
    """Correlation of a field with a quantity.

    Attributes:
        correlation: at each point, shape (points,) [-]; 0 where the field does not vary.
        noise_at_a_point: what the size of the correlation stays below in 95 % of cases at one point chosen beforehand
            where there is no dependence [-].
        noise_anywhere: what the largest size over all points stays below in 95 % of cases where there is no dependence
            anywhere [-]; from the same fields with the quantity permuted.
        rows: that it rests on.
    """

    correlation: np.ndarray
    noise_at_a_point: float
    noise_anywhere: float
    rows: int

    @property
    def is_significant(self) -> np.ndarray:
        """Whether the correlation at each point is more than chance shows anywhere, shape (points,)."""
        return np.abs(self.correlation) > self.noise_anywhere


def influence(blocks: Iterable[np.ndarray], quantity: np.ndarray) -> Influence:
    """Correlate a field with a quantity at every point.

    Args:
        blocks: fields of successive rows, shape (rows of the block, points) each [-].
        quantity: of all n rows, in their order, shape (n,).

    Returns:
        The correlation and its noise levels.

    Raises:
        ValueError: for fewer than 10 rows, a quantity that does not vary or is not finite, or another number of fields.
    """
    y = np.asarray(quantity, float)
    if len(y) < FEWEST or not np.all(np.isfinite(y)) or np.ptp(y) == 0.0:
        raise ValueError(f"a correlation takes at least {FEWEST} finite values that are not all equal")
    rng = np.random.default_rng(SEED)
    shuffled = np.column_stack([y] + [rng.permutation(y) for _ in range(PERMUTATIONS)])
    standard = (shuffled - y.mean()) / y.std()
    start, total, squares, products = 0, 0.0, 0.0, 0.0
    for block in blocks:
        part = standard[start : start + len(block)]
        if len(part) != len(block):
            raise ValueError(f"more fields than the {len(y)} values of the quantity")
        total = total + block.sum(axis=0)
        squares = squares + (block**2).sum(axis=0)
        products = products + block.T @ part
        start += len(block)
    if start != len(y):
        raise ValueError(f"{start} fields for {len(y)} values of the quantity")
    # Sums of `standard` are zero, so that the mean of the field drops out of the products.
    deviation = np.sqrt(np.maximum(squares / start - (total / start) ** 2, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        found = np.where(deviation[:, None] > 1e-9, products / start / deviation[:, None], 0.0)
    highest = np.abs(found[:, 1:]).max(axis=0)
    return Influence(found[:, 0], 1.96 / sqrt(start), float(np.quantile(highest, 0.95)), start)
