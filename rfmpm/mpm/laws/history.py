"""What plastic flow leaves behind, and which part of it the strength follows."""

from typing import NamedTuple


class PlasticHistory(NamedTuple):
    """Strength that follows the plastic strain of its own point."""

    plastic_strain: float  # equivalent: integral of sqrt(2/3 de_p : de_p) [-]

    def softening_strain(self):
        """Plastic strain that the strength follows [-]."""
        return self.plastic_strain

    def local_share(self):
        """How much the softening strain grows within a step with the plastic strain."""
        return 1.0

    def grown(self, increment):
        """History after some more plastic strain [-]."""
        return PlasticHistory(self.plastic_strain + increment)


class NonlocalHistory(NamedTuple):
    """Strength that follows an average of the plastic strain around the point, renewed now and then."""

    plastic_strain: float  # equivalent, of the point [-]
    averaged_strain: float  # largest so far of the over-nonlocal average [-]

    def softening_strain(self):
        """Plastic strain that the strength follows [-]."""
        return self.averaged_strain

    def local_share(self):
        """It stays as it is within a step."""
        return 0.0

    def grown(self, increment):
        """History after some more plastic strain [-]."""
        return NonlocalHistory(self.plastic_strain + increment, self.averaged_strain)
