"""Vectors for subset simulation: plain ones first, then steps from those that the finished rows single out."""

import numpy as np

from rfmpm import seeds
from rfmpm.estimators.chains import PLAIN, Course
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.subset_simulation import SubsetSimulation


class MarkovChains:
    """Conditional sampling: xi' = sqrt(1 - w^2) xi + w z, which leaves the standard-normal distribution as it is.

    z is the plain vector of the new index, xi that of the run it starts from, so a vector follows from the rows before
    it and the seed alone. Papaioannou and others (2015), doi:10.1016/j.probengmech.2015.06.006; in other words
    preconditioned Crank-Nicolson, Cotter and others (2013), doi:10.1214/13-STS421.
    """

    def __init__(self, seed: int, n_variables: int, estimator: SubsetSimulation):
        """Make the sampler.

        Args:
            seed: of the study.
            n_variables: length of `xi`.
            estimator: whose plan is followed.
        """
        self.n_variables = n_variables
        self._seed = seed
        self._estimator = estimator
        self._last: tuple[bytes, Course] | None = None

    def xi(self, index: int, rows: Rows | None = None) -> np.ndarray:
        """Return the vector of a realisation, shape (n_variables,) [-]; see `Sampler.xi`.

        Raises:
            ValueError: the rows do not lead to this index.
        """
        course = self._course(rows)
        if index >= len(course.parent):
            raise ValueError(
                f"realisation {index}: subset simulation has planned {len(course.parent)} from the rows at hand; later "
                "ones follow from how these end"
            )
        line = [index]
        while (parent := course.parent[line[-1]]) != PLAIN:
            line.append(int(parent))
        xi = self._plain(line.pop())
        while line:
            width = course.width[line[-1]]
            xi = np.sqrt(1.0 - width**2) * xi + width * self._plain(line.pop())
        return xi

    def _plain(self, index: int) -> np.ndarray:
        return seeds.standard_normal(self._seed, 0, index, self.n_variables)

    def _course(self, rows: Rows | None) -> Course:
        if rows is None:
            rows = Rows(*(np.zeros(0, kind) for kind in (int, int, float, bool, float)))
        key = b"".join(column.tobytes() for column in (rows.level, rows.index, rows.value, rows.is_censored))
        if self._last is None or self._last[0] != key:
            self._last = key, self._estimator.course(rows)
        return self._last[1]
