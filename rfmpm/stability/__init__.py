"""Factor of safety of a slope: limit equilibrium and strength reduction, on the strengths of a realisation."""

from rfmpm.stability.strength_reduction import StrengthReduction, strength_reduction
from rfmpm.stability.undrained import Surfaces, factor_of_safety, prepare_surfaces

__all__ = ["StrengthReduction", "Surfaces", "factor_of_safety", "prepare_surfaces", "strength_reduction"]
