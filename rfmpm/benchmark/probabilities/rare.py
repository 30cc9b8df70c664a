"""Subset simulation on the short slope against the reference: runs and error of a small probability."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from rfmpm import ensemble, planning
from rfmpm.benchmark.probabilities.bank import SCRATCH
from rfmpm.estimators.intervals import clopper_pearson
from rfmpm.study import Study

WANTED = 1e-3
AT_MOST = 1110  # a tenth of what plain Monte Carlo takes for a relative error of 0.3
SIZES = {"level_size": 190, "level_probability": 0.1}
SEEDS = range(1, 5)


class Small(NamedTuple):
    """A small probability that all rows together know."""

    limit: float  # [m]
    probability: float
    lower: float
    upper: float
    count: int  # rows that exceed the limit


class Found(NamedTuple):
    """One campaign."""

    value: float
    lower: float
    upper: float
    runs: int


def limit_of(run_out: np.ndarray) -> Small:
    """Choose the limit, in tenths of a metre, that is exceeded with a probability near WANTED."""
    limit = round(float(np.quantile(run_out, 1.0 - WANTED)), 1)
    count, n = int(np.sum(run_out > limit)), len(run_out)
    lower, upper = (float(bound) for bound in clopper_pearson(count, n))
    return Small(limit, count / n, lower, upper, count)


def subset_simulations(
    study: Study, limit: float, seeds: range, sizes: dict, tell: Callable[[str], None]
) -> Iterator[Found]:
    """Run one campaign for each seed.

    Args:
        study: on the coarse cells.
        limit: that run-out is to exceed [m].
        seeds: of the campaigns.
        sizes: of the levels.
        tell: is told each answer.

    Yields:
        What each found.
    """
    until = {"quantity": "run_out", "exceeds_m": limit, "at_most": AT_MOST}
    for seed in seeds:
        asked = study.with_changes(
            {
                "study": {"name": "small probability", "seed": seed, "until": until},
                "estimator": {"method": "subset_simulation", **sizes},
            }
        )
        rows = ensemble.run(asked, SCRATCH / f"subset_{seed}", progress=False)
        found = planning.answer(asked, planning.rows_of(asked, rows))
        tell(f"P(run-out > {limit:g} m), seed {seed}: {found.value:.2e} with {rows.sizes['realisation']} runs")
        yield Found(found.value, found.lower, found.upper, rows.sizes["realisation"])
