"""The one door to Numba, and the small tensors every kernel uses. Knows no physics."""

from rfmpm.kernel_tools.jit import at, cache_folder, generic, inlined, kernel, part, put
from rfmpm.kernel_tools.nodes import gather, gather_slopes, scatter, scatter_scalar, scatter_slopes, zeros
from rfmpm.kernel_tools.tensors import Tensor, Vector

__all__ = [
    "Tensor",
    "Vector",
    "at",
    "cache_folder",
    "gather",
    "gather_slopes",
    "generic",
    "inlined",
    "kernel",
    "part",
    "put",
    "scatter",
    "scatter_scalar",
    "scatter_slopes",
    "zeros",
]
