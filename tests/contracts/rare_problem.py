"""Model problems for small probabilities: quantities that are functions of independent standard-normal numbers."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from rfmpm.estimators import Question, Rows, Stratified

VARIABLES = 50
SCATTER = 0.9, np.sqrt(1.0 - 0.9**2)  # correlation of a linear quantity with its features, and the rest


class Problem(NamedTuple):
    """Quantity of features of shape (n, VARIABLES) and of noise (n,), and its probability of exceeding the limit."""

    quantity: Callable[[np.ndarray, np.ndarray], np.ndarray]
    limit: float
    probability: float


def linear(probability: float) -> Problem:
    """All features matter alike, and something that they do not hold."""
    weight, rest = SCATTER
    return Problem(
        lambda eta, noise: weight * eta.sum(axis=1) / np.sqrt(VARIABLES) + rest * noise,
        float(-ndtri(probability)),
        probability,
    )


def curved(probability: float) -> Problem:
    """A limit state that bends towards the origin in two directions: X + 0.2 (Y^2 + Z^2)."""
    from scipy.integrate import quad
    from scipy.optimize import brentq
    from scipy.special import ndtr

    def exceedance(limit: float) -> float:  # Y^2 + Z^2 = 2 E with E exponential
        return quad(lambda e: np.exp(-e) * ndtr(0.4 * e - limit), 0.0, 60.0, points=[limit / 0.4], epsabs=1e-12)[0]

    limit = brentq(lambda at: exceedance(at) - probability, 0.0, 20.0)
    return Problem(lambda eta, noise: eta[:, 0] + 0.2 * (eta[:, 1] ** 2 + eta[:, 2] ** 2), limit, probability)


def two_sided(probability: float) -> Problem:
    """Far out on either side: no direction is better than another."""
    return Problem(lambda eta, noise: np.abs(eta[:, 0]), float(-ndtri(0.5 * probability)), probability)


def unrelated(probability: float) -> Problem:
    """What the features say nothing of."""
    return Problem(lambda eta, noise: noise, float(-ndtri(probability)), probability)


PROBLEMS = {"linear": linear, "curved": curved, "two sided": two_sided, "unrelated": unrelated}


def rows_of(values, is_censored=None) -> Rows:
    n = len(values)
    censored = np.zeros(n, bool) if is_censored is None else np.asarray(is_censored, bool)
    return Rows(np.zeros(n, int), np.arange(n), np.asarray(values, float), censored, np.ones(n))


class Campaign:
    """Carries out what a stratified estimator plans; all of it follows from the seed."""

    def __init__(self, problem: Problem, seed: int, most: int, pilot_size: int = 100, **wanted):
        generator = np.random.default_rng(seed)
        self.problem = problem
        self.plain = generator.standard_normal((2 * most, VARIABLES))
        self.noise = generator.standard_normal(2 * most)
        question = Question("run_out", "exceedance", limit=problem.limit, at_most=most, **wanted)
        self.estimator = Stratified(question, self.features, pilot_size)

    def features(self, indices: range) -> np.ndarray:
        return self.plain[indices.start : indices.stop]

    def run(self) -> Rows:
        rows = rows_of([])
        while todo := self.estimator.plan(rows):
            (runs,) = todo
            own = self.estimator.rounds(rows)[-1]
            eta = own.placed(runs.indices, self.features(runs.indices))
            new = self.problem.quantity(eta, self.noise[runs.indices.start : runs.indices.stop])
            rows = rows_of(np.concatenate([rows.value, new]))
        return rows


class Repeats(NamedTuple):
    """Estimates of many campaigns with different seeds."""

    value: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    def coverage(self, truth: float) -> float:
        return float(np.mean((self.lower <= truth) & (truth <= self.upper)))


def repeat(problem: Problem, most: int, repeats: int, **options) -> Repeats:
    lines = []
    for seed in range(repeats):
        campaign = Campaign(problem, seed, most, **options)
        found = campaign.estimator.estimate(campaign.run())
        lines.append((found.value, found.lower, found.upper))
    return Repeats(*np.array(lines).T)
