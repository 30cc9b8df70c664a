"""What a plug-in of the engine must offer."""

from typing import Protocol

from rfmpm.kernel_tools import generic


class ConstitutiveLaw(Protocol):
    """A stress-strain relation at one point."""

    def update_stress(self, stress, strain_increment, history, dt):
        """Return (stress, history) after one strain increment in dt [s]; `stress` has been rotated with the body."""


class SofteningHistory(Protocol):
    """What the strength of a point follows."""

    def softening_strain(self):
        """Return the plastic strain that the strength follows [-]."""

    def local_share(self):
        """Return how much of the point's plastic strain it follows within a step [-]."""

    def grown(self, increment):
        """Return the history after some more plastic strain."""


class ShapeFunction(Protocol):
    """Weights of the nodes of one axis, which runs from wall to wall."""

    def weights(self, x):
        """Return first node, weights [-] and slopes [1/m] at coordinate x [m]."""


class Passes(Protocol):
    """How the passes of a step over points and nodes are taken: by one thread, or shared by several."""

    def update_nodes(self, grid, walls, box, gravity, damping, dt, share):
        """Solve the momentum equation on the touched nodes."""

    def filter_nodes(self, points, axes, grid, box):
        """Make the filtered velocity of the touched nodes, in `grid.filtered`."""

    def update_points(self, points, axes, grid, filtered, blend, box, own_share):
        """Update the points' velocities and map them to `grid.straining`. Returns the work that walls take [J/m]."""

    def carry(self, points, law, history, axes, grid, cells, box, dt):
        """Move and strain the points and take them to the grid. Returns what `carry_points` does."""

    def average(self, points, history, axes, averaging, box):
        """Renew the softening strain of every point."""


class Wall(Protocol):
    """What a wall does to a node that lies on it."""

    def constrain(self, inward, along, push, drag):
        """Return the velocities (inward, along) before and after a step [m/s] that the wall allows.

        `inward` and `along` are the velocity before, `push` and `drag` what the other forces change of it; `inward`
        points into the domain: negative is a velocity into the wall.
        """


update_stress = generic(ConstitutiveLaw.update_stress)
softening_strain = generic(SofteningHistory.softening_strain)
local_share = generic(SofteningHistory.local_share)
grown = generic(SofteningHistory.grown)
weights = generic(ShapeFunction.weights)
constrain = generic(Wall.constrain)
update_nodes = generic(Passes.update_nodes)
filter_nodes = generic(Passes.filter_nodes)
update_points = generic(Passes.update_points)
carry = generic(Passes.carry)
average = generic(Passes.average)
