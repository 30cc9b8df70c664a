"""Sums over the nodes around a point, four values of a node at a time.

Every node array has shape (rows, columns, 4), so that the values of one node fill one vector register. Numba's own
loops come out scalar here; these few functions write the vector instructions down, with the same sums in plain Python
below for runs without compilation.
"""

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from rfmpm.kernel_tools.jit import inline_options

LANES = 4
CACHE_LINE = 8  # numbers
_DOUBLE = ir.DoubleType()
_VECTOR = ir.VectorType(_DOUBLE, LANES)
_FOUR = types.UniTuple(types.float64, LANES)


def zeros(rows, columns):
    """Make a node array of zeros that starts on a cache line, so that no node lies across two."""
    count = rows * columns * LANES
    raw = np.zeros(count + CACHE_LINE - 1)
    first = -(raw.ctypes.data // raw.itemsize) % CACHE_LINE
    return raw[first : first + count].reshape(rows, columns, LANES)


def gather(values, i, wx, j, wy):
    """Interpolate: sum over nodes of w v, shape (4,), from nodes j, j + 1, ... and i, i + 1, ..."""
    block = values[j : j + len(wy), i : i + len(wx)]
    return tuple(np.einsum("b,a,bak->k", wy, wx, block))


def gather_slopes(values, i, wx, dx, j, wy, dy):
    """Interpolate with both slopes: sums over nodes of w v, dw/dx v and dw/dy v, shape (4,) each."""
    return gather(values, i, wx, j, wy), gather(values, i, dx, j, wy), gather(values, i, wx, j, dy)


def scatter(values, i, wx, j, wy, amount):
    """Add w times `amount` (4,) to the nodes."""
    values[j : j + len(wy), i : i + len(wx)] += np.einsum("b,a,k->bak", wy, wx, amount)


def scatter_slopes(values, i, wx, dx, j, wy, dy, amount, along_x, along_y):
    """Add w times `amount`, dw/dx times `along_x` and dw/dy times `along_y`, shape (4,) each, to the nodes."""
    scatter(values, i, wx, j, wy, amount)
    scatter(values, i, dx, j, wy, along_x)
    scatter(values, i, wx, j, dy, along_y)


def scatter_scalar(values, i, wx, j, wy, amount):
    """Add w times `amount` to the nodes of an array (rows, columns)."""
    values[j : j + len(wy), i : i + len(wx)] += np.outer(wy, wx) * amount


class _Block:
    """The nodes around one point while code is generated."""

    def __init__(self, context, builder, kind, array, column, row):
        self.builder = builder
        arrays = cgutils.create_struct_proxy(kind)(context, builder, value=array)
        self.data = arrays.data
        columns = builder.extract_value(arrays.shape, 1)
        self.width = LANES if kind.ndim == 3 else 1
        self.pitch = builder.mul(columns, ir.Constant(columns.type, self.width))
        start = builder.mul(column, ir.Constant(column.type, self.width))
        self.start = builder.add(builder.mul(row, self.pitch), start)

    def row(self, b):
        """Pointer to the first value of row b of the block."""
        offset = self.builder.mul(self.pitch, ir.Constant(self.pitch.type, b))
        return self.builder.gep(self.data, [self.builder.add(self.start, offset)])

    def node(self, row, a):
        """Pointer to node a of a row, as what a node holds."""
        pointer = self.builder.gep(row, [ir.Constant(ir.IntType(64), a * self.width)])
        return self.builder.bitcast(pointer, ir.PointerType(_VECTOR)) if self.width == LANES else pointer

    def load(self, row, a):
        loaded = self.builder.load(self.node(row, a))
        loaded.align = 8
        return loaded

    def add(self, row, a, amount):
        target = self.node(row, a)
        loaded = self.builder.load(target)
        loaded.align = 8
        self.builder.store(self.builder.fadd(loaded, amount, flags=("contract",)), target).align = 8


def _spread(builder, scalar):
    """A vector with the scalar in every lane."""
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), scalar, ir.Constant(ir.IntType(32), 0))
    lanes = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(first, ir.Constant(_VECTOR, ir.Undefined), lanes)


def _vector(builder, four):
    vector = ir.Constant(_VECTOR, ir.Undefined)
    for lane, scalar in enumerate(cgutils.unpack_tuple(builder, four, LANES)):
        vector = builder.insert_element(vector, scalar, ir.Constant(ir.IntType(32), lane))
    return vector


def _tuple(context, builder, vector):
    lanes = [builder.extract_element(vector, ir.Constant(ir.IntType(32), lane)) for lane in range(LANES)]
    return context.make_tuple(builder, _FOUR, lanes)


def _accumulate(builder, total, weight, vector):
    product = builder.fmul(weight, vector, flags=("contract",))
    return product if total is None else builder.fadd(total, product, flags=("contract",))


def _scalars(builder, weights, kind):
    return cgutils.unpack_tuple(builder, weights, kind.count)


@intrinsic
def _gather(typing, values, i, wx, j, wy):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, values, args[0], args[1], args[3])
        across = [_spread(builder, w) for w in _scalars(builder, args[2], wx)]
        total = None
        for b, w in enumerate(_scalars(builder, args[4], wy)):
            row, along = block.row(b), None
            for a, weight in enumerate(across):
                along = _accumulate(builder, along, weight, block.load(row, a))
            total = _accumulate(builder, total, _spread(builder, w), along)
        return _tuple(context, builder, total)

    return _FOUR(values, types.int64, wx, types.int64, wy), generate


@intrinsic
def _gather_slopes(typing, values, i, wx, dx, j, wy, dy):
    three = types.UniTuple(_FOUR, 3)

    def generate(context, builder, signature, args):
        block = _Block(context, builder, values, args[0], args[1], args[4])
        across = [_spread(builder, w) for w in _scalars(builder, args[2], wx)]
        slopes = [_spread(builder, w) for w in _scalars(builder, args[3], wx)]
        rows = zip(_scalars(builder, args[5], wy), _scalars(builder, args[6], wy), strict=True)
        total = along_x = along_y = None
        for b, (w, d) in enumerate(rows):
            row, value, slope = block.row(b), None, None
            for a in range(wx.count):
                node = block.load(row, a)
                value = _accumulate(builder, value, across[a], node)
                slope = _accumulate(builder, slope, slopes[a], node)
            w = _spread(builder, w)
            total = _accumulate(builder, total, w, value)
            along_x = _accumulate(builder, along_x, w, slope)
            along_y = _accumulate(builder, along_y, _spread(builder, d), value)
        parts = [_tuple(context, builder, vector) for vector in (total, along_x, along_y)]
        return context.make_tuple(builder, three, parts)

    return three(values, types.int64, wx, wx, types.int64, wy, wy), generate


@intrinsic
def _scatter(typing, values, i, wx, j, wy, amount):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, values, args[0], args[1], args[3])
        is_vector = isinstance(amount, types.BaseTuple)
        lift = _spread if is_vector else (lambda builder, scalar: scalar)
        across = [lift(builder, w) for w in _scalars(builder, args[2], wx)]
        carried = _vector(builder, args[5]) if is_vector else args[5]
        for b, w in enumerate(_scalars(builder, args[4], wy)):
            row, part = block.row(b), _accumulate(builder, None, lift(builder, w), carried)
            for a, weight in enumerate(across):
                block.add(row, a, _accumulate(builder, None, weight, part))
        return context.get_dummy_value()

    return types.void(values, types.int64, wx, types.int64, wy, amount), generate


@intrinsic
def _scatter_slopes(typing, values, i, wx, dx, j, wy, dy, amount, along_x, along_y):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, values, args[0], args[1], args[4])
        across = [_spread(builder, w) for w in _scalars(builder, args[2], wx)]
        slopes = [_spread(builder, w) for w in _scalars(builder, args[3], wx)]
        value, in_x, in_y = (_vector(builder, part) for part in args[7:10])
        rows = zip(_scalars(builder, args[5], wy), _scalars(builder, args[6], wy), strict=True)
        for b, (w, d) in enumerate(rows):
            row, w = block.row(b), _spread(builder, w)
            straight = _accumulate(builder, _accumulate(builder, None, w, value), _spread(builder, d), in_y)
            sloped = _accumulate(builder, None, w, in_x)
            for a in range(wx.count):
                part = _accumulate(builder, _accumulate(builder, None, across[a], straight), slopes[a], sloped)
                block.add(row, a, part)
        return context.get_dummy_value()

    return types.void(values, types.int64, wx, wx, types.int64, wy, wy, _FOUR, _FOUR, _FOUR), generate


@overload(gather, **inline_options)
def _(values, i, wx, j, wy):
    return lambda values, i, wx, j, wy: _gather(values, i, wx, j, wy)


@overload(gather_slopes, **inline_options)
def _(values, i, wx, dx, j, wy, dy):
    return lambda values, i, wx, dx, j, wy, dy: _gather_slopes(values, i, wx, dx, j, wy, dy)


@overload(scatter, **inline_options)
def _(values, i, wx, j, wy, amount):
    return lambda values, i, wx, j, wy, amount: _scatter(values, i, wx, j, wy, amount)


@overload(scatter_scalar, **inline_options)
def _(values, i, wx, j, wy, amount):
    return lambda values, i, wx, j, wy, amount: _scatter(values, i, wx, j, wy, amount)


@overload(scatter_slopes, **inline_options)
def _(values, i, wx, dx, j, wy, dy, amount, along_x, along_y):
    return lambda values, i, wx, dx, j, wy, dy, amount, along_x, along_y: _scatter_slopes(
        values, i, wx, dx, j, wy, dy, amount, along_x, along_y
    )
