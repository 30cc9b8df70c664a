"""Factor of safety of a slope: by limit equilibrium or strength reduction, on the strengths of a realisation.

A method is a function of the prepared study and the fields of a realisation that returns a record with a `factor`.
"""

from functools import partial

from rfmpm.stability.limit_equilibrium import ASSUMPTIONS, Critical, critical_surface, factor_along
from rfmpm.stability.methods import Strength, ground_of, lay, limit_equilibrium, section_of, strength_of
from rfmpm.stability.section import Section, Side, sides_of
from rfmpm.stability.strength_reduction import StrengthReduction, strength_reduction

METHODS = {name: partial(limit_equilibrium, name) for name in ASSUMPTIONS} | {"strength_reduction": strength_reduction}

__all__ = [
    "ASSUMPTIONS",
    "METHODS",
    "Critical",
    "Section",
    "Side",
    "Strength",
    "StrengthReduction",
    "critical_surface",
    "factor_along",
    "ground_of",
    "lay",
    "limit_equilibrium",
    "section_of",
    "sides_of",
    "strength_of",
    "strength_reduction",
]
