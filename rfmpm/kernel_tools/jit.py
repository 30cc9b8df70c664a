"""How kernels are compiled, cached and dispatched.

Kernels are plain functions of *records*: NamedTuples whose fields are arrays (one entry per point or node) or scalars.
A record class may have plain-Python methods; kernels call them as `method(record, ...)` and Numba picks the method by
the record's class when it compiles, so that a scene compiles only the laws, shapes and walls it uses. An argument that
is None compiles to nothing.
"""

import functools
import hashlib
import inspect
import os
import tempfile
from pathlib import Path

import numba
import numpy as np
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from rfmpm.kernel_tools.records import Ranges

# Contraction lets the compiler fuse a product and a sum into one rounding; it leaves NaN and infinity alone.
_OPTIONS = {"error_model": "numpy", "fastmath": {"contract"}}
inline_options = {"jit_options": {"forceinline": True, **_OPTIONS}}


def cache_folder() -> Path:
    """Name the folder of compiled kernels for this state of the sources and of the Numba switches.

    Numba notices a change in a kernel's own file only, and neither in the functions it calls from other files nor in
    the NUMBA_* switches; a folder per state closes both gaps.

    Returns:
        A folder below `$RFMPM_CACHE` (default `~/.cache/rfmpm`), or below the temporary folder where that cannot be
        written.
    """
    switches = sorted(item for item in os.environ.items() if item[0].startswith("NUMBA_"))
    state = hashlib.sha256(repr((numba.__version__, np.__version__, switches)).encode())
    package = Path(__file__).parents[1]
    for room in ("kernel_tools", "mpm", "random_fields", "stability", "benchmark"):
        for path in sorted((package / room).rglob("*.py")):
            state.update(path.read_bytes())
    name = state.hexdigest()[:16]
    wanted = Path(os.environ.get("RFMPM_CACHE", "~/.cache/rfmpm")).expanduser() / name
    try:
        wanted.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=wanted).close()
    except OSError:
        return Path(tempfile.gettempdir()) / f"rfmpm-{os.getuid() if hasattr(os, 'getuid') else 'cache'}" / name
    return wanted


numba.config.CACHE_DIR = str(cache_folder())

kernel = numba.njit(cache=True, nogil=True, **_OPTIONS)
inlined = numba.njit(forceinline=True, **_OPTIONS)


def generic(declaration):
    """Make the function that calls the method of that name of its first argument's class.

    In a kernel Numba resolves the class, hence the method, when it compiles. With NUMBA_DISABLE_JIT=1 it is an
    ordinary method call.

    Args:
        declaration: function of a Protocol; it fixes name and arguments. A class whose method differs is refused when
            the first kernel compiles.

    Returns:
        The function, to be called in kernels and in plain Python alike.
    """
    name = declaration.__name__

    def call(self, *args):
        return getattr(self, name)(*args)

    def resolve(self, *args):
        return getattr(self.instance_class, name, None) if isinstance(self, types.BaseNamedTuple) else None

    resolve.__signature__ = inspect.signature(declaration)
    call.__signature__ = inspect.signature(declaration)
    overload(call, **inline_options)(resolve)
    return functools.update_wrapper(call, declaration)


def at(record, index):
    """Read a record's values at one point or node, records and tuples within it too; the rest passes through."""
    if isinstance(record, np.ndarray):
        return record[index]
    return _map(lambda f: at(f, index), record) if isinstance(record, tuple) else record


def put(record, index, values):
    """Write `values` (a record of scalars of the same class) at one point or node; None writes nothing."""
    if record is None:
        return
    for field, value in zip(record, values, strict=True):
        if isinstance(field, np.ndarray):
            field[index] = value
        elif isinstance(field, tuple):
            put(field, index, value)


def part(record, first, last):
    """View of the points or nodes first, ..., last - 1 of a record, records within it too; the rest passes through."""
    if isinstance(record, np.ndarray):
        return record[first:last]
    if isinstance(record, Ranges):
        ends = [min(max(bound, first), last) for bound in record.bounds]
        own = tuple(part(one, ends[k] - a, ends[k + 1] - a) for k, (one, a, _) in enumerate(record.each()))
        return Ranges(own, tuple(end - first for end in ends))
    if isinstance(record, tuple):
        return _map(lambda f: part(f, first, last), record)
    return record


def _map(function, record):
    fields = [function(f) for f in record]
    return type(record)(*fields) if hasattr(record, "_fields") else tuple(fields)


@overload(at, **inline_options)
def _at(record, index):
    classes = {}
    picks = _rebuild("record", record, lambda name: f"{name}[index]", classes)
    return define("at", f"def at(record, index):\n    return {picks}", classes)


@overload(put, **inline_options)
def _put(record, index, values):
    lines = [f"    {line}" for line in _assign("record", "values", record)]
    return define("put", "\n".join(["def put(record, index, values):", *lines, "    return"]), {})


@overload(part, **inline_options)
def _part(record, first, last):
    if is_ranges(record):
        return _part_of_ranges(len(record.types[0]))
    classes = {"borrow": _borrow}
    view = _rebuild("record", record, lambda name: f"borrow({name}, first, last)", classes)
    return define("part", f"def part(record, first, last):\n    return {view}", classes)


def is_ranges(kind):
    """Whether a Numba type is that of Ranges."""
    return isinstance(kind, types.BaseNamedTuple) and kind.instance_class is Ranges


def _part_of_ranges(count):
    """Make `part` of a record of so many ranges: each range of the part begins and ends within it."""
    ends = [f"    e{k} = min(max(record.bounds[{k}], first), last)" for k in range(count + 1)]
    own = "".join(
        f"part(record.records[{k}], e{k} - record.bounds[{k}], e{k + 1} - record.bounds[{k}]), " for k in range(count)
    )
    bounds = "".join(f"e{k} - first, " for k in range(count + 1))
    lines = ["def part(record, first, last):", *ends, f"    return Ranges(({own}), ({bounds}))"]
    return define(
        "part_of_ranges", "\n".join(lines).replace("def part(", "def part_of_ranges("), {"part": part, "Ranges": Ranges}
    )


@intrinsic
def _borrow(typing, array, first, last):
    """View array[first:last] that counts no references: the kernel's caller holds the array."""

    def generate(context, builder, signature, args):
        whole = context.make_array(array)(context, builder, value=args[0])
        view = context.make_array(array)(context, builder)
        count = builder.sub(args[2], args[1])
        context.populate_array(
            view,
            data=builder.gep(whole.data, [args[1]]),
            shape=cgutils.pack_array(builder, [count]),
            strides=whole.strides,
            itemsize=whole.itemsize,
            meminfo=None,
        )
        return view._getvalue()

    return array(array, types.intp, types.intp), generate


def define(name, source, namespace):
    """Make the function `name` from its source; `namespace` holds what it refers to."""
    exec(source, namespace)
    return namespace[name]


def _fields(name, kind):
    """Expression and Numba type of each field of a record or tuple called `name`."""
    if isinstance(kind, types.BaseNamedTuple):
        return [(f"{name}.{field}", inner) for field, inner in zip(kind.fields, kind.types, strict=True)]
    return [(f"{name}[{k}]", inner) for k, inner in enumerate(kind)]


def _rebuild(name, kind, of_array, classes):
    """Expression for what is called `name`, `of_array` of every array in it; notes the record classes it needs."""
    if isinstance(kind, types.Array):
        return of_array(name)
    if not isinstance(kind, types.BaseTuple):
        return name
    inner = ", ".join(_rebuild(field, inner, of_array, classes) for field, inner in _fields(name, kind))
    if not isinstance(kind, types.BaseNamedTuple):
        return f"({inner},)"
    label = f"cls{len(classes)}"
    classes[label] = kind.instance_class
    return f"{label}({inner})"


def _assign(name, value, kind):
    """Lines that write `value` into every array of what is called `name`."""
    if isinstance(kind, types.Array):
        return [f"{name}[index] = {value}"]
    if not isinstance(kind, types.BaseTuple):
        return []
    targets, values = _fields(name, kind), _fields(value, kind)
    return [
        line
        for (target, inner), (source, _) in zip(targets, values, strict=True)
        for line in _assign(target, source, inner)
    ]
