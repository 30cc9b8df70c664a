"""Marginal distributions that change with depth: a trend in the mean, and one in the standard deviation.

The correlation stays that of the standard-normal field: a trend changes what its values stand for, not how they vary.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rfmpm.random_fields.marginals import Marginal


@dataclass(frozen=True)
class Trend:
    """Linear gain with depth of the mean and of the standard deviation.

    Attributes:
        level: height at which the depth is zero, positive upwards [m].
        mean_gain: of the mean per metre of depth [unit of the field per m].
        deviation_gain: of the standard deviation per metre of depth [the same]; None: proportional to the mean.
    """

    level: float
    mean_gain: float
    deviation_gain: float | None = None

    def marginal(
        self,
        factory: Callable[[float, float], Marginal],
        mean: float,
        coefficient_of_variation: float,
        points: np.ndarray,
    ) -> Marginal:
        """Make the marginal distribution of each point.

        With a standard deviation proportional to the mean it is, at every depth, the one at depth zero times the ratio
        of the means. Otherwise each depth has the distribution that `factory` makes of its two moments.

        Args:
            factory: distribution of a mean and a coefficient of variation [-].
            mean: at depth zero [unit of the field].
            coefficient_of_variation: at depth zero [-].
            points: positions, shape (n, 2) [m].

        Returns:
            a marginal that takes arrays of shape (..., n), in the order of the points.

        Raises:
            ValueError: a mean or standard deviation that is not positive at some depth, which is named, or one that
                the distribution cannot have.
        """
        depth = self.level - np.asarray(points, dtype=float)[:, 1]
        means = mean + self.mean_gain * depth
        _check_positive("mean", means, depth)
        crest = factory(mean, coefficient_of_variation)
        if self.deviation_gain is None:
            return Scaled(crest, means / mean)
        deviations = mean * coefficient_of_variation + self.deviation_gain * depth
        _check_positive("standard deviation", deviations, depth)
        _, first, group = np.unique(depth, return_index=True, return_inverse=True)
        marginals = tuple(factory(float(means[k]), float(deviations[k] / means[k])) for k in first)
        order = np.argsort(group, kind="stable")
        return ByDepth(crest, marginals, tuple(np.split(order, np.cumsum(np.bincount(group))[:-1])))


@dataclass(frozen=True)
class Scaled:
    """The distribution at depth zero times a factor of each point, shape (n,) [-]."""

    crest: Marginal
    factor: np.ndarray

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Values at the points from standard-normal `z`, shape (..., n)."""
        return self.factor * self.crest.transform(z)


@dataclass(frozen=True)
class ByDepth:
    """The distribution at depth zero, one for each depth, and the points, indices of shape (k,), that lie there."""

    crest: Marginal
    marginals: tuple[Marginal, ...]
    members: tuple[np.ndarray, ...]

    def transform(self, z: np.ndarray) -> np.ndarray:
        """Values at the points from standard-normal `z`, shape (..., n)."""
        z = np.asarray(z, dtype=float)
        values = np.empty_like(z)
        for marginal, members in zip(self.marginals, self.members, strict=True):
            values[..., members] = marginal.transform(z[..., members])
        return values


def _check_positive(what: str, values: np.ndarray, depth: np.ndarray) -> None:
    if not np.all(values > 0.0):
        worst = int(np.argmin(values))
        raise ValueError(
            f"the {what} is {values[worst] / 1e3:.4g} kPa at a depth of {depth[worst]:.4g} m: must be positive"
        )
