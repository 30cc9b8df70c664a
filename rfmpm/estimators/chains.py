"""How a subset simulation unfolds: which run starts from which, level by level, as the finished rows decide.

Several independent subset simulations go side by side. In each turn every unfinished one adds a batch: first its plain
runs, then one step of all its chains; the indices of a turn follow on those of the turns before it.

Au and Beck (2001), Probabilistic Engineering Mechanics 16, 263-277, doi:10.1016/S0266-8920(01)00019-4; steps and their
adaptive width by Papaioannou, Betz, Zwirglmaier and Straub (2015), Probabilistic Engineering Mechanics 41, 89-103,
doi:10.1016/j.probengmech.2015.06.006.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from rfmpm.estimators.rows import Rows

PLAIN = -1  # parent of a run that starts from none
BEST_ACCEPTANCE = 0.44  # of candidates; measured: least error between 0.3 and 0.65
FIRST_WIDTH = 0.6


@dataclass(frozen=True)
class Sizes:
    """Runs of a level, chains they are in from the second level on, and runs of a chain."""

    level: int
    chains: int

    @property
    def length(self) -> int:
        """States of a chain, its seed included."""
        return self.level // self.chains


@dataclass(frozen=True)
class Level:
    """States of a finished level: realisations whose quantity is above a threshold, in chains.

    Attributes:
        above: the threshold; -inf on the first level.
        values: of the states, shape (chains, length); -inf where a plain run failed, inf where censored.
        seed: number of the state that each chain started from, shape (chains,); equal where chains share one.
        n_failed: runs that failed.
    """

    above: float
    values: np.ndarray
    seed: np.ndarray
    n_failed: int

    @property
    def is_first(self) -> bool:
        """Whether its states are plain runs."""
        return self.values.shape[1] == 1

    @property
    def n(self) -> int:
        """States that say something: but for the first level a failed run leaves a state as it was."""
        return self.values.size - (self.n_failed if self.is_first else 0)

    def threshold(self, chains: int) -> float:
        """Return the value that at most so many states exceed: from which the next level starts."""
        return float(-np.partition(-self.values, chains, axis=None)[chains])


@dataclass
class SubsetRun:
    """One subset simulation towards a limit; grows batch by batch."""

    sizes: Sizes
    limit: float
    levels: list[Level] = field(default_factory=list)
    above: float = -np.inf  # threshold of the level under way
    width: float = FIRST_WIDTH  # of a step, between 0 and 1: 1 forgets where it came from
    is_finished: bool = False
    states: np.ndarray | None = None  # index of the run that gave the last state of each chain
    steps: list[np.ndarray] = field(default_factory=list)  # indices of the states of the level under way
    seed: np.ndarray | None = None
    n_failed: int = 0

    def parents(self) -> np.ndarray:
        """Index of the run that each run of the next batch starts from."""
        return np.full(self.sizes.level, PLAIN) if self.states is None else self.states

    def advance(self, start: int, values: np.ndarray, is_failed: np.ndarray) -> None:
        """Take in the batch whose indices begin at `start`, given the values of all runs up to its end."""
        batch = np.arange(start, len(values))
        self.n_failed += int(is_failed[batch].sum())
        if self.states is None:
            self._end_level(Level(-np.inf, values[batch][:, None], batch, self.n_failed), batch)
            return
        is_accepted = values[batch] > self.above
        self.states = np.where(is_accepted, batch, self.states)
        gain = (is_accepted.mean() - BEST_ACCEPTANCE) / np.sqrt(len(self.steps))
        self.width = min(1.0, self.width * float(np.exp(gain)))
        self.steps.append(self.states)
        if len(self.steps) == self.sizes.length:
            states = np.column_stack(self.steps)
            self._end_level(Level(self.above, values[states], self.seed, self.n_failed), states.ravel())

    def _end_level(self, level: Level, states: np.ndarray) -> None:
        self.levels.append(level)
        self.n_failed = 0
        self.above = level.threshold(self.sizes.chains)
        best = np.flatnonzero(level.values.ravel() > self.above)
        if self.above >= self.limit or best.size == 0:
            self.is_finished = True
            return
        # Where values are tied fewer are above the threshold than there are chains: some then share a seed.
        self.seed = best[np.arange(self.sizes.chains) % best.size]
        self.states = states[self.seed]
        self.steps = [self.states]


@dataclass
class Course:
    """What became of the rows so far, and what comes next.

    Attributes:
        runs: the subset simulations, as far as their batches are complete.
        parent: index of the run that each run starts from, `PLAIN` where from none; shape (n,).
        width: of the step from there, shape (n,) [-].
        done: indices below this have a row and are taken in; those from here to n are to be run next.
    """

    runs: list[SubsetRun]
    parent: np.ndarray
    width: np.ndarray
    done: int


def follow(
    rows: Rows, sizes: Sizes, limit: float, first_runs: int, more_runs: Callable[[list[SubsetRun]], int], most: float
) -> Course:
    """Follow the rows through the turns.

    Args:
        rows: all that is finished.
        sizes: of levels and chains.
        limit: at which a subset simulation ends.
        first_runs: subset simulations in the beginning.
        more_runs: says, when all are finished, how many to add; 0 to end.
        most: runs at which everything ends.

    Returns:
        The course; the same for any further rows up to the turn that they are of.
    """
    own = rows.on_level(0)
    available = int(np.sum(own.index == np.arange(own.index.size)))
    is_failed = own.is_failed
    values = np.where(is_failed, -np.inf, np.where(own.is_censored, np.inf, own.value))
    runs = [SubsetRun(sizes, limit) for _ in range(first_runs)]
    parents, widths, done = [np.zeros(0, int)], [np.zeros(0)], 0
    while True:
        if all(run.is_finished for run in runs):
            runs += [SubsetRun(sizes, limit) for _ in range(more_runs(runs))]
        turn = [run for run in runs if not run.is_finished]
        batches = [run.parents() for run in turn]
        end = done + sum(map(len, batches))
        if not turn or end > most:
            break
        parents += batches
        widths += [np.full(len(batch), run.width) for run, batch in zip(turn, batches, strict=True)]
        if end > available:
            break
        for run, batch in zip(turn, batches, strict=True):
            stop = done + len(batch)
            run.advance(done, values[:stop], is_failed[:stop])
            done = stop
    return Course(runs, np.concatenate(parents), np.concatenate(widths), done)
