"""How velocities come back to the points, by name."""

from typing import NamedTuple, Protocol

from rfmpm.kernel_tools import Vector, generic


class Transfer(Protocol):
    """What a point takes from the grid after a step."""

    def new_velocity(self, own, interpolated, change, filtered, blend):
        """Return the point's velocity: from its own before, and the grid's, interpolated, after the step [m/s].

        `change` is the grid's change of velocity over the step, `filtered` FMPM's velocity and `blend` the share of it
        that is due in this step.
        """

    def new_gradient(self, slope, moment):
        """Return the velocity gradient that the point carries [1/s], where it carries one.

        `slope` is the sum of v grad w, `moment` the sum of w v (x_i - x_p) over that of w (x_i - x_p)^2.
        """

    def filter_terms(self):
        """Return the number of terms of FMPM's series that `filtered` is to hold."""


class Flip(NamedTuple):
    """FLIP, with a relaxation towards FMPM(terms); one term is PIC.

    Brackbill and Ruppel (1986); Nairn and Hammerquist (2021). With a dissipation time of 0 and a filter in every step
    it is FMPM(terms) as published, and PIC for one term.
    """

    terms: int

    def new_velocity(self, own, interpolated, change, filtered, blend):
        """The own velocity and the grid's change of it; a share of that gives way to the filtered one."""
        vx, vy = own.x + change.x, own.y + change.y
        return Vector(vx + blend * (filtered.x - vx), vy + blend * (filtered.y - vy))

    def new_gradient(self, slope, moment):
        """None is carried."""
        return slope

    def filter_terms(self):
        """As asked."""
        return self.terms


class Apic(NamedTuple):
    """Affine particle in cell: Jiang, Schroeder, Selle, Teran and Stomakhin (2015)."""

    def new_velocity(self, own, interpolated, change, filtered, blend):
        """The grid's."""
        return interpolated

    def new_gradient(self, slope, moment):
        """First moment of the grid's velocity."""
        return moment

    def filter_terms(self):
        """No filter."""
        return 0


class Tpic(NamedTuple):
    """Taylor particle in cell: Nakamura, Matsumura and Mizutani (2023)."""

    def new_velocity(self, own, interpolated, change, filtered, blend):
        """The grid's."""
        return interpolated

    def new_gradient(self, slope, moment):
        """The gradient of the grid's velocity."""
        return slope

    def filter_terms(self):
        """No filter."""
        return 0


TRANSFERS = {"flip": Flip, "apic": Apic, "tpic": Tpic}


class BodyForce(Protocol):
    """A force per unit mass that differs from place to place."""

    def acceleration(self, x, y, time):
        """Return (x, y) components [m/s2] at a place [m] and time [s]."""


new_velocity = generic(Transfer.new_velocity)
new_gradient = generic(Transfer.new_gradient)
filter_terms = generic(Transfer.filter_terms)
acceleration = generic(BodyForce.acceleration)
