"""Vectors for stratified sampling: plain ones, moved along a direction into the strata of their realisations."""

import numpy as np

from rfmpm import seeds
from rfmpm.estimators.question import Question
from rfmpm.estimators.rounds import Round
from rfmpm.estimators.rows import Rows
from rfmpm.estimators.stratified import Stratified
from rfmpm.sampling.directions import Directions


class StratifiedVectors:
    """xi = plain vector + (t - s) a, with s = a.xi of the plain one moved to t within the stratum.

    What is orthogonal to a stays as it is, so that a vector is standard-normal given the stratum of its score; it
    follows from the rows of the rounds before it and the seed alone.
    """

    def __init__(self, directions: Directions, question: Question, pilot_size: int):
        """Make the sampler.

        Args:
            directions: along which the fit looks for the one that matters.
            question: kind "exceedance"; its limit decides the strata.
            pilot_size: plain runs before the first fit [-].
        """
        self.n_variables = directions.n_variables
        self._directions = directions
        self._scores: list[np.ndarray] = []
        self._estimator = Stratified(question, self._plain, pilot_size)
        self._last: tuple[bytes, list[Round]] | None = None

    def xi(self, index: int, rows: Rows | None = None) -> np.ndarray:
        """Return the vector of a realisation, shape (n_variables,) [-]; see `Sampler.xi`.

        Raises:
            ValueError: the rows do not lead to this index.
        """
        found = self._rounds(rows)
        if index >= found[-1].stop:
            raise ValueError(
                f"realisation {index}: stratified sampling has planned {found[-1].stop} at most from the rows at hand; "
                "later ones follow from how these end"
            )
        own = next(one for one in found if index < one.stop)
        span = range(index, index + 1)
        return self._directions.compose(index, own.placed(span, self._plain(span))[0])

    def _plain(self, indices: range) -> np.ndarray:
        """Scores of plain vectors along the directions, shape (n, d) [-]."""
        for index in range(len(self._scores), indices.stop):
            plain = seeds.standard_normal(self._directions.seed, 0, index, self.n_variables)
            self._scores.append(self._directions.scores(plain))
        return np.array(self._scores[indices.start : indices.stop])

    def _rounds(self, rows: Rows | None) -> list[Round]:
        if rows is None:
            rows = Rows(*(np.zeros(0, kind) for kind in (int, int, float, bool, float)))
        key = b"".join(column.tobytes() for column in (rows.level, rows.index, rows.value, rows.is_censored))
        if self._last is None or self._last[0] != key:
            self._last = key, self._estimator.rounds(rows)
        return self._last[1]
