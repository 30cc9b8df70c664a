"""Simulations of a campaign made once more, with the random vectors that its plan gave them."""

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm.estimators.rows import Rows
from rfmpm.planning.estimation import is_random, sampler_of
from rfmpm.planning.levels import run_options, studies_by_level
from rfmpm.study import StudyError

if TYPE_CHECKING:
    from rfmpm.outcome import Outcome


class Replay:
    """Makes simulations of a campaign once more; nothing is prepared before the first one.

    Args:
        study: of the campaign.
        rows: of the campaign; needed where realisations follow from others (`approaches_limit`), else None will do.
        level: on whose cells; 0 for the study's own.
    """

    def __init__(self, study, rows: Rows | None = None, level: int = 0):
        self.study, self.rows, self.level = study, rows, level

    @cached_property
    def prepared(self):
        """The study of the level, prepared."""
        from rfmpm import realisation

        return realisation.prepare(studies_by_level(self.study)[self.level])

    @cached_property
    def _sampler(self):
        if is_random(self.study):
            return None
        own = self if self.level == 0 else Replay(self.study, self.rows)
        return sampler_of(self.study, own.prepared)

    def xi(self, index: int) -> np.ndarray:
        """Give the random vector of a realisation, shape (n_variables,) [-].

        Args:
            index: of the realisation.

        Raises:
            StudyError: if it follows from others that the rows do not hold.
        """
        from rfmpm import realisation

        if self._sampler is None:
            return realisation.draw_xi(self.prepared, index)
        try:
            return self._sampler.xi(index, self.rows)
        except ValueError as error:
            raise StudyError([f"{error}: rfmpm rerun DIR --index {index} repeats one of a campaign"]) from None

    def options(self, index: int) -> dict[str, Any]:
        """What `realisation.run` and `simulate` are to be told beside the prepared study and the index."""
        xi = None if self._sampler is None else self.xi(index)
        return run_options(self.prepared, self.level, index, xi)

    def simulate(self, index: int, frames: int = 0) -> "Outcome":
        """Simulate a realisation as the campaign did, on one thread.

        Args:
            index: of the realisation.
            frames: snapshots to be kept on the way.

        Returns:
            The outcome.
        """
        from rfmpm import realisation

        return realisation.simulate(self.prepared, index, frames=frames, **self.options(index))
