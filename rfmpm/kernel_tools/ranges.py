"""Kernels of points of several kinds: written for one kind, compiled for each, called range by range."""

from numba.core import types
from numba.extending import overload

from rfmpm.kernel_tools.jit import define, inline_options, is_ranges
from rfmpm.kernel_tools.records import Ranges


def by_range(function, records, count, arguments):
    """Call a kernel for each range that has points: function(*its records, first, one after the last, *arguments).

    Args:
        function: kernel that returns nothing.
        records: tuple of records of the points, each of them Ranges with the same bounds, or one record for all points.
            A range for which the first of them is None is left out.
        count: of the points.
        arguments: tuple, the same for all.
    """
    if not isinstance(records[0], Ranges):
        function(*records, 0, count, *arguments)
        return
    for k, (own, first, last) in enumerate(records[0].each()):
        if own is not None and first < last:
            others = (other.records[k] if isinstance(other, Ranges) else other for other in records[1:])
            function(own, *others, first, last, *arguments)


@overload(by_range, **inline_options)
def _by_range(function, records, count, arguments):
    lines = ["def by_range(function, records, count, arguments):"]
    if not is_ranges(records[0]):
        own = "".join(f"records[{j}], " for j in range(len(records)))
        lines.append(f"    function({own}0, count, *arguments)")
    else:
        for k, kind in enumerate(records[0].types[0]):
            if isinstance(kind, types.NoneType):
                continue
            own = "".join(
                f"records[{j}].records[{k}], " if is_ranges(other) else f"records[{j}], "
                for j, other in enumerate(records)
            )
            ends = f"records[0].bounds[{k}], records[0].bounds[{k + 1}]"
            lines.append(f"    first, last = {ends}")
            lines.append(f"    if first < last:\n        function({own}first, last, *arguments)")
    return define("by_range", "\n".join([*lines, "    return"]), {})
