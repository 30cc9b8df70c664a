"""The directions of the random vector that matter most: set by a design, or taken as control variates."""

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rfmpm.planning.levels import studies_by_level
from rfmpm.study import StudyError

if TYPE_CHECKING:
    from rfmpm.sampling import Directions


def directions_of(study, prepared, store: Path | None = None) -> "Directions":
    """Find the directions of a study: its uncertain numbers and the principal components of its fields.

    Args:
        study: the study.
        prepared: it, on its own cells.
        store: folder in which the components are kept for another start; None keeps them in memory.

    Returns:
        The directions.

    Raises:
        StudyError: if the fields have too many variables for their components to be found.
        OSError: if the store cannot be written.
    """
    from rfmpm.random_fields.principal_components import principal_components
    from rfmpm.sampling import Directions

    components = None
    try:
        if study.fields:
            components = principal_components(
                prepared.properties, study.estimator.principal_components, store
            ).directions
        return Directions(study.study.seed, prepared.n_variables, len(prepared.uncertain), components)
    except ValueError as error:
        raise StudyError([str(error)]) from None


class FieldFeatures:
    """How far the random vectors of realisations lie along the directions: independent standard-normal numbers.

    Args:
        study: whose realisations are drawn from the streams of their indices.
    """

    def __init__(self, study):
        self.study = study
        self._found: list[np.ndarray] = []

    @cached_property
    def _prepared(self):
        from rfmpm import realisation

        return realisation.prepare(studies_by_level(self.study)[0])

    @cached_property
    def _directions(self) -> "Directions":
        return directions_of(self.study, self._prepared)

    def __call__(self, indices: range) -> np.ndarray:
        """Give the numbers of realisations, shape (n, d) [-].

        Args:
            indices: of the realisations.
        """
        from rfmpm import realisation

        for index in range(len(self._found), indices.stop):
            self._found.append(self._directions.scores(realisation.draw_xi(self._prepared, index)))
        return np.array(self._found[indices.start : indices.stop])
