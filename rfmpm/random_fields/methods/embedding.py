"""Embedding of a stationary correlation in a periodic one on a torus around a lattice, by choice of the padding.

Two ways to close an axis. *Images*: the correlation plus its copies one torus away, which is always positive definite
and errs by what the correlation leaves at the far side of the padding. *Folded*: lags beyond the lattice run smoothly
to a halt at half the torus, which alters nothing on the lattice but may leave negative eigenvalues; a torus of twice
the lattice is the minimal one of Dietrich and Newsam (1997), a larger one is smoothed as by Helgason, Pipiras and
Abry (2011). What is negative is clipped and the rest scaled back to unit variance (Wood and Chan 1994).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from rfmpm.random_fields.correlation import Anisotropy
from rfmpm.random_fields.lattice import Lattice
from rfmpm.random_fields.methods.nodes import is_aligned

ACCURACY = 5e-4  # largest covariance error that is good enough, unless another is asked
FOLDS = (2.0, 3.0, 4.0, 6.0)  # torus over lattice
MARGIN = 0.9  # share of the accuracy that the far side of the padding may leave
WIDENINGS = (1.0, 1.25, 1.6, 2.2)  # of that padding, where it did not do
FURTHEST_PAD = 64.0  # lattices
MOST_NODES, MOST_NODES_RATIO, FEWEST_NODES = 2**26, 40, 2**17  # of the torus; times the lattice
ROUNDING = 1e-14  # of the largest eigenvalue: negative by less is zero
NOTHING = 1e-12  # a correlation at the next but one image that can be left out


class Spectrum(NamedTuple):
    """Eigenvalues over the number of nodes, which sum to one, on the half torus, shape (rows, columns / 2 + 1) [-].

    `shape`: rows and columns of the torus; `clipped`: share of the eigenvalues that was negative; `error`: largest
    difference from the asked correlation over all lags of the lattice.
    """

    eigenvalues: np.ndarray
    shape: tuple[int, int]
    clipped: float
    error: float


@dataclass(frozen=True)
class Closure:
    """How one axis of `count` nodes closes: the number of nodes of the torus, and whether it is folded."""

    count: int
    nodes: int
    is_folded: bool

    def lags(self, has_far_images: bool) -> list[np.ndarray]:
        """Lags, in spacings, whose correlations add up at each node of the torus, shape (nodes,) each."""
        node = np.arange(self.nodes)
        if not self.is_folded:
            return [node + shift * self.nodes for shift in ((0, -1, 1, -2) if has_far_images else (0, -1))]
        lag, half = np.minimum(node, self.nodes - node).astype(float), 0.5 * self.nodes
        first = min(self.count - 1.0, half)
        if half - first < 1.0:
            return [lag]
        t = np.clip((lag - first) / (half - first), 0.0, 1.0)
        halting = first + (half - first) * (t - t**5 * (7.0 - 14.0 * t + 10.0 * t**2 - 2.5 * t**3))
        return [np.where(lag <= first, lag, halting)]


def embed(correlation: Anisotropy, lattice: Lattice, accuracy: float, most_nodes: int = MOST_NODES) -> Spectrum:
    """The smallest torus whose covariance is the asked one on the lattice, or else the most accurate one in reach.

    Args:
        correlation: correlation of the standard-normal field.
        lattice: the lattice.
        accuracy: largest covariance error over all lags of the lattice that is good enough [-].
        most_nodes: of the torus; the smallest one is tried in any case.

    Returns:
        the spectrum; its error may be above the accuracy.
    """
    best = None
    for along_y, along_x in _closures(correlation, lattice, accuracy, most_nodes):
        found = _spectrum(correlation, lattice, along_y, along_x)
        if best is None or found.error < best.error:
            best = found
        if best.error <= accuracy:
            break
    return best


def is_accurate(correlation: Anisotropy, lattice: Lattice) -> bool:
    """Whether a torus in reach gives the covariance on the lattice to the default accuracy."""
    return embed(correlation, lattice, ACCURACY).error <= ACCURACY


def _closures(
    correlation: Anisotropy, lattice: Lattice, accuracy: float, most_nodes: int
) -> Iterator[tuple[Closure, Closure]]:
    # Every pair of closures in reach, from the smallest torus up.
    pad_y, pad_x = (_pad(correlation, lattice, accuracy, axis) for axis in ("y", "x"))
    folds = FOLDS if is_aligned(correlation) else ()  # a folded axis takes the correlation to be even in its lag
    options = [
        [Closure(count, _fast(max(2, round(fold * (count - 1)))), True) for fold in folds]
        + [Closure(count, _fast(count + round(wide * pad)), False) for wide in WIDENINGS]
        for count, pad in ((lattice.rows, pad_y), (lattice.columns, pad_x))
    ]
    most = min(most_nodes, max(FEWEST_NODES, MOST_NODES_RATIO * lattice.rows * lattice.columns))
    pairs = sorted(product(*options), key=lambda pair: pair[0].nodes * pair[1].nodes)
    return (pair for k, pair in enumerate(pairs) if k == 0 or pair[0].nodes * pair[1].nodes <= most)


def _pad(correlation: Anisotropy, lattice: Lattice, accuracy: float, axis: str) -> int:
    # Nodes beyond which the correlation, at any lag across, has fallen below the accuracy; one more lattice where that
    # is too far.
    count, spacing = (lattice.rows, lattice.dy) if axis == "y" else (lattice.columns, lattice.dx)
    across, step = (lattice.columns, lattice.dx) if axis == "y" else (lattice.rows, lattice.dy)
    side = step * np.linspace(-(across - 1), across - 1, min(2 * across - 1, 201))
    pad = 1
    while pad <= FURTHEST_PAD * (count + 16):
        ahead = spacing * np.linspace(pad, 2 * pad, 9)[:, None] + 0.0 * side
        rho = correlation.rho(side + 0.0 * ahead, ahead) if axis == "y" else correlation.rho(ahead, side + 0.0 * ahead)
        if np.max(np.abs(rho)) <= MARGIN * accuracy:
            return pad
        pad = max(pad + 1, int(1.03 * pad))
    return count


def _fast(least: int) -> int:
    # The next even number whose prime factors are small.
    from scipy.fft import next_fast_len

    return 2 * next_fast_len((least + 1) // 2, real=True)


def _spectrum(correlation: Anisotropy, lattice: Lattice, along_y: Closure, along_x: Closure) -> Spectrum:
    from scipy.fft import irfft2, rfft2

    shape = along_y.nodes, along_x.nodes
    eigenvalues = rfft2(_periodic(correlation, lattice, along_y, along_x), overwrite_x=True, norm="forward").real.copy()
    twice = np.full(eigenvalues.shape[1], 2.0)
    twice[[0, -1]] = 1.0
    eigenvalues[np.abs(eigenvalues) < ROUNDING * eigenvalues.max()] = 0.0
    negative = abs(float(np.minimum(eigenvalues, 0.0).sum(axis=0) @ twice))
    np.maximum(eigenvalues, 0.0, out=eigenvalues)
    total = float(eigenvalues.sum(axis=0) @ twice)
    eigenvalues /= total
    got = irfft2(eigenvalues.astype(complex), s=shape, overwrite_x=True, norm="forward")
    return Spectrum(eigenvalues, shape, negative / (total + negative), _largest_error(correlation, lattice, got))


def _periodic(correlation: Anisotropy, lattice: Lattice, along_y: Closure, along_x: Closure) -> np.ndarray:
    # Covariance on the torus, shape (rows, columns); one row of blocks at a time to keep temporaries small.
    far = correlation.rho(np.array([along_x.nodes * lattice.dx, 0.0]), np.array([0.0, along_y.nodes * lattice.dy]))
    has_far_images = bool(np.max(np.abs(far)) > NOTHING)
    covariance = np.zeros((along_y.nodes, along_x.nodes))
    for lag_x, lag_y in product(along_x.lags(has_far_images), along_y.lags(has_far_images)):
        for start in range(0, len(lag_y), 64):
            y, x = np.meshgrid(lag_y[start : start + 64] * lattice.dy, lag_x * lattice.dx, indexing="ij")
            covariance[start : start + 64] += correlation.rho(x, y)
    return covariance


def _largest_error(correlation: Anisotropy, lattice: Lattice, covariance: np.ndarray) -> float:
    # Over all lags of the lattice; those with a negative x component are mirrored ones.
    worst, row = 0.0, np.arange(-(lattice.rows - 1), lattice.rows)
    for start in range(0, len(row), 64):
        y, x = np.meshgrid(row[start : start + 64] * lattice.dy, lattice.lags_x, indexing="ij")
        got = covariance[row[start : start + 64] % len(covariance), : lattice.columns]
        worst = max(worst, float(np.max(np.abs(got - correlation.rho(x, y)))))
    return worst
