"""Random vectors of a campaign whose plan says them; made where the work is handed out."""

import numpy as np

from rfmpm import planning
from rfmpm.ensemble import codes
from rfmpm.ensemble.folder import WORK
from rfmpm.ensemble.worker import Worker
from rfmpm.estimators.rows import Rows


class XiMaker:
    """Makes the random vector of each realisation, if the study's estimator does not leave it to chance.

    Args:
        worker: of this process; what it has prepared tells how many variables there are, and which matter most.
    """

    def __init__(self, worker: Worker):
        self.worker = worker
        self.sampler = self.rows = None
        self.is_random = planning.is_random(worker.study)

    def prepare(self, rows: Rows | None) -> None:
        """Get ready for a plan.

        Args:
            rows: of all plans before it; None where there is but one plan.

        Raises:
            Abandoned: if something asked for the end.
        """
        self.rows = rows
        if not self.is_random and self.sampler is None:
            self.worker.prepare([0])
            prepared, store = self.worker.prepared[0], self.worker.directory / WORK
            self.sampler = planning.sampler_of(self.worker.study, prepared, store)

    def __call__(self, code: int) -> np.ndarray | None:
        """Make the vector of a code, shape (n_variables,) [-]; None where it is drawn from the stream of its index."""
        return None if self.sampler is None else self.sampler.xi(codes.split(code)[1], self.rows)
