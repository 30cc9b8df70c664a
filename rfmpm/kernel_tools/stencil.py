"""The nodes around each point of a block along one axis: where they begin, their weights and slopes."""

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from rfmpm.kernel_tools.jit import define, inline_options, inlined

BLOCK = 520  # points; what the stages pass on stays in the first two caches, and rows of a table in sets of their own


class Stencil(NamedTuple):
    """One array holds all points' first weights, then all their second ones, ...: one address serves them all."""

    first: np.ndarray  # node, shape (BLOCK,)
    table: np.ndarray  # weights, then slopes, shape (2 * len(like) * BLOCK,)
    like: tuple  # as many numbers as there are weights


@inlined
def make_stencil(like):
    """Make room for the weights of a block of points; there are as many as the tuple `like` has numbers."""
    return Stencil(np.empty(BLOCK, np.int32), np.empty(2 * len(like) * BLOCK), like)


def put_stencil(stencil, p, first, weights, slopes):
    """Write first node, weights [-] and slopes [1/m] of point p of the block."""
    stencil.first[p] = first
    for k, value in enumerate(weights + slopes):
        stencil.table[p + k * BLOCK] = value


@overload(put_stencil, **inline_options)
def _(stencil, p, first, weights, slopes):
    count = len(weights)
    lines = ["def put(stencil, p, first, weights, slopes):", "    stencil.first[p] = first"]
    for k in range(count):
        lines.append(f"    stencil.table[p + {k * BLOCK}] = weights[{k}]")
        lines.append(f"    stencil.table[p + {(count + k) * BLOCK}] = slopes[{k}]")
    return define("put", "\n".join(lines), {})


def weights_at(stencil, p):
    """First node, weights and slopes of point p of the block, shape (width,)."""
    columns = stencil.table.reshape(-1, BLOCK)[:, p]
    return stencil.first[p], *np.split(columns, 2)
