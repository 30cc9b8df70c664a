"""What a plug-in of the engine must offer."""

from typing import Protocol

from rfmpm.kernel_tools import generic


class ConstitutiveLaw(Protocol):
    """A stress-strain relation at one point."""

    def update_stress(self, stress, strain_increment, history):
        """Return (stress, history) after one strain increment; `stress` has been rotated with the body."""


class ShapeFunction(Protocol):
    """Weights of the nodes of one axis, which runs from wall to wall."""

    def weights(self, x):
        """Return first node, weights [-] and slopes [1/m] at coordinate x [m]."""


class Wall(Protocol):
    """What a wall does to a node that lies on it."""

    def constrain(self, inward, along, push, drag):
        """Return the velocities (inward, along) before and after a step [m/s] that the wall allows.

        `inward` and `along` are the velocity before, `push` and `drag` what the other forces change of it; `inward`
        points into the domain: negative is a velocity into the wall.
        """


update_stress = generic(ConstitutiveLaw.update_stress)
weights = generic(ShapeFunction.weights)
constrain = generic(Wall.constrain)
