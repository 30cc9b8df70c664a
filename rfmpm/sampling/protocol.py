"""What every sampler offers: the standard-normal vector of each realisation."""

from typing import Protocol

import numpy as np

from rfmpm.estimators.rows import Rows


class Sampler(Protocol):
    """Says which vector `xi` belongs to an index; the same on any machine, in any order.

    Attributes:
        n_variables: length of `xi`: uncertain scalars first, then what the random fields take.
    """

    n_variables: int

    def xi(self, index: int, rows: Rows | None = None) -> np.ndarray:
        """Return the vector of a realisation.

        Args:
            index: of the realisation.
            rows: what is finished; needed by samplers whose realisations follow from others, and there all rows with
                indices before the turn of this one.

        Returns:
            `xi`, shape (n_variables,) [-]; standard-normal over the randomisation of the sampler.
        """
        ...
