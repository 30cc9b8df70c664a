"""The one door to Numba, and the small tensors every kernel uses. Knows no physics."""

from rfmpm.kernel_tools.jit import at, cache_folder, generic, inlined, kernel, part, put
from rfmpm.kernel_tools.lanes import lanes, put_lanes
from rfmpm.kernel_tools.nodes import gather, gather_slopes, scatter, scatter_rows, scatter_slopes, zeros
from rfmpm.kernel_tools.ranges import by_range
from rfmpm.kernel_tools.records import Ranges, each_record, join, mapped
from rfmpm.kernel_tools.side_by_side import side_by_side, start_threads
from rfmpm.kernel_tools.stencil import BLOCK, Stencil, make_stencil, put_stencil
from rfmpm.kernel_tools.tensors import Tensor, Vector

__all__ = [
    "BLOCK",
    "Ranges",
    "Stencil",
    "Tensor",
    "Vector",
    "at",
    "by_range",
    "cache_folder",
    "each_record",
    "gather",
    "gather_slopes",
    "generic",
    "inlined",
    "join",
    "kernel",
    "lanes",
    "make_stencil",
    "mapped",
    "part",
    "put",
    "put_lanes",
    "put_stencil",
    "scatter",
    "scatter_rows",
    "scatter_slopes",
    "side_by_side",
    "start_threads",
    "zeros",
]
