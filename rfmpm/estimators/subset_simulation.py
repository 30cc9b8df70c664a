"""Subset simulation: a small probability as a product of larger ones, each from runs that start above a threshold.

The first level is plain. The best of its runs are the seeds of chains that stay above what they exceed, and so on until
the limit is a level. The states of a level are not independent: the variance of its conditional probability is that
between its chains. Levels depend on each other too, which several subset simulations side by side show: the interval is
lognormal, from the larger of the variance within them, summed over levels, and that between them.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from rfmpm.estimators.chains import PLAIN, Course, Level, Sizes, SubsetRun, follow
from rfmpm.estimators.curves import Band
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.estimators.monte_carlo import Estimate, exceedance
from rfmpm.estimators.protocol import Runs
from rfmpm.estimators.question import Question
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.staged import MARGIN, MOST_GROWTH

FIRST_RUNS = 2  # independent subset simulations; their scatter shows what the chains of one do not
FREEDOM = 15  # degrees of freedom of the interval; measured: covers 0.92 to 0.98 for p of 1e-2 to 1e-4
MOST_POINTS = 200  # of an exceedance curve


@dataclass(frozen=True)
class _Tail:
    """P(X > limit) of one subset simulation: estimate, its squared relative error, and what failed runs may add."""

    value: float
    variance: float
    upper_factor: float  # with failed runs as exceeding, over `value`
    lower_factor: float
    before: float  # the probability of the level that the limit lies in
    n_levels: int


class SubsetSimulation:
    """Small probabilities of exceeding a limit, with chains in the random vector; made with `sampling.MarkovChains`."""

    method = "subset simulation"

    def __init__(
        self,
        question: Question,
        level_size: int = 500,
        level_probability: float = 0.1,
        realisations: int | None = None,
    ):
        """Ask for a probability.

        Args:
            question: kind "exceedance"; with a wanted half width, subset simulations are added until it is reached.
            level_size: runs of the first level of one subset simulation, states of the others [-].
            level_probability: share of them that starts the next level [-].
            realisations: runs at most; None: `question.at_most`.

        Raises:
            ValueError: another kind of question; sizes that do not fit each other; too few runs for the first levels.
        """
        if question.kind != "exceedance":
            raise ValueError(
                'estimator.method = "subset_simulation" finds probabilities of exceeding a limit only: give '
                "study.until an exceeds_m (exceeds_m3_per_m), or take another method"
            )
        chains = round(level_size * level_probability)
        if not 0.0 < level_probability <= 0.5 or chains < 2 or level_size % chains or level_size < 2 * chains:
            raise ValueError(
                f"estimator.level_size = {level_size} with level_probability = {level_probability:g}: the probability "
                "has to be at most 0.5, their product at least 2, and the size a multiple of it, as 500 is of 500 x 0.1"
            )
        self.question = question
        self.sizes = Sizes(level_size, chains)
        most = realisations if realisations is not None else question.at_most
        self.most = math.inf if most is None else most
        if self.most < FIRST_RUNS * level_size:
            raise ValueError(
                f"at most {self.most:g} realisations: subset simulation begins with {FIRST_RUNS} x {level_size}; raise "
                "study.until.at_most, or lower estimator.level_size"
            )

    def course(self, rows: Rows) -> Course:
        """Follow what the finished rows, of which those of level 0 count, have led to."""
        return follow(rows, self.sizes, self.question.limit, FIRST_RUNS, self._more, self.most)

    def plan(self, rows: Rows) -> list[Runs]:
        """Name the rest of the present turn; empty when the question is answered or the runs are used up."""
        course = self.course(rows)
        todo = np.setdiff1d(np.arange(course.done, len(course.parent)), rows.index[rows.level == 0])
        parts = np.split(todo, np.flatnonzero(np.diff(todo) > 1) + 1)
        return [Runs(0, range(int(part[0]), int(part[-1]) + 1)) for part in parts if part.size]

    def estimate(self, rows: Rows) -> Estimate:
        """Estimate the probability of exceeding the limit from the complete levels.

        Where the first level answers, its runs are plain and the interval is Clopper and Pearson's.

        Args:
            rows: all that is finished.

        Returns:
            Estimate [-]; failed runs enter the upper bound, and censored ones count as exceeding.
        """
        course = self.course(rows)
        return self._estimate(rows, course, self.question.limit)

    def exceedance_curve(self, rows: Rows, limits: np.ndarray | None = None) -> Band:
        """Estimate P(X > l) as a function of l down to the probability in question, with a band for each l.

        Args:
            rows: all that is finished.
            limits: shape (k,), unit of the quantity; None takes up to MOST_POINTS of the values, evenly by rank.

        Returns:
            Band over the limits, without a simultaneous one.
        """
        course = self.course(rows)
        if limits is None:
            seen = [level.values[np.isfinite(level.values)] for run in course.runs for level in run.levels]
            values = np.unique(np.concatenate([*seen, np.zeros(0)]))
            limits = values[np.unique(np.linspace(0, max(values.size - 1, 0), MOST_POINTS).astype(int))[: values.size]]
        limits = np.asarray(limits, float)
        found = [self._estimate(rows, course, float(limit)) for limit in limits]
        columns = (np.array([getattr(one, name) for one in found]) for name in ("value", "lower", "upper"))
        return Band(limits, *columns, self.question.confidence)

    def _more(self, runs: list[SubsetRun]) -> int:
        if not self.question.is_open_ended:
            return 0
        excess = self.question.excess(self._combined(runs, self.question.limit, len(runs)))
        if excess <= 1.0:
            return 0
        growth = min(MOST_GROWTH, MARGIN * excess**2)
        return max(1, math.ceil((growth - 1.0) * len(runs)))

    def _estimate(self, rows: Rows, course: Course, limit: float) -> Estimate:
        usable = [run for run in course.runs if run.levels]  # those that end first are not a fair sample of all
        own = rows.on_level(0)
        if not usable or all(_tail(run.levels, limit).n_levels == 1 for run in usable):
            number = min(own.numbers(1)[0], len(course.parent))
            first = own.first([number]).where(course.parent[:number] == PLAIN)
            found = exceedance(first.value, limit, first.is_censored, self.question.confidence)
            notes = [found.note] if found.note else []
            notes += _plateau(usable, limit)
            error = math.sqrt(found.value * (1.0 - found.value) / found.n) if found.n else math.inf
            return Estimate(
                found.value, found.lower, found.upper, found.confidence, found.n, self.method, "; ".join(notes), error
            )
        return self._combined(usable, limit, course.done)

    def _combined(self, runs: list[SubsetRun], limit: float, n: int) -> Estimate:
        """The mean over subset simulations; the larger of the variances within and between them."""
        tails = [_tail(run.levels, limit) for run in runs]
        values = np.array([tail.value for tail in tails])
        value, k = float(values.mean()), len(values)
        factor = float(stdtrit(FREEDOM, 0.5 + 0.5 * self.question.confidence))
        notes = _notes(runs, limit)
        if value == 0.0:
            known = [tail.before * math.exp(factor * math.sqrt(math.log1p(tail.variance))) for tail in tails]
            _, share = clopper_pearson(0, k * self.sizes.chains, self.question.confidence)
            upper = min(1.0, float(np.mean(known) * share * np.mean([tail.upper_factor for tail in tails])))
            return Estimate(0.0, 0.0, upper, self.question.confidence, n, self.method, "; ".join(notes), math.inf)
        within = sum((tail.value**2 * tail.variance for tail in tails if tail.value > 0.0), 0.0) / (k * value) ** 2
        between = float(values.var(ddof=1)) / k / value**2 if k > 1 else 0.0
        variance = max(within, between)
        spread = math.exp(min(factor * math.sqrt(math.log1p(variance)), 700.0))
        raised = float(np.average([tail.upper_factor for tail in tails], weights=values))
        lowered = float(np.average([tail.lower_factor for tail in tails], weights=values))
        lower, upper = value * lowered / spread, min(1.0, value * raised * spread)
        error = value * math.sqrt(variance)
        return Estimate(value, lower, upper, self.question.confidence, n, self.method, "; ".join(notes), error)


def _tail(levels: list[Level], limit: float) -> _Tail:
    """Multiply the probabilities of the levels up to the one that the limit lies in."""
    last = max(k for k, level in enumerate(levels) if k == 0 or level.above <= limit)
    value, variance, up, down, before = 1.0, 0.0, 1.0, 1.0, 1.0
    for k, level in enumerate(levels[: last + 1]):
        exceeds = level.values > (limit if k == last else levels[k + 1].above)
        count = int(exceeds.sum())
        before, value = value, value * (count / level.n if level.n else math.nan)
        if count:
            variance += _squared_error(level, exceeds)
            up *= (
                (count + level.n_failed) / count * (level.n / (level.n + level.n_failed if level.is_first else level.n))
            )
        else:
            up *= 1.0 + level.n_failed
        down *= level.n / level.values.size
    return _Tail(value, variance, up, down, before, last + 1)


def _squared_error(level: Level, exceeds: np.ndarray) -> float:
    """Squared relative error of a conditional probability: binomial for plain runs, else between groups of chains."""
    count = exceeds.sum()
    share = count / level.n
    if level.is_first:
        return float((1.0 - share) / count)
    _, group = np.unique(level.seed, return_inverse=True)  # chains that share a seed are no evidence of each other
    size = np.bincount(group)
    excess = np.bincount(group, weights=exceeds.sum(axis=1)) - share * size * level.values.shape[1]
    return float(np.sum(excess**2) / count**2 * size.size / (size.size - 1)) if size.size > 1 else math.inf


def _plateau(runs: list[SubsetRun], limit: float) -> list[str]:
    tops = [run.levels[-1].values.max() for run in runs if run.is_finished]
    stuck = [top for top in tops if np.isfinite(top) and top <= limit]
    if not stuck:
        return []
    return [
        f"no level above {max(stuck):.4g} was found: more than estimator.level_probability of the runs share this "
        "value, so that larger ones, if there are any, are not looked for"
    ]


def _notes(runs: list[SubsetRun], limit: float) -> list[str]:
    notes = _plateau(runs, limit)
    unfinished = [run for run in runs if not run.is_finished and run.above < limit]
    if unfinished:
        reached = max(run.above for run in unfinished)
        notes.append(
            f"the limit was not reached: levels end at {reached:.4g}, and the interval beyond it rests on few runs; "
            "raise study.until.at_most"
        )
    failed = sum(level.n_failed for run in runs for level in run.levels)
    if failed:
        notes.append(f"{failed} failed runs: left out, or rejected where a chain met them; the upper bound counts them")
    censored = sum(int(np.isposinf(level.values).sum()) for run in runs for level in run.levels)
    if censored:
        notes.append(f"{censored} states censored, counted as exceeding")
    return notes
