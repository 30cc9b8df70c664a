"""Four values of one point at a time: rows of a flat array, read and written as one vector register.

To the sums over nodes such a row is a register; to the loops over points between them it is four interleaved
components with a stride that the compiler knows.
"""

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from rfmpm.kernel_tools.jit import inline_options

LANES = 4
DOUBLE = ir.DoubleType()
VECTOR = ir.VectorType(DOUBLE, LANES)
FOUR = types.UniTuple(types.float64, LANES)


def lanes(flat, p):
    """Read the four values of point p, shape (4,)."""
    return tuple(flat[LANES * p : LANES * p + LANES])


def put_lanes(flat, p, four):
    """Write the four values of point p."""
    flat[LANES * p : LANES * p + LANES] = four


def as_vector(builder, scalars):
    """A vector of up to four scalars, zero beyond them."""
    vector = ir.Constant(VECTOR, [0.0] * LANES)
    for lane, scalar in enumerate(scalars):
        vector = builder.insert_element(vector, scalar, ir.Constant(ir.IntType(32), lane))
    return vector


def as_tuple(context, builder, vector):
    """A tuple of the scalars of a vector."""
    scalars = [builder.extract_element(vector, ir.Constant(ir.IntType(32), lane)) for lane in range(LANES)]
    return context.make_tuple(builder, FOUR, scalars)


def spread(builder, scalar):
    """A vector with the scalar in every lane."""
    first = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), scalar, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(first, ir.Constant(VECTOR, ir.Undefined), zeros)


def _place(context, builder, kind, array, point):
    data = cgutils.create_struct_proxy(kind)(context, builder, value=array).data
    pointer = builder.gep(data, [builder.mul(point, ir.Constant(point.type, LANES))])
    return builder.bitcast(pointer, ir.PointerType(VECTOR))


@intrinsic
def _lanes(typing, flat, p):
    def generate(context, builder, signature, args):
        loaded = builder.load(_place(context, builder, flat, *args))
        loaded.align = 8
        return as_tuple(context, builder, loaded)

    return FOUR(flat, types.int64), generate


@intrinsic
def _put_lanes(typing, flat, p, four):
    def generate(context, builder, signature, args):
        vector = as_vector(builder, cgutils.unpack_tuple(builder, args[2], LANES))
        builder.store(vector, _place(context, builder, flat, args[0], args[1])).align = 8
        return context.get_dummy_value()

    return types.void(flat, types.int64, FOUR), generate


@overload(lanes, **inline_options)
def _(flat, p):
    return lambda flat, p: _lanes(flat, p)


@overload(put_lanes, **inline_options)
def _(flat, p, four):
    return lambda flat, p, four: _put_lanes(flat, p, four)
