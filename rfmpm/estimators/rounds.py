"""How a stratified campaign unfolds: plain runs first, then rounds along the direction that the runs so far point out.

The quantity is regressed on the features of the random fields, independent standard-normal numbers; the score s of a
realisation is how far its features lie along the fitted weights, a standard-normal number too. Strata of s have exact
probabilities whatever the fit, which decides only how many runs each gets: as Neyman (1934) has it, in proportion to
its probability and the standard deviation of the event within it. Edges are such that the strata of a round get equally
many runs, so that any number of runs of a round is a part of it.

Neyman (1934), Journal of the Royal Statistical Society 97, 558-625; an important direction as in the line sampling of
Koutsourelakis, Pradlwarter and Schueller (2004), Probabilistic Engineering Mechanics 19, 409-417.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri

from rfmpm.estimators.regression import fit
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.surrogate import line

STRATA = 20
BULK = 0.1  # share of the runs of a round that are spread as plain ones, should the fit be wrong
FOLDS = 5
UPPER = 0.4  # share of the runs, those with the largest predictions, from which the scatter near the limit is read
WIDER = 1.2  # scatter about the fit over the measured one: runs that exceed against the odds count much, and are few
FEWEST = 20  # runs to fit to
GRID = np.linspace(-9.0, 9.0, 3601)  # of scores
INSIDE = 1e-15

Features = Callable[[range], np.ndarray]


@dataclass(frozen=True)
class Round:
    """Realisations from `start` to before `stop`: number k of them is in stratum k modulo their number.

    Attributes:
        start: first index.
        stop: index after the last, at most.
        direction: a, unit vector in the space of the features, shape (d,) [-]; None: plain realisations.
        edges: probabilities that a score is above the edges of the strata, falling from 1 to 0, shape (strata + 1,).
        chance: of the event in each stratum, as the fit has it, shape (strata,) [-].
    """

    start: int
    stop: int
    direction: np.ndarray | None
    edges: np.ndarray
    chance: np.ndarray

    @property
    def probability(self) -> np.ndarray:
        """Probability of each stratum, shape (strata,) [-]."""
        return -np.diff(self.edges)

    def stratum(self, index: np.ndarray | int) -> np.ndarray:
        """Number of the stratum that realisations are in."""
        return (index - self.start) % self.chance.size

    @property
    def gain(self) -> float:
        """How many plain runs have the variance of one of this round, if the fit is right; 1 for plain ones."""
        total = float(self.probability @ self.chance)
        variance = self.chance.size * float(np.sum(self.probability**2 * self.chance * (1.0 - self.chance)))
        return total * (1.0 - total) / variance

    def placed(self, indices: range, plain: np.ndarray) -> np.ndarray:
        """Move plain features into the strata of their realisations.

        Args:
            indices: of realisations of the round.
            plain: their independent standard-normal numbers, shape (n, d) [-].

        Returns:
            Features, shape (n, d) [-]: as distributed within the stratum.
        """
        if self.direction is None:
            return plain
        score = plain @ self.direction
        stratum = self.stratum(np.arange(indices.start, indices.stop))
        above, below = self.edges[stratum + 1], self.edges[stratum]
        moved = -ndtri(np.clip(above + (below - above) * ndtr(-score), 1e-300, 1.0 - INSIDE))
        return plain + (moved - score)[:, None] * self.direction


def rounds(rows: Rows, features: Features, limit: float, pilot: int) -> Iterator[Round]:
    """Name the rounds that finished rows lead to: of `pilot` plain runs, then each of as many as all before it.

    Args:
        rows: finished ones; those of level 0 from index 0 on without a gap count.
        features: independent standard-normal numbers of realisations were they plain, shape (n, d).
        limit: whose exceedance is the event, unit of the quantity.
        pilot: plain runs of the first round.

    Yields:
        Rounds; the last one is not finished.
    """
    n = rows.numbers(1)[0]
    own = rows.on_level(0)
    current, placed = _plain(0, pilot), []
    while current.stop <= n:
        yield current
        span = range(current.start, current.stop)
        placed.append(current.placed(span, features(span)))
        current = _following(own.first([current.stop]), np.concatenate(placed), limit, current.stop)
    yield current


def _plain(start: int, stop: int) -> Round:
    return Round(start, stop, None, np.array([1.0, 0.0]), np.array([0.5]))


def _following(own: Rows, features: np.ndarray, limit: float, start: int) -> Round:
    """Fit to the completed rows and set the strata of the next round."""
    done = ~own.is_failed
    value, features = own.value[done], features[done]
    if own.is_censored.any():  # at least what was seen: as far as the farthest
        value = np.where(own.is_censored[done], max(limit, value.max()), value)
    if value.size < FEWEST or np.ptp(value) == 0.0 or not features.shape[1]:
        return _plain(start, 2 * start)
    kept = np.maximum(value, np.median(value))  # what the lower half does says little of the upper end
    weights = fit(kept[:, None], None, features).weights[:, 0]
    size = float(np.linalg.norm(weights))
    if size == 0.0:
        return _plain(start, 2 * start)
    predicted = _predicted(kept, features)
    upper = predicted >= np.quantile(predicted, 1.0 - UPPER)
    constant, slope, error = line(value[upper], predicted[upper])
    error = max(WIDER * error, 1e-9 * float(np.ptp(value)))
    chance = _chance((constant - limit) / error, max(slope, 0.0) * size / error)
    edges = _edges(chance)
    return Round(start, 2 * start, weights / size, edges, _means(chance, edges))


def _predicted(value: np.ndarray, features: np.ndarray) -> np.ndarray:
    """Predict each value from weights that were fitted without it, shape (n,); the mean is left out."""
    fold = np.arange(value.size) % FOLDS
    found = np.empty(value.size)
    for one in range(FOLDS):
        out = fold == one
        found[out] = features[out] @ fit(value[~out][:, None], None, features[~out]).weights[:, 0]
    return found


def _chance(constant: float, slope: float) -> np.ndarray:
    """Probability of the event on the grid of scores: of a normal error about the fitted line."""
    return np.clip(ndtr(constant + slope * GRID), INSIDE, 1.0 - INSIDE)


def _edges(chance: np.ndarray) -> np.ndarray:
    """Edges, as probabilities above them, between which Neyman's allocation has equal shares."""
    density = np.exp(-0.5 * GRID**2)
    density /= density.sum()
    share = density * np.sqrt(chance * (1.0 - chance))
    share = (1.0 - BULK) * share / share.sum() + BULK * density
    wanted = np.arange(1, STRATA) / STRATA
    inner = ndtr(-np.interp(wanted, np.cumsum(share), GRID))
    return np.concatenate([[1.0], inner, [0.0]])


def _means(chance: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Mean of the chance over each stratum."""
    density = np.exp(-0.5 * GRID**2) + 1e-300
    stratum = np.searchsorted(-edges[1:-1], -ndtr(-GRID))
    weight = np.bincount(stratum, density, edges.size - 1)
    total = np.bincount(stratum, density * chance, edges.size - 1)
    return np.where(weight > 0.0, total / np.where(weight > 0.0, weight, 1.0), 0.5)
