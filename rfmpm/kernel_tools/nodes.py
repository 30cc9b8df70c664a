"""Sums over the nodes around a point, four values of a node at a time.

Every node array has shape (rows, columns, 4), so that the values of one node fill one vector register. Numba's own
loops come out scalar here; these few functions write the vector instructions down, with the same sums in plain Python
below for runs without compilation. `x` and `y` are the stencils of a block of points, p is the point in the block.

Weights must sum to one and slopes to zero: the sums over nodes are taken over differences from the middle node.
"""

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from rfmpm.kernel_tools.jit import inline_options
from rfmpm.kernel_tools.lanes import FOUR, LANES, VECTOR, as_tuple, as_vector, spread
from rfmpm.kernel_tools.stencil import BLOCK, weights_at

CACHE_LINE = 8  # numbers
DOUBLE_BYTES = 8
_FUSED = ("contract",)


def zeros(rows, columns):
    """Make a node array of zeros that starts on a cache line, so that no node lies across two."""
    count = rows * columns * LANES
    raw = np.zeros(count + CACHE_LINE - 1)
    first = -(raw.ctypes.data // raw.itemsize) % CACHE_LINE
    return raw[first : first + count].reshape(rows, columns, LANES)


def gather(values, x, y, p):
    """Interpolate: sum over nodes of w v, shape (4,)."""
    return gather_slopes(values, x, y, p)[0]


def gather_slopes(values, x, y, p):
    """Interpolate with both slopes: sums over nodes of w v, dw/dx v and dw/dy v, shape (4,) each."""
    (i, wx, dx), (j, wy, dy) = weights_at(x, p), weights_at(y, p)
    block = values[j : j + len(wy), i : i + len(wx)]
    return tuple(tuple(np.einsum("b,a,bak->k", b, a, block)) for b, a in ((wy, wx), (wy, dx), (dy, wx)))


def scatter(values, x, y, p, amount):
    """Add w times `amount` (4,) to the nodes."""
    scatter_slopes(values, x, y, p, amount, (0.0,) * LANES, (0.0,) * LANES)


def scatter_slopes(values, x, y, p, amount, along_x, along_y):
    """Add w times `amount`, dw/dx times `along_x` and dw/dy times `along_y`, shape (4,) each, to the nodes."""
    (i, wx, dx), (j, wy, dy) = weights_at(x, p), weights_at(y, p)
    block = values[j : j + len(wy), i : i + len(wx)]
    for b, a, four in ((wy, wx, amount), (wy, dx, along_x), (dy, wx, along_y)):
        block += np.einsum("b,a,k->bak", b, a, four)


def scatter_rows(values, x, y, p, amount):
    """Add w times the number `amount` to the rows of nodes: that of a row's k-th node to value k of its first node."""
    (i, wx, _), (j, wy, _) = weights_at(x, p), weights_at(y, p)
    values[j : j + len(wy), i, : len(wx)] += np.outer(wy, wx) * amount


class _Axis:
    """Weights of one point along one axis while code is generated: each is read where it is used."""

    def __init__(self, context, builder, kind, stencil, point):
        self.builder, self.width = builder, kind[2].count
        fields = [builder.extract_value(stencil, k) for k in range(2)]
        arrays = [cgutils.create_struct_proxy(kind[k])(context, builder, value=fields[k]).data for k in range(2)]
        first = builder.load(builder.gep(arrays[0], [point]))
        self.first = builder.sext(first, point.type)
        self.table = builder.gep(arrays[1], [point])

    def weight(self, k):
        return self.builder.load(self.builder.gep(self.table, [ir.Constant(ir.IntType(64), k * BLOCK)]))

    def slope(self, k):
        return self.weight(self.width + k)

    def weights(self):
        return [spread(self.builder, self.weight(k)) for k in range(self.width)]

    def slopes(self):
        return [spread(self.builder, self.slope(k)) for k in range(self.width)]


class _Block:
    """The nodes around one point while code is generated."""

    def __init__(self, context, builder, kinds, args):
        values, x, y = kinds[:3]
        self.builder = builder
        self.x = _Axis(context, builder, x, args[1], args[3])
        self.y = _Axis(context, builder, y, args[2], args[3])
        arrays = cgutils.create_struct_proxy(values)(context, builder, value=args[0])
        self.columns = builder.extract_value(arrays.shape, 1)
        place = builder.add(builder.mul(self.y.first, self.columns), self.x.first)
        self.start = builder.gep(builder.bitcast(arrays.data, ir.PointerType(VECTOR)), [place])

    def node(self, b, a):
        """Pointer to the values of node a of row b."""
        offset = self.builder.mul(self.columns, ir.Constant(self.columns.type, b))
        return self.builder.gep(self.builder.gep(self.start, [offset]), [ir.Constant(offset.type, a)])

    def row(self, b):
        """The values of the nodes of row b."""
        loaded = [self.builder.load(self.node(b, a)) for a in range(self.x.width)]
        for value in loaded:
            value.align = DOUBLE_BYTES
        return loaded

    def add(self, b, a, amount):
        """Add to the values of node a of row b."""
        target = self.node(b, a)
        loaded = self.builder.load(target)
        loaded.align = DOUBLE_BYTES
        self.builder.store(self.builder.fadd(loaded, amount, flags=_FUSED), target).align = DOUBLE_BYTES


def _accumulate(builder, total, weight, vector):
    product = builder.fmul(weight, vector, flags=_FUSED)
    return product if total is None else builder.fadd(total, product, flags=_FUSED)


def _differences(builder, terms):
    """The middle one of the terms, and how far it is above each of the others, by their numbers."""
    middle = (len(terms) - 1) // 2
    others = {k: builder.fsub(terms[middle], term, flags=_FUSED) for k, term in enumerate(terms) if k != middle}
    return terms[middle], others


def _mean(builder, middle, others, weights):
    for k, difference in others.items():
        middle = builder.fsub(middle, builder.fmul(weights[k], difference, flags=_FUSED), flags=_FUSED)
    return middle


def _steepness(builder, others, slopes):
    """Minus the sum of slopes times values."""
    total = None
    for k, difference in others.items():
        total = _accumulate(builder, total, slopes[k], difference)
    return total


@intrinsic
def _gather(typing, values, x, y, p):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, signature.args, args)
        across, up = block.x.weights(), block.y.weights()
        means = [_mean(builder, *_differences(builder, block.row(b)), across) for b in range(block.y.width)]
        return as_tuple(context, builder, _mean(builder, *_differences(builder, means), up))

    return FOUR(values, x, y, types.int64), generate


@intrinsic
def _gather_slopes(typing, values, x, y, p):
    three = types.UniTuple(FOUR, 3)

    def generate(context, builder, signature, args):
        block = _Block(context, builder, signature.args, args)
        across, slopes, means, steeps = block.x.weights(), block.x.slopes(), [], []
        for b in range(block.y.width):
            middle, others = _differences(builder, block.row(b))
            means.append(_mean(builder, middle, others, across))
            steeps.append(_steepness(builder, others, slopes))
        middle, others = _differences(builder, means)
        up = block.y.weights()
        total, minus_y = _mean(builder, middle, others, up), _steepness(builder, others, block.y.slopes())
        minus_x = _mean(builder, *_differences(builder, steeps), up)
        parts = [total, builder.fneg(minus_x), builder.fneg(minus_y)]
        return context.make_tuple(builder, three, [as_tuple(context, builder, vector) for vector in parts])

    return three(values, x, y, types.int64), generate


@intrinsic
def _scatter(typing, values, x, y, p, amount):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, signature.args, args)
        across, four = block.x.weights(), as_vector(builder, cgutils.unpack_tuple(builder, args[4], LANES))
        for b in range(block.y.width):
            part = _accumulate(builder, None, spread(builder, block.y.weight(b)), four)
            for a, weight in enumerate(across):
                block.add(b, a, _accumulate(builder, None, weight, part))
        return context.get_dummy_value()

    return types.void(values, x, y, types.int64, FOUR), generate


@intrinsic
def _scatter_slopes(typing, values, x, y, p, amount, along_x, along_y):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, signature.args, args)
        across, slopes = block.x.weights(), block.x.slopes()
        four, in_x, in_y = (as_vector(builder, cgutils.unpack_tuple(builder, a, LANES)) for a in args[4:])
        for b in range(block.y.width):
            weight, slope = spread(builder, block.y.weight(b)), spread(builder, block.y.slope(b))
            straight = _accumulate(builder, _accumulate(builder, None, weight, four), slope, in_y)
            sloped = _accumulate(builder, None, weight, in_x)
            for a in range(block.x.width):
                part = _accumulate(builder, _accumulate(builder, None, across[a], straight), slopes[a], sloped)
                block.add(b, a, part)
        return context.get_dummy_value()

    return types.void(values, x, y, types.int64, FOUR, FOUR, FOUR), generate


@intrinsic
def _scatter_rows(typing, values, x, y, p, amount):
    def generate(context, builder, signature, args):
        block = _Block(context, builder, signature.args, args)
        across = as_vector(builder, [block.x.weight(a) for a in range(block.x.width)])
        across = builder.fmul(across, spread(builder, args[4]))
        for b in range(block.y.width):
            block.add(b, 0, _accumulate(builder, None, spread(builder, block.y.weight(b)), across))
        return context.get_dummy_value()

    return types.void(values, x, y, types.int64, types.float64), generate


@overload(gather, **inline_options)
def _(values, x, y, p):
    return lambda values, x, y, p: _gather(values, x, y, p)


@overload(gather_slopes, **inline_options)
def _(values, x, y, p):
    return lambda values, x, y, p: _gather_slopes(values, x, y, p)


@overload(scatter, **inline_options)
def _(values, x, y, p, amount):
    return lambda values, x, y, p, amount: _scatter(values, x, y, p, amount)


@overload(scatter_rows, **inline_options)
def _(values, x, y, p, amount):
    return lambda values, x, y, p, amount: _scatter_rows(values, x, y, p, amount)


@overload(scatter_slopes, **inline_options)
def _(values, x, y, p, amount, along_x, along_y):
    return lambda values, x, y, p, amount, along_x, along_y: _scatter_slopes(values, x, y, p, amount, along_x, along_y)
