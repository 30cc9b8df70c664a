"""Walls by name: what happens to a node on the edge of the domain."""

from typing import NamedTuple


class Fixed(NamedTuple):
    """No movement."""

    def constrain(self, inward, along, push, drag):
        """Both components vanish."""
        return 0.0, 0.0, 0.0, 0.0


class Roller(NamedTuple):
    """No movement through the wall, none hindered along it."""

    def constrain(self, inward, along, push, drag):
        """The normal component vanishes."""
        return 0.0, along, 0.0, along + drag


class Friction(NamedTuple):
    """Unilateral contact with Coulomb friction: soil may lift off, and slides where the shear limit is reached."""

    coefficient: float  # [-]

    def constrain(self, inward, along, push, drag):
        """Stop what moves into the wall; oppose what slides with at most `coefficient` times the impulse of that."""
        if inward + push >= 0.0:
            return inward, along, inward + push, along + drag
        hold, slide = -self.coefficient * (inward + push), along + drag
        if slide > hold:
            return 0.0, along, 0.0, slide - hold
        if slide < -hold:
            return 0.0, along, 0.0, slide + hold
        return 0.0, 0.0, 0.0, 0.0


class Walls(NamedTuple):
    """The domain's edges; its top is open."""

    base: tuple
    sides: tuple


WALLS = {"fixed": Fixed, "roller": Roller, "friction": Friction}
