"""One kernel by several threads at once, each with a number of its own; the caller waits for all.

Numba's prange does not take records within records. Its threads do: what they are given here is the address of the
arguments, and in place of an array a null pointer with a step of one byte, so that its address is the thread's number.
"""

import os

import numba
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from rfmpm.kernel_tools.jit import inline_options

ADDRESS = ir.IntType(8).as_pointer()
COUNT = ir.IntType(64)


def start_threads() -> int:
    """Start the threads, once; they wait for work. Returns how many there are, at most as many as cores.

    A kernel that calls `side_by_side` can neither be compiled nor loaded from the cache before. While they wait they
    leave their cores to others: threads that wait busily take ten times as long where a core is not free.
    """
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    numba.set_num_threads(numba.config.NUMBA_NUM_THREADS)
    return numba.config.NUMBA_NUM_THREADS


def side_by_side(function, count, threads, arguments):
    """Call a kernel as function(0, *arguments), ..., function(count - 1, *arguments), in no order, and wait.

    Args:
        function: kernel that returns nothing; what one call writes no other may read or write.
        count: of the calls.
        threads: how many take them, at most as many as there are.
        arguments: tuple, the same for all.
    """
    for rank in range(count):
        function(rank, *arguments)


@intrinsic
def _side_by_side(typing, function, count, threads, arguments):
    types_of_call = (types.int64, *arguments)

    def generate(context, builder, signature, args):
        compiled = function.dispatcher.get_compile_result(function.get_call_type(typing, types_of_call, {}))
        context.active_code_library.add_linking_library(compiled.library)
        one = cgutils.pack_array(builder, [COUNT(1)])
        places = [
            cgutils.alloca_once_value(builder, value)
            for value in (ADDRESS(None), args[1], one, args[3])  # arrays, number of calls, steps, arguments
        ]
        share = _share(context, builder.module, compiled.fndesc, types_of_call, args[3].type)
        kind = ir.FunctionType(ir.VoidType(), [ADDRESS] * 5 + [COUNT] * 3)
        run = cgutils.get_or_insert_function(builder.module, kind, "numba_parallel_for")
        pointers = [builder.bitcast(place, ADDRESS) for place in (share, *places)]
        builder.call(run, [*pointers, COUNT(0), COUNT(1), args[2]])
        return context.get_dummy_value()

    return types.void(function, types.int64, types.int64, arguments), generate


def _share(context, module, callee, types_of_call, record):
    """Function by which a thread takes its share of the calls."""
    kind = ir.FunctionType(ir.VoidType(), [ADDRESS.as_pointer(), COUNT.as_pointer(), COUNT.as_pointer(), ADDRESS])
    share = ir.Function(module, kind, module.get_unique_name("share"))
    share.linkage = "internal"
    builder = ir.IRBuilder(share.append_basic_block())
    arrays, counts, _, data = share.args
    first, arguments = builder.ptrtoint(builder.load(arrays), COUNT), builder.bitcast(data, record.as_pointer())
    values = cgutils.unpack_tuple(builder, builder.load(arguments), len(types_of_call) - 1)
    values = [_borrowed(context, builder, *pair) for pair in zip(types_of_call[1:], values, strict=True)]
    function = context.declare_function(module, callee)
    with cgutils.for_range(builder, builder.load(counts)) as loop:
        rank = builder.add(first, loop.index)
        context.call_conv.call_function(builder, function, types.void, types_of_call, [rank, *values])
    builder.ret_void()
    return share


def _borrowed(context, builder, kind, value):
    """The same arrays without counts of references, for which the threads would wait: the caller holds the arrays."""
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value=value)
        array.meminfo = cgutils.get_null_value(array.meminfo.type)
        return array._getvalue()
    if isinstance(kind, types.BaseTuple):
        for k, inner in enumerate(kind.types):
            field = builder.extract_value(value, k)
            value = builder.insert_value(value, _borrowed(context, builder, inner, field), k)
    return value


@overload(side_by_side, **inline_options)
def _(function, count, threads, arguments):
    return lambda function, count, threads, arguments: _side_by_side(function, count, threads, arguments)
