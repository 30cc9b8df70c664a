"""The soils of a scene: what their materials say of each point."""

from collections.abc import Mapping
from math import sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Ranges, join
from rfmpm.mpm.laws import LAWS
from rfmpm.mpm.laws.elastic import lame_constants
from rfmpm.mpm.laws.history import NonlocalHistory

GRAVITY = 9.81  # [m/s2]


class Soils(NamedTuple):
    """Materials of a scene, in the order of its points: those of the first come first."""

    materials: tuple  # of the study
    counts: tuple[int, ...]  # points of each
    varying: tuple[frozenset[str], ...]  # names of the random properties of each

    def of_points(self, values) -> float | np.ndarray:
        """One value for each material, as shape (n,); of a single material the value itself."""
        if len(self.counts) == 1:
            return values[0]
        return self.of_each(values)

    def of_each(self, values) -> np.ndarray:
        """One value for each material at its points, shape (n,)."""
        return np.repeat(np.array(values, dtype=float), self.counts)

    @property
    def of_point(self) -> np.ndarray:
        """Number of the material of each point, in the order of the study, shape (n,)."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    @property
    def elastic_constants(self) -> tuple:
        """First Lame parameter and shear modulus [Pa], shape (n,) or one value each."""
        lame, shear = zip(*(constants_of(material) for material in self.materials), strict=True)
        return self.of_points(lame), self.of_points(shear)

    @property
    def density(self) -> float | np.ndarray:
        """Mass per volume [kg/m3], shape (n,) or one value."""
        return self.of_points([density_of(material) for material in self.materials])

    @property
    def softening_length(self) -> float | None:
        """Length over which softening is averaged, the same for all that have one [m]."""
        lengths = [getattr(material, "softening_length_m", None) for material in self.materials]
        return next((length for length in lengths if length), None)

    def wave_speed(self) -> float:
        """Speed of compression waves, the largest of all materials [m/s]."""
        constants = [(*constants_of(material), density_of(material)) for material in self.materials]
        return max(sqrt((lame + 2.0 * shear) / density) for lame, shear, density in constants)

    def shear_wave_speed(self, of=None) -> float:
        """Speed of shear waves, the smallest of all materials for which `of` is true [m/s]; 0 if it is for none."""
        chosen = [material for material in self.materials if of is None or of(material)]
        return min((sqrt(constants_of(one)[1] / density_of(one)) for one in chosen), default=0.0)

    @property
    def slowest_share(self) -> float:
        """Speed of the slowest shear wave over that of the fastest compression wave [-]."""
        if len(self.materials) == 1:
            lame, shear = constants_of(self.materials[0])
            return sqrt(shear / (lame + 2.0 * shear))
        return self.shear_wave_speed() / self.wave_speed()

    def laws(self, cell: float, strengths: Mapping[str, np.ndarray]) -> tuple:
        """Make the laws of the points and their histories.

        Args:
            cell: side of a cell [m].
            strengths: what varies from point to point, by name, arrays of shape (n,); each material takes what is
                random of it, a single one all of it.

        Returns:
            Law and history, as records of all points or by the ranges of the materials.
        """
        made, start = [], 0
        for material, count, varying in zip(self.materials, self.counts, self.varying, strict=True):
            own = {
                name: values[start : start + count]
                for name, values in strengths.items()
                if len(self.counts) == 1 or name in varying
            }
            made.append(LAWS[material.law].build(material, cell, count, own))
            start += count
        laws, histories = zip(*made, strict=True)
        return join(laws, self.counts), join(histories, self.counts)

    def averaged(self, history) -> tuple | None:
        """What a history holds of the points that soften over a length; None if none does."""
        if not isinstance(history, Ranges):
            return history if isinstance(history, NonlocalHistory) else None
        own = [record if isinstance(record, NonlocalHistory) else None for record in history.records]
        return join(own, self.counts)


def soils_of(study, counts: tuple[int, ...]) -> Soils:
    """The soils of a study whose materials have so many points."""
    numbers = range(len(study.material))
    varying = (frozenset(field.variable for field in study.fields if number in field.materials) for number in numbers)
    return Soils(study.material, counts, tuple(varying))


def constants_of(material) -> tuple[float, float]:
    """First Lame parameter and shear modulus of a material [Pa]."""
    return lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)


def density_of(material) -> float:
    """Mass per volume of a material [kg/m3]."""
    return material.unit_weight_kn_m3 * 1e3 / GRAVITY


def plastic_strain_of(history, count: int) -> np.ndarray:
    """Plastic strain of all points, shape (n,) [-]; 0 where a law has none. A copy if there are several soils."""
    if history is None:
        return np.zeros(count)
    if not isinstance(history, Ranges):
        return history.plastic_strain
    return np.concatenate([plastic_strain_of(own, last - first) for own, first, last in history.each()])


def stress_factor(before: Soils, after: Soils) -> float | None:
    """By what the elastic stresses of one scene differ from those of another with the same points; None: in more.

    Stresses at rest are proportional to the unit weight, if that of all materials changes alike, and do not depend on
    Young's modulus, if that of all materials does; with another Poisson's ratio they are others.
    """
    weights, moduli, ratios = (
        [(getattr(old, key), getattr(new, key)) for old, new in zip(before.materials, after.materials, strict=True)]
        for key in ("unit_weight_kn_m3", "youngs_modulus_kpa", "poissons_ratio")
    )
    factors = {new / old for old, new in weights}
    if len(factors) > 1 or len({new / old for old, new in moduli}) > 1 or any(old != new for old, new in ratios):
        return None
    return factors.pop()
