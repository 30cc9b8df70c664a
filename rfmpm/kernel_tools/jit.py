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
from numba.core import types
from numba.extending import overload

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
    for room in ("kernel_tools", "mpm", "benchmark"):
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
    """Read a record's values at one point or node; uniform values and None pass through."""
    if record is None:
        return None
    return type(record)(*(f[index] if isinstance(f, np.ndarray) else f for f in record))


def put(record, index, values):
    """Write `values` (a record of scalars of the same class) at one point or node; None writes nothing."""
    if record is None:
        return
    for field, value in zip(record, values, strict=True):
        if isinstance(field, np.ndarray):
            field[index] = value


def part(record, first, last):
    """View of the points or nodes first, ..., last - 1 of a record, records within it too; the rest passes through."""
    if isinstance(record, np.ndarray):
        return record[first:last]
    if isinstance(record, tuple):
        return type(record)(*(part(f, first, last) for f in record))
    return record


@overload(at, **inline_options)
def _at(record, index):
    if isinstance(record, types.NoneType):
        return lambda record, index: None
    picks = ", ".join(
        f"record.{name}[index]" if isinstance(kind, types.Array) else f"record.{name}"
        for name, kind in zip(record.fields, record.types, strict=True)
    )
    return _define("at", f"def at(record, index):\n    return cls({picks})", record)


@overload(put, **inline_options)
def _put(record, index, values):
    if isinstance(record, types.NoneType):
        return lambda record, index, values: None
    lines = [
        f"    record.{name}[index] = values.{name}"
        for name, kind in zip(record.fields, record.types, strict=True)
        if isinstance(kind, types.Array)
    ]
    return _define("put", "\n".join(["def put(record, index, values):", *lines, "    return"]), record)


@overload(part, **inline_options)
def _part(record, first, last):
    classes = {}
    view = _view("record", record, classes)
    namespace = dict(classes)
    exec(f"def part(record, first, last):\n    return {view}", namespace)
    return namespace["part"]


def _view(name, kind, classes):
    """Expression for `part` of what is called `name` and has that Numba type; notes the record classes it needs."""
    if isinstance(kind, types.Array):
        return f"{name}[first:last]"
    if not isinstance(kind, types.BaseNamedTuple):
        return name
    label = f"cls{len(classes)}"
    classes[label] = kind.instance_class
    fields = zip(kind.fields, kind.types, strict=True)
    return f"{label}({', '.join(_view(f'{name}.{field}', inner, classes) for field, inner in fields)})"


def _define(name, source, record):
    namespace = {"cls": record.instance_class}
    exec(source, namespace)
    return namespace[name]
