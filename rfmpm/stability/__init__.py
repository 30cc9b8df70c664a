"""Factor of safety of a slope: limit equilibrium on the strengths of a realisation."""

from rfmpm.stability.undrained import Surfaces, factor_of_safety, prepare_surfaces

__all__ = ["Surfaces", "factor_of_safety", "prepare_surfaces"]
