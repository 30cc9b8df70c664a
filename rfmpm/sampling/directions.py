"""A vector of which some directions are set: the uncertain scalars and the principal components of the fields."""

from dataclasses import dataclass

import numpy as np

from rfmpm import seeds
from rfmpm.kernel_tools.threads import single_blas_thread


@dataclass(frozen=True)
class Directions:
    """The directions of `xi` that a design sets: its first entries, then rows of V in what follows them.

    Attributes:
        seed: of the study; the rest of a vector is the plain one of its index.
        n_variables: length of `xi`: uncertain scalars first, then what the fields take.
        n_scalars: uncertain scalars.
        components: V, orthonormal rows, shape (d, n_variables - n_scalars) [-]; None: the fields stay random.
    """

    seed: int
    n_variables: int
    n_scalars: int = 0
    components: np.ndarray | None = None

    def __post_init__(self):
        """Refuse what sets nothing or does not fit; raises ValueError."""
        shape = None if self.components is None else self.components.shape
        if shape is not None and (len(shape) != 2 or shape[1] != self.n_variables - self.n_scalars):
            raise ValueError(
                f"principal components of shape {shape}: must be (d, {self.n_variables - self.n_scalars}), as the "
                "fields take so many variables"
            )
        if self.dimension == 0:
            raise ValueError(
                "a design has nothing to set: give estimator.principal_components of the random fields, an "
                '[[uncertain]] scalar, or take estimator.sampling = "random"'
            )

    @property
    def dimension(self) -> int:
        """Number of directions that are set."""
        return self.n_scalars + (0 if self.components is None else len(self.components))

    def scores(self, xi: np.ndarray) -> np.ndarray:
        """Return how far a vector lies along the directions, shape (dimension,) [-].

        Args:
            xi: shape (n_variables,) [-].
        """
        k = self.n_scalars
        if self.components is None:
            return xi[:k].copy()
        with single_blas_thread():
            return np.concatenate([xi[:k], self.components @ xi[k:]])

    def compose(self, index: int, eta: np.ndarray) -> np.ndarray:
        """Return V^T eta + (I - V^T V) times the plain vector of an index: exactly N(0, I) if eta is.

        Args:
            index: of the realisation.
            eta: along the directions, shape (dimension,) [-].

        Returns:
            `xi`, shape (n_variables,) [-].
        """
        xi, k = seeds.standard_normal(self.seed, 0, index, self.n_variables), self.n_scalars
        xi[:k] = eta[:k]
        if self.components is not None:
            with single_blas_thread():
                xi[k:] += self.components.T @ (eta[k:] - self.components @ xi[k:])
        return xi
