"""Model problems with known answers: a quantity driven by normal components of a field, on two levels, run cheaply."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm, qmc

from rfmpm.estimators import ControlVariate, MonteCarlo, Multilevel, Replicated, Rows, TwoPhase

WEIGHTS = np.array([0.6, 0.4, 0.2, 0.2])  # of the field's components
OTHER, FINE_ONLY = 0.5, 0.15  # standard deviations of what the components do not explain; on level 0 alone
DEVIATION = float(np.sqrt(np.sum(WEIGHTS**2) + OTHER**2 + FINE_ONLY**2))
WORK = (1.0, 0.15)
REPLICATE = 16
SOBOL = qmc.Sobol(WEIGHTS.size, scramble=False).random(REPLICATE)


@dataclass(frozen=True)
class Model:
    """y0 = 10 + 4 g with g normal, or its exponential over 5; level 1 is shifted and narrower, as coarse cells are.

    Correlation of the levels 0.98; the components explain 0.69 of the variance, a run on level 1 has 0.15 of the work.
    """

    is_skewed: bool = False

    def deviation(self) -> float:
        """Standard deviation of the normal quantity behind it."""
        return 4.0 * DEVIATION

    def quantile(self, probability: float) -> float:
        normal = 10.0 + self.deviation() * norm.ppf(probability)
        return float(np.exp(normal / 5.0)) if self.is_skewed else float(normal)

    def mean(self) -> float:
        return float(np.exp(2.0 + self.deviation() ** 2 / 50.0)) if self.is_skewed else 10.0

    def campaign(self, seed: int, n: int = 2**12, is_design: bool = False) -> "Campaign":
        generator = np.random.default_rng(seed)
        components = generator.standard_normal((n, WEIGHTS.size))
        if is_design:
            # Sobol points, each replicate shifted modulo 1 on its own (Cranley and Patterson 1976): quick to draw
            shift = generator.random((n // REPLICATE, 1, WEIGHTS.size))
            components = norm.ppf(((SOBOL + shift) % 1.0).reshape(n, WEIGHTS.size))
        other = generator.standard_normal((n, 2))
        base = components @ WEIGHTS + OTHER * other[:, 0]
        levels = [10.0 + 4.0 * (base + FINE_ONLY * other[:, 1]), 9.5 + 3.9 * base]
        return Campaign(components, [np.exp(y / 5.0) for y in levels] if self.is_skewed else levels)


@dataclass
class Campaign:
    """All that could be simulated; `rows` are what was."""

    components: np.ndarray
    levels: list[np.ndarray]

    def features(self, indices: range) -> np.ndarray:
        return self.components[indices.start : indices.stop]

    def rows(self, numbers, is_censored=None) -> Rows:
        """The first so many indices of each level."""
        value = np.concatenate([y[:n] for y, n in zip(self.levels, numbers, strict=False)])
        level = np.repeat(np.arange(len(numbers)), numbers)
        index = np.concatenate([np.arange(n) for n in numbers])
        censored = np.zeros(value.size, bool) if is_censored is None else np.asarray(is_censored)
        return Rows(level, index, value, censored, np.array(WORK)[level])

    def run(self, estimator) -> Rows:
        """Carry out the stages of a campaign; the same as following `plan`, which passes them all at every call."""
        if isinstance(estimator, TwoPhase):  # whose stages are no numbers
            return self.follow(estimator)
        numbers = following = estimator.first_numbers()
        while following is not None:
            numbers = following
            following = estimator.next_numbers(self.rows(numbers), numbers)
        return self.rows(numbers)

    def follow(self, estimator) -> Rows:
        """Carry out a campaign plan by plan."""
        everything, done = self.rows([len(y) for y in self.levels]), [np.zeros(0, int)] * len(self.levels)
        while todo := estimator.plan(rows := everything.where(_held(everything, done))):
            for level, indices in todo:
                assert not np.isin(indices, done[level]).any()
                done[level] = np.union1d(done[level], indices)
        return rows


def _held(rows: Rows, done: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([np.isin(rows.index[rows.level == level], indices) for level, indices in enumerate(done)])


MAKERS = {
    "monte_carlo": lambda question, campaign, n: MonteCarlo(question, n),
    "replicated": lambda question, campaign, n: Replicated(question, REPLICATE, n),
    "multilevel": lambda question, campaign, n: Multilevel(question, 1, n),
    "control_variate": lambda question, campaign, n: ControlVariate(question, 1, campaign.features, n),
    "control_variate, levels alone": lambda question, campaign, n: ControlVariate(question, 1, None, n),
    "two_phase": lambda question, campaign, n: TwoPhase(question, campaign.features, n),
    "control_variate, features alone": lambda question, campaign, n: ControlVariate(question, 0, campaign.features, n),
}


@dataclass(frozen=True)
class Repeats:
    """Estimates of many campaigns with different seeds."""

    value: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    standard_error: np.ndarray
    work: np.ndarray

    def coverage(self, truth: float) -> float:
        return float(np.mean((self.lower <= truth) & (truth <= self.upper)))


def repeat(name: str, model: Model, question, n: int | None, repeats: int) -> Repeats:
    """Run and estimate independent campaigns."""
    lines = []
    for seed in range(repeats):
        campaign = model.campaign(seed, is_design=name == "replicated")
        estimator = MAKERS[name](question, campaign, n)
        rows = campaign.run(estimator)
        found = estimator.estimate(rows)
        lines.append((found.value, found.lower, found.upper, found.standard_error, rows.work.sum()))
    return Repeats(*np.array(lines).T)
