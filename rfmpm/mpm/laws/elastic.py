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


class Elastic(NamedTuple):
    """Hooke's law; needs no history."""

    lame: float  # first Lame parameter [Pa]
    shear: float  # shear modulus [Pa]

    def update_stress(self, stress, strain_increment, history):
        """Hooke's law in rate form."""
        return hooke(self.lame, self.shear, stress, strain_increment), history
