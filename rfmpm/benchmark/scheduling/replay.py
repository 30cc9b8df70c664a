"""A campaign in which nothing is computed: realisations take given times, the desk serves one claim after the other."""

import heapq
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.scheduling.desk import open_desk


class Schedule(NamedTuple):
    """When every realisation of a campaign began and ended."""

    began: np.ndarray  # shape (n,) [s]
    ended: np.ndarray  # shape (n,) [s]
    ranks: int

    @property
    def makespan(self) -> float:
        """From the first claim to the last end [s]."""
        return float(self.ended.max())

    @property
    def efficiency(self) -> float:
        """Time spent in realisations over the time of all ranks, until the last one has ended [-]."""
        return float((self.ended - self.began).sum() / (self.ranks * self.makespan))


def replay(seconds: np.ndarray, ranks: int, service: float = 0.0, sleep: float = 0.0) -> Schedule:
    """Let ranks claim, one after the other, what the runner's dispatcher hands out.

    Args:
        seconds: time of each realisation, shape (n,) [s].
        ranks: that work; all claim at time 0.
        service: how long the desk takes for one claim; the others wait in line [s].
        sleep: how long after its answer has come, on average, a rank notices [s].

    Returns:
        The schedule.
    """
    answer = open_desk(len(seconds))
    began, ended = np.zeros(len(seconds)), np.zeros(len(seconds))
    claims: list[tuple[float, int, int | None]] = [(0.0, rank, None) for rank in range(ranks)]
    is_free = 0.0
    while claims:
        time, rank, finished = heapq.heappop(claims)
        is_free = max(time, is_free) + service
        index = answer(rank, finished)
        if index is None:
            continue
        began[index] = is_free + sleep
        ended[index] = began[index] + seconds[index]
        heapq.heappush(claims, (ended[index], rank, index))
    return Schedule(began, ended, ranks)


def ideal(seconds: np.ndarray, ranks: int) -> float:
    """Shortest time that any schedule could take: an even share for each rank, or the longest realisation [s]."""
    return float(max(seconds.sum() / ranks, seconds.max()))
