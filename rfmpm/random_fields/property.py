"""A random property, ready to be realised: the fields of its soils, and where their values go."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rfmpm.random_fields import field
from rfmpm.random_fields.trend import ByDepth, Scaled


@dataclass(frozen=True)
class Part:
    """The field of one soil: its settings, the mean at the crest [unit of the field] and the points that carry it."""

    soil: int  # 0 above all layers, k in the k-th of the list
    settings: Any
    mean: float
    points: np.ndarray  # (m, 2) [m]
    members: np.ndarray | slice  # their places among all points that carry the property
    field: field.PreparedField

    @property
    def at_crest(self) -> field.PreparedField:
        """The field as if its distribution were everywhere that at the crest: itself where it has no trend."""
        marginal = self.field.marginal
        if not isinstance(marginal, Scaled | ByDepth):
            return self.field
        return replace(self.field, marginal=marginal.crest)


@dataclass(frozen=True)
class Property:
    """A random property, ready to be realised.

    Attributes:
        name: one of KINDS.
        parts: the fields of its soils that have points.
        count: number of points that carry it.
        taken: which of them each material point takes, shape (n, k); None where the material points carry it.
        elsewhere: values at the points of all materials in SI units, its own without variation, shape (n,); NaN where a
            law has no such property. None where there is one material.
        places: the points of its own materials among those of all; None where there is one material.
        ratio: mean of the material of each of these points over that of the first, shape (m,); None: one material.
    """

    name: str
    parts: tuple[Part, ...]
    count: int
    taken: np.ndarray | None
    elsewhere: np.ndarray | None = None
    places: slice | np.ndarray | None = None
    ratio: np.ndarray | None = None

    @property
    def where(self) -> slice | np.ndarray:
        """The points of its own materials among those of all."""
        return slice(None) if self.places is None else self.places

    @property
    def n_variables(self) -> int:
        """Length of its part of `xi`."""
        return sum(part.field.n_variables for part in self.parts)


@dataclass(frozen=True)
class Properties:
    """All random properties of a study, by the names of `Study.fields`.

    `mixing` is what makes correlated ones of their standard-normal fields; None: they are independent.
    """

    entries: dict[str, Property]
    mixing: np.ndarray | None

    @property
    def n_variables(self) -> int:
        """Length of the vector `xi`."""
        return sum(entry.n_variables for entry in self.entries.values())
