"""What a marginal distribution offers, and what all of them refuse."""

from abc import ABC, abstractmethod
from math import inf
from typing import ClassVar, Protocol, Self

import numpy as np


class Marginal(Protocol):
    """What turns a standard-normal value into a physical one."""

    def transform(self, z: np.ndarray) -> np.ndarray:
        """The value with the same probability of non-exceedance as the standard-normal `z`, same shape."""


class Distribution(ABC):
    """A family of distributions of positive variables that is chosen by name and made from moments.

    Every family is one of scale: k times a variable has the distribution of k times the mean, the same coefficient of
    variation and the same other arguments. A mean that changes from point to point, at one coefficient of variation, is
    therefore mean / mean_0 times the values of a distribution with the mean mean_0.

    Attributes:
        needs: names of the arguments that `from_moments` takes beside the moments.
    """

    needs: ClassVar[tuple[str, ...]] = ()

    @classmethod
    @abstractmethod
    def from_moments(cls, mean: float, coefficient_of_variation: float) -> Self:
        """The distribution with this mean (its unit is the unit of the field) and coefficient of variation [-]."""

    @abstractmethod
    def transform(self, z: np.ndarray) -> np.ndarray:
        """The value with the same probability of non-exceedance as the standard-normal `z`, same shape."""


def check_moments(mean: float, coefficient_of_variation: float, limit: float = inf) -> None:
    """Refuse moments that no positive variable has, or a coefficient of variation of `limit` or more; ValueError."""
    if not 0 < mean < inf:
        raise ValueError(f"mean = {mean}: must be positive and finite")
    if not 0 < coefficient_of_variation < limit:
        raise ValueError(f"coefficient_of_variation = {coefficient_of_variation}: must lie between 0 and {limit}")
