"""Linear isotropic elasticity."""

from typing import NamedTuple

from rfmpm.kernel_tools import Tensor, inlined


@inlined
def hooke(lame, shear, stress, strain_increment):
    """Stress after an elastic strain increment (Hooke's law in rate form, plane strain)."""
    volumetric = lame * (strain_increment.xx + strain_increment.yy)
    return Tensor(
        stress.xx + volumetric + 2.0 * shear * strain_increment.xx,
        stress.yy + volumetric + 2.0 * shear * strain_increment.yy,
        stress.zz + volumetric,
        stress.xy + 2.0 * shear * strain_increment.xy,
    )


def lame_constants(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """First Lame parameter and shear modulus [Pa] of Young's modulus [Pa] and Poisson's ratio [-]."""
    lame = youngs_modulus * poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))
    return lame, 0.5 * youngs_modulus / (1.0 + poissons_ratio)


class Elastic(NamedTuple):
    """Hooke's law; needs no history."""

    lame: float  # first Lame parameter [Pa]
    shear: float  # shear modulus [Pa]

    def update_stress(self, stress, strain_increment, history, dt):
        """Hooke's law in rate form."""
        return hooke(self.lame, self.shear, stress, strain_increment), history

    def quasi_static(self, stiffer, factor):
        """The law of slow loading: stiffness times `stiffer`; there is no strength to divide by `factor`."""
        return Elastic(self.lame * stiffer, self.shear * stiffer)

    @classmethod
    def build(cls, material, cell, count, strengths):
        """Make the law and its history from a study's material; arguments as for `VonMises.build`."""
        return cls(*lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)), None
