"""The schemes that are compared: engine, shape, transfer, order of the stress update, points per cell."""

from dataclasses import dataclass, replace
from math import inf

from rfmpm.mpm.shapes import SHAPES
from rfmpm.mpm.solvers.reference import Apic, Flip, Tpic

DISSIPATION_TIME = 5.0  # [s], of the engine's default
ENGINES = {"plain": "plain solver", "fast": "production engine"}
# Name, transfer, dissipation time [s]; where that is 0 the filter acts in every step and is all there is.
TRANSFERS = {
    "flip": (Flip(2), inf),
    "flip_fmpm2": (Flip(2), DISSIPATION_TIME),
    "fmpm2": (Flip(2), 0.0),
    "fmpm4": (Flip(4), 0.0),
    "pic": (Flip(1), 0.0),
    "apic": (Apic(), inf),
    "tpic": (Tpic(), inf),
}
TRANSFER_LABELS = {
    "flip": "FLIP",
    "flip_fmpm2": "FLIP + FMPM(2) in 5 s",
    "fmpm2": "FMPM(2) each step",
    "fmpm4": "FMPM(4) each step",
    "pic": "PIC",
    "apic": "APIC",
    "tpic": "TPIC",
}
SHAPE_LABELS = {
    "linear": "linear",
    "gimp": "GIMP",
    "quadratic_bspline": "quadratic B-spline",
    "cubic_bspline": "cubic B-spline",
}
ORDER_LABELS = {"usl": "stress last", "musl": "MUSL", "usf": "stress first"}


@dataclass(frozen=True)
class Scheme:
    """One way to solve a scene; names as in the tables above."""

    shape: str
    transfer: str = "flip_fmpm2"
    order: str = "musl"
    points_per_cell: int = 4
    engine: str = "plain"

    @property
    def label(self) -> str:
        """The scheme in words."""
        words = [SHAPE_LABELS[self.shape], TRANSFER_LABELS[self.transfer], ORDER_LABELS[self.order]]
        return ", ".join([*words, *([] if self.points_per_cell == 4 else [f"{self.points_per_cell} points"])])


def defaults(**changes) -> list[Scheme]:
    """Every shape with the default transfer and order."""
    return [replace(Scheme(shape), **changes) for shape in SHAPES]


def transfers() -> list[Scheme]:
    """Every shape with every transfer, in the default order."""
    return [Scheme(shape, transfer) for shape in SHAPES for transfer in TRANSFERS]


def orders() -> list[Scheme]:
    """The default transfer with linear shapes and quadratic B-splines in the other orders."""
    return [
        Scheme(shape, order=order)
        for shape in ("linear", "quadratic_bspline")
        for order in ORDER_LABELS
        if order != Scheme.order
    ]


def engine_schemes() -> list[Scheme]:
    """What the production engine offers: every shape, with and without its dissipation."""
    return [scheme for transfer in ("flip_fmpm2", "flip") for scheme in defaults(engine="fast", transfer=transfer)]
