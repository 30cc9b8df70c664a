"""The material point method written as its equations: slow, clear, and any shape with any transfer in any order.

It is the oracle of the engine in `mpm.transfer`, and the place where schemes are measured that the engine leaves out.
"""

from rfmpm.mpm.solvers.reference.protocols import TRANSFERS, Apic, Flip, Tpic
from rfmpm.mpm.solvers.reference.state import ORDERS, Clock, Settings, empty_nodes, still_gradient
from rfmpm.mpm.solvers.reference.step import advance, wind_up

__all__ = [
    "ORDERS",
    "TRANSFERS",
    "Apic",
    "Clock",
    "Flip",
    "Settings",
    "Tpic",
    "advance",
    "empty_nodes",
    "still_gradient",
    "wind_up",
]
