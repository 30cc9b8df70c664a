"""Which estimator of small probabilities for which problem: campaigns on functions of standard-normal numbers.

The quantity is a function of 51 numbers, of which an estimator's features hold the first 50.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ndtr, ndtri

from rfmpm.benchmark.probabilities.repeats import Judged, Outcome, judge
from rfmpm.estimators import Question, Rows, Stratified, SubsetSimulation
from rfmpm.estimators.chains import PLAIN

FEATURES = 50
MOST = 1100
REPEATS = 40
LEVEL = {1e-3: 190, 1e-5: 110}  # runs of a level of subset simulation: two go as far within MOST


class Problem(NamedTuple):
    """A quantity, given vectors of shape (n, FEATURES + 1), and the probability that it exceeds the limit."""

    name: str
    quantity: Callable[[np.ndarray], np.ndarray]
    limit: float
    probability: float


def problems() -> Iterator[Problem]:
    """Make the problems, each with an exact probability."""
    root = np.sqrt(FEATURES)

    def linear(xi):
        return 0.9 * xi[:, :-1].sum(axis=1) / root + np.sqrt(1.0 - 0.9**2) * xi[:, -1]

    def curved(xi):
        return xi[:, 0] + 0.2 * (xi[:, 1] ** 2 + xi[:, 2] ** 2)

    for probability in LEVEL:
        beyond = float(-ndtri(probability))
        bent = brentq(lambda at, aim=probability: _curved_exceedance(at) - aim, 0.0, 30.0)
        yield Problem("linear, correlation 0.9", linear, beyond, probability)
        yield Problem("curved in two directions", curved, bent, probability)
        two = float(-ndtri(0.5 * probability))
        yield Problem("on two sides", lambda xi: np.abs(xi[:, 0]), two, probability)
        yield Problem("not in the features", lambda xi: xi[:, -1], beyond, probability)


def _curved_exceedance(limit: float) -> float:
    """P(X + 0.2 (Y^2 + Z^2) > limit); Y^2 + Z^2 = 2 E with E exponential."""
    edge = limit / 0.4
    return quad(lambda e: np.exp(-e) * ndtr(0.4 * e - limit), 0.0, edge)[0] + float(
        quad(lambda e: np.exp(-e) * ndtr(0.4 * e - limit), edge, edge + 60.0)[0]
    )


def table(repeats: int, tell: Callable[[str], None]) -> Iterator[str]:
    """Judge both estimators on every problem.

    Args:
        repeats: campaigns of each.
        tell: is told the progress.

    Yields:
        Lines of the table.
    """
    yield "| problem | probability | plain: error | stratified: error, coverage | subset simulation: error, coverage |"
    yield "|---|---|---|---|---|"
    for problem in problems():
        p, cells = problem.probability, []
        for way in (stratified, subset_simulation):
            judged = judge([way(problem, seed) for seed in range(repeats)], p)
            cells.append(_cell(judged, p))
            tell(f"{problem.name}, {p:g}, {way.__name__}: {cells[-1]}")
        plain = np.sqrt((1.0 - p) / p / MOST)
        yield f"| {problem.name} | {p:g} | {plain:.0%} | {cells[0]} | {cells[1]} |"


def _cell(judged: Judged, probability: float) -> str:
    return f"{judged.root_mean_square_error / probability:.0%}, {judged.coverage:.2f}"


def stratified(problem: Problem, seed: int) -> Outcome:
    """Carry out one campaign of stratified sampling."""
    plain = np.random.default_rng(seed).standard_normal((MOST, FEATURES + 1))
    question = Question("run_out", "exceedance", limit=problem.limit, at_most=MOST)
    estimator = Stratified(question, lambda span: plain[span.start : span.stop, :-1])
    values = np.zeros(0)
    while planned := estimator.plan(_rows(values)):
        span = planned[0].indices
        own, xi = estimator.rounds(_rows(values))[-1], plain[span.start : span.stop].copy()
        xi[:, :-1] = own.placed(span, xi[:, :-1])
        values = np.concatenate([values, problem.quantity(xi)])
    return _outcome(estimator, values)


def subset_simulation(problem: Problem, seed: int) -> Outcome:
    """Carry out one campaign of subset simulation."""
    plain = np.random.default_rng(seed).standard_normal((MOST, FEATURES + 1))
    question = Question("run_out", "exceedance", limit=problem.limit, at_most=MOST)
    estimator = SubsetSimulation(question, LEVEL[problem.probability])
    xi, values = plain[:0], np.zeros(0)
    while planned := estimator.plan(_rows(values)):
        span, course = planned[0].indices, estimator.course(_rows(values))
        z, parent = plain[span.start : span.stop], course.parent[span.start : span.stop]
        width = course.width[span.start : span.stop, None]
        if len(xi):
            z = np.where((parent == PLAIN)[:, None], z, np.sqrt(1.0 - width**2) * xi[parent] + width * z)
        xi, values = np.concatenate([xi, z]), np.concatenate([values, problem.quantity(z)])
    return _outcome(estimator, values)


def _rows(values: np.ndarray) -> Rows:
    n = len(values)
    return Rows(np.zeros(n, int), np.arange(n), values, np.zeros(n, bool), np.ones(n))


def _outcome(estimator: Stratified | SubsetSimulation, values: np.ndarray) -> Outcome:
    found = estimator.estimate(_rows(values))
    return Outcome(found.value, found.lower, found.upper, len(values))
