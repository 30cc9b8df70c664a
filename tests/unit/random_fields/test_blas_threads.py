import os
import subprocess
import sys

import pytest
import scipy.linalg  # noqa: F401  its BLAS must be limited too
from threadpoolctl import threadpool_info, threadpool_limits

from rfmpm.kernel_tools.threads import single_blas_thread


def blas_threads() -> list[int]:
    return [library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"]


def test_one_thread_inside_and_the_earlier_number_after():
    with threadpool_limits(2, user_api="blas"):
        before = blas_threads()
        with single_blas_thread():
            assert set(blas_threads()) == {1}
        assert blas_threads() == before


def test_the_earlier_number_returns_after_an_error():
    with threadpool_limits(2, user_api="blas"):
        before = blas_threads()
        with pytest.raises(ZeroDivisionError), single_blas_thread():
            raise ZeroDivisionError
        assert blas_threads() == before


USE_BEFORE_AND_AFTER_SCIPY = """
from rfmpm.kernel_tools.threads import single_blas_thread
with single_blas_thread():
    pass
import scipy.linalg
from threadpoolctl import threadpool_info
with single_blas_thread():
    print({library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"})
"""


def test_a_blas_loaded_after_the_first_use_is_limited_too():
    done = subprocess.run(
        [sys.executable, "-c", USE_BEFORE_AND_AFTER_SCIPY],
        env=os.environ | {"OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "2"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "{1}"
