"""What every estimator offers: a plan of what to run next, and an estimate with its interval."""

from typing import NamedTuple, Protocol

import numpy as np

from rfmpm.estimators.rows import Rows


class Runs(NamedTuple):
    """Simulations to be run: these realisations on this level."""

    level: int
    indices: range


class Expectation(NamedTuple):
    """Estimated means of k functions of the quantity; every array has shape (k,)."""

    value: np.ndarray
    standard_error: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


class Estimator(Protocol):
    """Pure: the same rows give the same plan and the same estimate, on any machine."""

    def plan(self, rows: Rows) -> list[Runs]:
        """Name what is to be run next, given all that is finished; empty when the question is answered.

        Only what `plan` has named is ever finished, and all of it is before `plan` is asked again, so that no run is
        used because it was quick.
        """
        ...

    def estimate(self, rows: Rows):
        """Answer the question: an Estimate."""
        ...
