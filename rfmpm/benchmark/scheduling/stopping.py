"""What stopping a campaign early does to its estimate, where realisations that fail take longer."""

from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.scheduling.replay import replay
from rfmpm.estimators import contiguous_prefix


class Bias(NamedTuple):
    """Mean error of an estimated probability over many campaigns, and its standard error [-]."""

    value: float
    error: float


def biases(
    rng: np.random.Generator, fails: np.ndarray, seconds: np.ndarray, ranks: int, wanted: int, campaigns: int
) -> dict[str, Bias]:
    """Stop campaigns early and estimate the probability of failing from what is at hand.

    Args:
        rng: draws the realisations of every campaign, with replacement, from those given.
        fails: whether each of them fails, shape (n,).
        seconds: what each of them takes, shape (n,) [s].
        ranks: of the campaign.
        wanted: realisations after which it stops.
        campaigns: how many.

    Returns:
        Bias of the estimate from
        "first finished": the first `wanted` that are finished;
        "prefix then": the indices 0, 1, 2, ... without a gap at that moment;
        "prefix of N": the indices 0 to `wanted` - 1, once all of them are finished.
    """
    truth = float(np.mean(fails))
    errors: dict[str, list[float]] = {"first finished": [], "prefix then": [], "prefix of N": []}
    for _ in range(campaigns):
        drawn = rng.integers(len(fails), size=wanted + 2 * ranks)
        outcome = fails[drawn]
        ended = replay(seconds[drawn], ranks).ended
        finished = np.argsort(ended, kind="stable")[:wanted]
        prefix = contiguous_prefix(finished)
        errors["first finished"].append(outcome[finished].mean() - truth)
        errors["prefix then"].append(outcome[:prefix].mean() - truth if prefix else np.nan)
        errors["prefix of N"].append(outcome[:wanted].mean() - truth)
    return {name: _bias(np.array(values)) for name, values in errors.items()}


def _bias(errors: np.ndarray) -> Bias:
    errors = errors[~np.isnan(errors)]
    return Bias(float(errors.mean()), float(errors.std(ddof=1) / np.sqrt(len(errors))))
