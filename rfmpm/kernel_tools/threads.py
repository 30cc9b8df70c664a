"""BLAS on one thread, so that the bits of a product do not depend on how many threads a machine offers."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from threadpoolctl import ThreadpoolController


@contextmanager
def single_blas_thread() -> Iterator[None]:
    """Run the body with every loaded BLAS library limited to one thread; the earlier limits return afterwards.

    Import what brings a BLAS (numpy, scipy.linalg) before entering.
    """
    with _controller("scipy.linalg" in sys.modules).limit(limits=1, user_api="blas"):
        yield


@cache
def _controller(has_scipy: bool) -> ThreadpoolController:
    # A controller knows the libraries loaded when it was made; scipy.linalg, imported late, brings one of its own.
    return ThreadpoolController()
