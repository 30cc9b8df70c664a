"""Four values of a point in one flat array: the compiled functions are the plain ones."""

import numpy as np
import pytest

from rfmpm.kernel_tools import kernel, lanes, put_lanes


@kernel
def compiled(flat, p, q):
    put_lanes(flat, q, lanes(flat, p))


@pytest.mark.parametrize("copy", [compiled, getattr(compiled, "py_func", compiled)], ids=["compiled", "plain"])
def test_four_values_of_a_point_are_copied_to_another(copy):
    flat = np.arange(16.0)
    copy(flat, 1, 3)
    assert flat.tolist() == [*range(12), 4.0, 5.0, 6.0, 7.0]
